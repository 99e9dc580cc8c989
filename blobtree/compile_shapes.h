// Authored primitives to compiled shapes, and how far an atom reaches along a direction. Private to blobtree/.
#pragma once

#include "blobtree/compiled_tree.h"

namespace cambium {

/// Adds the payload of one authored node (shapes, chains, blends, warps) and sets op and payload. A round cone is a chain
/// of two.
void compile_shape(CompiledTree& tree, CompiledNode& compiled, const Node& node);

/// Projection of the atom's support onto a unit direction, in the atom's own space.
Interval support_along(const CompiledTree& tree, std::uint32_t atom, const Vec3& direction);
/// The same along the three axes.
Box own_box(const CompiledTree& tree, std::uint32_t atom);

}  // namespace cambium
