// Meshes with creases, by hand.
#pragma once

#include "polygonize/mesh.h"

#include <algorithm>

namespace cambium::testing {

/// The unit cube about the origin, its twelve edges creases: every corner has three sides.
inline Mesh creased_cube() {
  Mesh mesh;
  for (int i = 0; i < 8; ++i) mesh.positions.push_back(Vec3(i & 1, i >> 1 & 1, i >> 2 & 1) - 0.5);
  for (const Vec3& p : mesh.positions) mesh.normals.push_back(glm::vec3(glm::normalize(p)));
  for (const std::array<std::uint32_t, 4>& q :
       {std::array<std::uint32_t, 4>{0, 2, 3, 1}, {4, 5, 7, 6}, {0, 1, 5, 4}, {2, 6, 7, 3}, {0, 4, 6, 2}, {1, 3, 7, 5}}) {
    mesh.triangles.push_back({q[0], q[1], q[2]});
    mesh.triangles.push_back({q[0], q[2], q[3]});
  }
  for (std::uint32_t a = 0; a < 8; ++a)
    for (const std::uint32_t bit : {1u, 2u, 4u})
      if (!(a & bit)) mesh.creases.push_back({a, a | bit});
  std::sort(mesh.creases.begin(), mesh.creases.end());
  return mesh;
}

/// The same cube with one creased edge only, which ends in the smooth surface at both its vertices.
inline Mesh cube_with_one_crease() {
  Mesh mesh = creased_cube();
  mesh.creases = {{0, 1}};
  return mesh;
}

}  // namespace cambium::testing
