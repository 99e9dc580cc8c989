// The pen that the turtle draws a skeleton with.
#pragma once

#include <cstddef>
#include <cstdint>
#include <vector>

#include "skeletons/skeleton.h"

namespace cambium {

struct AxisSample {
  Vec3 position{0.0};
  double radius = 0;
};

/// Adds internodes end to end. A piece of the skeleton begins where the pen was moved through the air; pieces that begin at
/// one unmoved start share its node. Radii never rise towards a tip: they are lowered, and counted.
class SkeletonPen {
 public:
  /// Where a line goes on; the turtle saves and restores it at brackets.
  struct Place {
    std::int32_t node = -1;   ///< drawn to last; -1: none since the start was set
    std::uint32_t start = 0;  ///< which unmoved start this piece has
    bool lateral = false;     ///< the next internode is the first behind a bracket
  };

  /// The turtle stands elsewhere than where it drew to.
  void lift(Place& place);
  /// An internode from where the turtle stands to `tip`.
  void draw(Place& place, const AxisSample& from, const AxisSample& tip);
  /// The node that a line from there would go on from; -1: it would begin a piece.
  std::int32_t node_at(const Place& place, const Vec3& from) const;
  /// Pieces that begin where the pen was lifted to for `place` go on from a node instead, which stands there.
  void start_at(const Place& place, std::int32_t node) { starts_[place.start] = node; }
  /// The node that what grows at `place` hangs on; -1: none yet.
  std::int32_t nearest_node(const Place& place) const { return place.node >= 0 ? place.node : starts_[place.start]; }

  /// No more nodes can be numbered.
  bool full() const;
  std::size_t radii_clamped() const { return radii_clamped_; }
  Skeleton take() && { return std::move(skeleton_); }

 private:
  bool stands_at(std::int32_t node, const Vec3& position) const;
  std::int32_t add(const SkeletonNode& node);

  Skeleton skeleton_;
  /// Node at each place where a piece can begin, -1 before one does: branches that all begin at the axiom's start share it.
  std::vector<std::int32_t> starts_{-1};
  std::size_t radii_clamped_ = 0;
};

}  // namespace cambium
