// Which atoms can matter in a box. Private to blobtree/.
#pragma once

#include "blobtree/compiled_tree.h"
#include "blobtree/swept_bounds.h"

#include <array>
#include <span>
#include <vector>

namespace cambium {

/// Atoms, ascending, with bounds over the ball around a box: of a chain's segment its swept ratio, of another primitive its
/// value; of warped atoms nothing is said.
struct ActiveAtoms {
  std::vector<std::uint32_t> atoms;
  std::vector<Interval> bounds;

  std::size_t size() const { return atoms.size(); }
  bool empty() const { return atoms.empty(); }
  void clear() {
    atoms.clear();
    bounds.clear();
  }
};

/// Those of `candidates` (ascending) that can be non-zero in the box, by their bounds and, where no warp is in the way,
/// by their shape. Of a chain's segments only those stay that can be the nearest one somewhere in the box: the chain is
/// the minimum over its segments, so leaving out the others changes no bit. Cost: linear in candidates.
void find_active(const CompiledTree& tree, std::span<const std::uint32_t> candidates, const Box& box, ActiveAtoms& active);

/// Of the whole tree, by its index. Cost: a logarithmic search, and linear in what is near the box.
void find_active(const CompiledTree& tree, const Box& box, ActiveAtoms& active);

inline constexpr std::size_t kChildren = kBalls;   ///< of a cube

/// The same for the eight children of a cube at once. Child k lies on the high side of axis a where bit a of k is set.
class ChildSplitter {
 public:
  void split(const CompiledTree& tree, std::span<const std::uint32_t> candidates, const Box& cube,
             std::array<ActiveAtoms, kChildren>& children);

 private:
  std::vector<SweptSegment<double>> segments_;
  std::vector<BallBounds> bounds_;
};

}  // namespace cambium
