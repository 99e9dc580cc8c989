// An indexed triangle mesh with what an artist needs on each vertex.
#pragma once

#include "blobtree/geometry.h"

#include <array>
#include <cstdint>
#include <vector>

namespace cambium {

/// Triangles wind counter-clockwise seen from outside. normals and colors are empty or as long as positions.
struct Mesh {
  std::vector<Vec3> positions;                        ///< metres, z up
  std::vector<glm::vec3> normals;                     ///< unit, outward
  std::vector<std::array<std::uint8_t, 4>> colors;    ///< sRGB, alpha
  std::vector<std::array<std::uint32_t, 3>> triangles;
};

}  // namespace cambium
