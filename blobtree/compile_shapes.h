// Authored primitives to compiled shapes, and how far an atom reaches along a direction. Private to blobtree/.
#pragma once

#include "blobtree/compiled_tree.h"

namespace cambium {

/// Adds the payload of one authored node (shapes, segments, blends, warps) and sets op and payload. Segments of a chain are
/// appended to tree.segments; `segment_count` tells how many. A round cone is a chain of two.
struct ShapeOfNode {
  std::uint32_t first_segment = 0, segment_count = 0;  ///< chains
  double radius = kInfinity;                           ///< smallest surface radius of another primitive
  Vec3 axis{0, 0, 1};                                  ///< of its native coordinates
};
ShapeOfNode compile_shape(CompiledTree& tree, CompiledNode& compiled, const Node& node);

/// Projection of the atom's support onto a unit direction, in the atom's own space.
Interval support_along(const CompiledTree& tree, const Atom& atom, const Vec3& direction);

}  // namespace cambium
