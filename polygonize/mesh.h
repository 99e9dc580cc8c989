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
  /// Edges along which the surface is not smooth (contact ridges, cuts), lower vertex first, ascending; each is an edge of two
  /// triangles. Their vertices have the mean normal.
  std::vector<std::array<std::uint32_t, 2>> creases;
};

}  // namespace cambium
