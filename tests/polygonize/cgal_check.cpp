#include "tests/polygonize/cgal_check.h"

#include <CGAL/Exact_predicates_inexact_constructions_kernel.h>
#include <CGAL/Polygon_mesh_processing/self_intersections.h>
#include <CGAL/Surface_mesh.h>

#include <algorithm>
#include <stdexcept>

namespace cambium::testing {
namespace {

using Kernel = CGAL::Exact_predicates_inexact_constructions_kernel;
using SurfaceMesh = CGAL::Surface_mesh<Kernel::Point_3>;

Kernel::Point_3 point(const Vec3& p) { return {p.x, p.y, p.z}; }

}  // namespace

std::vector<std::array<std::uint32_t, 2>> cgal_self_intersections(const Mesh& mesh) {
  SurfaceMesh surface;
  std::vector<SurfaceMesh::Vertex_index> vertices;
  for (const Vec3& p : mesh.positions) vertices.push_back(surface.add_vertex(point(p)));
  for (const auto& t : mesh.triangles) {
    if (surface.add_face(vertices[t[0]], vertices[t[1]], vertices[t[2]]) == SurfaceMesh::null_face()) {
      throw std::invalid_argument("not a 2-manifold");
    }
  }
  std::vector<std::pair<SurfaceMesh::Face_index, SurfaceMesh::Face_index>> found;
  CGAL::Polygon_mesh_processing::self_intersections(surface, std::back_inserter(found));
  std::vector<std::array<std::uint32_t, 2>> pairs;
  for (const auto& [a, b] : found) {
    const auto i = static_cast<std::uint32_t>(a), j = static_cast<std::uint32_t>(b);
    pairs.push_back({std::min(i, j), std::max(i, j)});
  }
  std::sort(pairs.begin(), pairs.end());
  return pairs;
}

int cgal_orientation(const Vec3& a, const Vec3& b, const Vec3& c, const Vec3& d) {
  return CGAL::orientation(point(a), point(b), point(c), point(d));
}

bool cgal_collinear(const Vec3& a, const Vec3& b, const Vec3& c) { return CGAL::collinear(point(a), point(b), point(c)); }

}  // namespace cambium::testing
