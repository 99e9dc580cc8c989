// A closed outline in space, cut into triangles.
#pragma once

#include <array>
#include <cstdint>
#include <optional>
#include <vector>

#include "blobtree/geometry.h"
#include "blobtree/run_options.h"

namespace cambium {

using OutlineTriangles = std::vector<std::array<std::uint32_t, 3>>;

/// Triangles of a closed outline, concave or not, as indices into its corners, in its own sense. Ear clipping in the plane
/// that fits best (Newell's); corners need not lie in it. `outline`: of a size about 1. Empty where it has no area: fewer
/// than three corners, or all on a line. Where edges cross, the triangles cover it in some way. Time goes with the square of
/// the corners; looks at run.cancel. nullopt if cancelled.
std::optional<OutlineTriangles> triangulated(const std::vector<Vec3>& outline, const RunOptions& run);

}  // namespace cambium
