// Normals by triangle corner: at creases each side of the surface has its own.
#pragma once

#include "polygonize/mesh.h"

#include <array>
#include <cstdint>
#include <vector>

namespace cambium {

/// As OBJ's vn: the first are the mesh's own, one per vertex; vertices on creases have one more for each side after the first.
struct CornerNormals {
  std::vector<glm::vec3> normals;                           ///< unit
  std::vector<std::array<std::uint32_t, 3>> triangles;      ///< empty where the mesh has no creases: the vertices' numbers do
  std::uint32_t at(const Mesh& mesh, std::size_t triangle, int corner) const {
    return triangles.empty() ? mesh.triangles[triangle][corner] : triangles[triangle][corner];
  }
};

/// A side at a vertex is the triangles around it between two creases; its normal is the mean of theirs, weighted by angle. A vertex
/// where a crease only ends has one side and keeps its normal. The mesh needs normals. Cost: linear in triangles.
CornerNormals corner_normals(const Mesh& mesh);

/// Numbers from 1 for parts of the surface that are smooth within and meet others only in creases (OBJ's smoothing groups): one per
/// triangle, all 1 without creases.
std::vector<std::uint32_t> smoothing_groups(const Mesh& mesh, const CornerNormals& corners);

}  // namespace cambium
