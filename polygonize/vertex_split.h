// Vertices as a graphics card wants them: one normal, one texture coordinate and one tangent each.
#pragma once

#include "polygonize/mesh_attributes.h"

namespace cambium {

struct SplitMesh {
  std::vector<std::uint32_t> vertex;                        ///< of the mesh, for each split one
  std::vector<std::uint32_t> uv;                            ///< into MeshAttributes::uvs; empty without
  std::vector<glm::vec3> normals;                           ///< empty without
  std::vector<glm::vec4> tangents;                          ///< direction of u, orthogonal to the normal; w: the side of v. Empty without
  std::vector<std::array<std::uint32_t, 3>> triangles;      ///< in the mesh's order
};

/// A vertex is split where triangles around it differ in uv (seams) or normal (creases). Numbered by first use.
/// attributes may be null. Cost: some 0.1 microseconds a triangle.
SplitMesh split_vertices(const Mesh& mesh, const MeshAttributes* attributes);

}  // namespace cambium
