#include "cli/leaf_shapes.h"

#include <utility>

namespace cambium {
namespace {

/// Where an ovate leaf is how wide: parts of its length and of its width.
constexpr glm::vec2 kOutline[] = {{0.08f, 0.36f}, {0.20f, 0.80f}, {0.35f, 1.0f}, {0.52f, 0.92f}, {0.70f, 0.64f}, {0.87f, 0.27f}};

float part(float value, float lo, float hi) { return hi > lo ? (value - lo) / (hi - lo) : 0.5f; }

/// Normals, and an image that lies over the whole extent.
Sheet finished(Sheet sheet) {
  glm::vec3 lo(0.0f), hi(0.0f);
  if (!sheet.positions.empty()) lo = hi = sheet.positions.front();
  for (const glm::vec3& p : sheet.positions) lo = glm::min(lo, p), hi = glm::max(hi, p);
  for (const glm::vec3& p : sheet.positions) sheet.uvs.emplace_back(part(p.x, lo.x, hi.x), part(p.y, lo.y, hi.y));
  sheet.normals = mean_normals(sheet);
  return sheet;
}

}  // namespace

Sheet drawn_leaf(const OrganShape& shape) {
  Sheet sheet;
  for (const Vec3& vertex : shape.vertices) sheet.positions.emplace_back(vertex);
  sheet.triangles = shape.triangles;
  return finished(std::move(sheet));
}

Sheet leaf_card(double width, double length) {
  const auto x = static_cast<float>(width / 2), y = static_cast<float>(length);
  Sheet sheet;
  sheet.positions = {{-x, 0, 0}, {x, 0, 0}, {x, y, 0}, {-x, y, 0}};
  sheet.triangles = {{0, 1, 2}, {0, 2, 3}};
  return finished(std::move(sheet));
}

Sheet plain_leaf(double width, double length) {
  const auto half = static_cast<float>(width / 2), whole = static_cast<float>(length);
  Sheet sheet;
  sheet.positions.emplace_back(0.0f);
  for (const glm::vec2& at : kOutline)
    for (const float side : {-1.0f, 1.0f}) sheet.positions.emplace_back(side * at.y * half, at.x * whole, 0.0f);
  sheet.positions.emplace_back(0.0f, whole, 0.0f);
  const auto tip = static_cast<std::uint32_t>(sheet.positions.size() - 1);
  sheet.triangles.push_back({0, 2, 1});
  for (std::uint32_t left = 1; left + 2 < tip; left += 2) {
    sheet.triangles.push_back({left, left + 1, left + 3});
    sheet.triangles.push_back({left, left + 3, left + 2});
  }
  sheet.triangles.push_back({tip - 2, tip - 1, tip});
  return finished(std::move(sheet));
}

}  // namespace cambium
