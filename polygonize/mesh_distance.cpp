#include "polygonize/mesh_distance.h"

#include <cmath>

namespace cambium {

MeshDistance::MeshDistance(const Mesh& mesh)
    : mesh_(mesh), tree_(mesh.triangles.size(), [&](std::uint32_t i) {
        Box box;
        for (const std::uint32_t v : mesh.triangles[i]) box.extend(mesh.positions[v]);
        return box;
      }) {}

double MeshDistance::operator()(const Vec3& p, double hint) const {
  const double bound = std::isfinite(hint) ? hint * hint * (1 + 1e-12) + 1e-300 : kInfinity;
  return std::sqrt(tree_.nearest2(p, bound, [&](std::uint32_t i) {
    const auto& t = mesh_.triangles[i];
    return distance2_to_triangle(p, mesh_.positions[t[0]], mesh_.positions[t[1]], mesh_.positions[t[2]]);
  }));
}

}  // namespace cambium
