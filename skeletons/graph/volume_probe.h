// What a look at some places in a volume tells of it: how large it is, how thin, and where in its bounds it is.
#pragma once

#include "blobtree/run_options.h"
#include "skeletons/graph/graph_volume.h"

#include <array>
#include <cstdint>
#include <vector>

namespace cambium {

/// Keeps a reference to the volume. Immutable, used by threads at once.
class VolumeProbe {
 public:
  /// About `samples` places, spread over the bounds of each solid in its own frame, so that thin ones are not missed; more where few
  /// of them are inside. Cancelled, it is of no use.
  VolumeProbe(const GraphVolume& volume, std::size_t samples, const RunOptions& run = {});

  bool empty() const { return inside_.empty(); }
  double volume() const { return volume_; }   ///< cubic metres
  /// Of a ball of that radius around a place in the volume, how much is inside, on average. (0, 1]
  double share_of_ball(double radius) const;
  const std::vector<Vec3>& inside() const { return inside_; }   ///< those of the places
  /// Whether some of the volume may be in the box: false only where there is none, as far as the samples tell.
  bool may_hold(const Box& box) const;

 private:
  using Cell = std::array<int, 3>;

  void sample(std::size_t samples, const RunOptions& run);
  void mark_cells();
  Cell cell_of(const Vec3& p) const;
  std::size_t index(int x, int y, int z) const {
    return (std::size_t(z) * std::size_t(size_[1]) + std::size_t(y)) * std::size_t(size_[0]) + std::size_t(x);
  }

  const GraphVolume& of_;
  std::vector<Vec3> inside_;
  double volume_ = 0;
  double side_ = 1;                   // of the cells that the bounds are divided into
  Cell size_{1, 1, 1};
  std::vector<std::uint8_t> marked_;  // whether one of the samples is in the cell
};

}  // namespace cambium
