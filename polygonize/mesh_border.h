// The lines along which a mesh is open. Private to polygonize/.
#pragma once

#include "polygonize/mesh.h"

#include <cstdint>
#include <span>
#include <vector>

namespace cambium {

struct MeshBorder {
  /// Closed, each from its lowest vertex, in the direction in which the sides of triangles run there.
  std::vector<std::vector<std::uint32_t>> loops;
  /// By loop: the triangles that touch it and those that touch these, ascending.
  std::vector<std::vector<std::uint32_t>> triangles;
};

/// may_be_open: by vertex, false where no side that ends there is open. Two open sides may leave from one vertex nowhere.
/// In the current arena. Cost: a look at every triangle.
MeshBorder find_border(const Mesh& mesh, const std::vector<std::uint8_t>& may_be_open);

}  // namespace cambium
