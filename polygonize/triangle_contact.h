// Whether two triangles of a mesh meet where they should not, exactly.
#pragma once

#include "blobtree/geometry.h"

#include <array>
#include <cstdint>
#include <vector>

namespace cambium {

using TriangleCorners = std::array<Vec3, 3>;

/// Closed triangles with no corner in common: they have a point in common.
bool triangles_meet(const TriangleCorners& s, const TriangleCorners& t);
/// s[0] and t[0] are one vertex: they have a second point in common.
bool triangles_meet_beyond_corner(const TriangleCorners& s, const TriangleCorners& t);
/// s[0], s[1] and t[0], t[1] are one edge: they have a point beyond it in common, that is, lie folded onto each other.
bool triangles_meet_beyond_edge(const TriangleCorners& s, const TriangleCorners& t);
/// Triangles by the numbers of their corners: they meet anywhere but in the corner or the edge that they share.
bool triangles_meet_wrongly(const std::vector<Vec3>& positions, const std::array<std::uint32_t, 3>& s,
                            const std::array<std::uint32_t, 3>& t);

}  // namespace cambium
