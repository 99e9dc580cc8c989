#include "raytrace/lighting.h"

#include <algorithm>
#include <cmath>
#include <numbers>

namespace cambium {
namespace {

/// Uniform on the unit disc, equal areas (Shirley and Chiu 1997).
std::array<double, 2> disc(const std::array<double, 2>& sample) {
  const double a = 2 * sample[0] - 1, b = 2 * sample[1] - 1;
  if (a == 0 && b == 0) return {0, 0};
  const double quarter = std::numbers::pi / 4;
  const double r = std::abs(a) > std::abs(b) ? a : b;
  const double angle = std::abs(a) > std::abs(b) ? quarter * (b / a) : 2 * quarter - quarter * (a / b);
  return {r * std::cos(angle), r * std::sin(angle)};
}

}  // namespace

std::array<Vec3, 2> tangents(const Vec3& n) {
  const Vec3 side = std::abs(n.z) < 0.9 ? Vec3(0, 0, 1) : Vec3(1, 0, 0);
  const Vec3 s = glm::normalize(glm::cross(side, n));
  return {s, glm::cross(n, s)};
}

Vec3 cosine_direction(const Vec3& normal, const std::array<double, 2>& sample) {
  const auto [x, y] = disc(sample);
  const auto [s, t] = tangents(normal);
  return glm::normalize(x * s + y * t + std::sqrt(std::max(1e-6, 1 - x * x - y * y)) * normal);
}

Lighting::Lighting(const Light& light) : light_(light) {
  const double up = std::sin(light.sun_elevation), flat = std::cos(light.sun_elevation);
  sun_ = {flat * std::cos(light.sun_azimuth), flat * std::sin(light.sun_azimuth), up};
  const auto [s, t] = tangents(sun_);
  sun_s_ = s;
  sun_t_ = t;
  const Vec3 mean_sky = 0.5 * (light.sky_zenith + light.sky_horizon);
  const Vec3 on_ground = light.sun_color * std::max(0.0, up) + mean_sky;
  // The ground beneath a tree is partly in its shadow.
  if (light.ground) bounce_ = 0.6 * light.ground_color * on_ground;
  hidden_ = 0.16 * (mean_sky + 0.5 * bounce_) * Vec3(1.0, 0.86, 0.68);
}

Vec3 Lighting::background(const Vec3& direction) const {
  const double height = std::max(0.0, direction.z);
  Vec3 color = glm::mix(light_.sky_horizon, light_.sky_zenith, 1 - std::pow(1 - std::min(height, 1.0), 2.6));
  const double glow = std::max(0.0, glm::dot(direction, sun_));
  color += 0.035 * light_.sun_color * std::pow(glow, 12.0);
  return color;
}

Vec3 Lighting::sky(const Vec3& direction) const {
  // Over a narrow band, so that the horizon makes no edge in the shading.
  const double above = std::clamp(0.5 + direction.z / 0.1, 0.0, 1.0);
  const Vec3 below = light_.ground ? bounce_ : light_.sky_horizon * 0.35;
  return glm::mix(below, background(direction), above);
}

Vec3 Lighting::towards_sun(const std::array<double, 2>& sample) const {
  const auto [x, y] = disc(sample);
  const double size = std::tan(std::clamp(light_.sun_size, 0.0, 1.0));
  return glm::normalize(sun_ + size * (x * sun_s_ + y * sun_t_));
}

}  // namespace cambium
