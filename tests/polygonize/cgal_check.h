// What CGAL, which shares no code with us, says of the same geometry.
#pragma once

#include "polygonize/mesh.h"

#include <array>
#include <cstddef>
#include <vector>

namespace cambium::testing {

/// Pairs of triangles, lower first, ascending. Errors: std::invalid_argument for a mesh that is not an orientable 2-manifold (with
/// or without boundary), which CGAL cannot hold.
std::vector<std::array<std::uint32_t, 2>> cgal_self_intersections(const Mesh& mesh);

/// CGAL::orientation and CGAL::collinear, exact.
int cgal_orientation(const Vec3& a, const Vec3& b, const Vec3& c, const Vec3& d);
bool cgal_collinear(const Vec3& a, const Vec3& b, const Vec3& c);

}  // namespace cambium::testing
