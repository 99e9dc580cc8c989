// Points of a disc from points of a square.
#pragma once

#include <array>
#include <cmath>
#include <numbers>

namespace cambium {

/// Of the unit disc, equal areas for equal areas of [0, 1)^2 and neighbours for neighbours (Shirley & Chiu 1997).
inline std::array<double, 2> unit_disc(const std::array<double, 2>& sample) {
  const double a = 2 * sample[0] - 1, b = 2 * sample[1] - 1;
  if (a == 0 && b == 0) return {0, 0};
  constexpr double kQuarter = std::numbers::pi / 4;
  const bool wide = std::abs(a) > std::abs(b);
  const double radius = wide ? a : b, angle = wide ? kQuarter * (b / a) : 2 * kQuarter - kQuarter * (a / b);
  return {radius * std::cos(angle), radius * std::sin(angle)};
}

}  // namespace cambium
