#include "blobtree/sheet.h"

#include <cmath>

namespace cambium {

std::vector<glm::vec3> mean_normals(const Sheet& sheet) {
  std::vector<glm::vec3> normals(sheet.positions.size(), glm::vec3(0.0f));
  for (const auto& [a, b, c] : sheet.triangles) {
    const glm::vec3 across = glm::cross(sheet.positions[b] - sheet.positions[a], sheet.positions[c] - sheet.positions[a]);
    for (const std::uint32_t corner : {a, b, c}) normals[corner] += across;
  }
  for (glm::vec3& normal : normals) {
    const float length = glm::length(normal);
    normal = length > 0 && std::isfinite(length) ? normal / length : glm::vec3(0, 0, 1);
  }
  return normals;
}

}  // namespace cambium
