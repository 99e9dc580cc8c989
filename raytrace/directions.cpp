#include "raytrace/directions.h"

#include <algorithm>
#include <cmath>
#include <numbers>

namespace cambium {

std::array<Vec3, 2> tangents(const Vec3& n) {
  const Vec3 side = std::abs(n.z) < 0.9 ? Vec3(0, 0, 1) : Vec3(1, 0, 0);
  const Vec3 s = glm::normalize(glm::cross(side, n));
  return {s, glm::cross(n, s)};
}

std::array<double, 2> disc_point(const std::array<double, 2>& sample) {
  const double a = 2 * sample[0] - 1, b = 2 * sample[1] - 1;
  if (a == 0 && b == 0) return {0, 0};
  const double quarter = std::numbers::pi / 4;
  const double r = std::abs(a) > std::abs(b) ? a : b;
  const double angle = std::abs(a) > std::abs(b) ? quarter * (b / a) : 2 * quarter - quarter * (a / b);
  return {r * std::cos(angle), r * std::sin(angle)};
}

Vec3 cosine_direction(const Vec3& normal, const std::array<double, 2>& sample) {
  const auto [x, y] = disc_point(sample);
  const auto [s, t] = tangents(normal);
  return glm::normalize(x * s + y * t + std::sqrt(std::max(1e-6, 1 - x * x - y * y)) * normal);
}

Vec3 direction_of(double azimuth, double elevation) {
  const double flat = std::cos(elevation);
  return {flat * std::cos(azimuth), flat * std::sin(azimuth), std::sin(elevation)};
}

}  // namespace cambium
