// Thin open surfaces of triangles, such as a leaf: what stands beside a field and has no inside.
#pragma once

#include "blobtree/geometry.h"

#include <array>
#include <cstdint>
#include <vector>

namespace cambium {

/// One entry of each vector but the last is a vertex.
struct Sheet {
  std::vector<glm::vec3> positions;
  std::vector<glm::vec3> normals;   ///< unit, of the side from which triangles wind counter-clockwise
  std::vector<glm::vec2> uvs;       ///< of an image, v upwards
  std::vector<std::array<std::uint32_t, 3>> triangles;
};

/// By vertex the mean of its triangles' normals by area; (0, 0, 1) where they add up to nothing. Cost: linear.
std::vector<glm::vec3> mean_normals(const Sheet& sheet);

}  // namespace cambium
