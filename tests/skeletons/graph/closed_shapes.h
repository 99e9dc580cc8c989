// Closed meshes whose solids are known.
#pragma once

#include "blobtree/geometry.h"

#include <array>
#include <cmath>
#include <cstdint>
#include <numbers>
#include <vector>

namespace cambium::testing {

struct Shape {
  std::vector<Vec3> positions;
  std::vector<std::array<std::uint32_t, 3>> triangles;

  void add(const Shape& other) {
    const auto first = static_cast<std::uint32_t>(positions.size());
    positions.insert(positions.end(), other.positions.begin(), other.positions.end());
    for (const auto& t : other.triangles) triangles.push_back({t[0] + first, t[1] + first, t[2] + first});
  }
  void turn_inside_out() {
    for (auto& t : triangles) std::swap(t[1], t[2]);
  }
};

/// Axis-aligned, outwards.
inline Shape box_shape(const Vec3& lo, const Vec3& hi) {
  Shape box;
  for (unsigned i = 0; i < 8; ++i) box.positions.emplace_back(i & 1 ? hi.x : lo.x, i & 2 ? hi.y : lo.y, i & 4 ? hi.z : lo.z);
  for (const auto& [a, b, c, d] : std::vector<std::array<std::uint32_t, 4>>{
           {0, 2, 3, 1}, {4, 5, 7, 6}, {0, 1, 5, 4}, {2, 6, 7, 3}, {0, 4, 6, 2}, {1, 3, 7, 5}}) {
    box.triangles.push_back({a, b, c});
    box.triangles.push_back({a, c, d});
  }
  return box;
}

/// A ball of rings from pole to pole, with its radius by direction: `bays` as deep as a quarter of it all round. Outwards.
inline Shape ball_shape(std::uint32_t rings, std::uint32_t sides, double radius = 1, const Vec3& center = Vec3(0), int bays = 0) {
  Shape ball;
  for (std::uint32_t i = 0; i <= rings; ++i)
    for (std::uint32_t j = 0; j < sides; ++j) {
      const double a = std::numbers::pi * i / rings, b = 2 * std::numbers::pi * j / sides;
      const double r = radius * (1 - 0.25 * std::sin(a) * std::pow(std::sin(0.5 * bays * b), 2));
      ball.positions.push_back(center + r * Vec3{std::sin(a) * std::cos(b), std::sin(a) * std::sin(b), std::cos(a)});
    }
  for (std::uint32_t j = 0; j < sides; ++j) {
    ball.positions[j] = center + Vec3{0, 0, radius};
    ball.positions[rings * sides + j] = center - Vec3{0, 0, radius};
  }
  for (std::uint32_t i = 0; i < rings; ++i)
    for (std::uint32_t j = 0; j < sides; ++j) {
      const std::uint32_t k = (j + 1) % sides, a = i * sides + j, b = (i + 1) * sides + j, c = (i + 1) * sides + k, d = i * sides + k;
      if (i + 1 < rings) ball.triangles.push_back({a, b, c});
      if (i > 0) ball.triangles.push_back({a, c, d});
    }
  return ball;
}

}  // namespace cambium::testing
