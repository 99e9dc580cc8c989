#include "raytrace/pixel_filter.h"

#include <algorithm>
#include <cmath>
#include <numbers>

namespace cambium {
namespace {

/// Integral of the four-term Blackman-Harris window (Harris 1978) from its left end to x in [0, 1], the whole being 1.
double share_below(double x) {
  const double a = 2 * std::numbers::pi * x;
  const double rippling = -0.48829 * std::sin(a) + 0.14128 * std::sin(2 * a) / 2 - 0.01168 * std::sin(3 * a) / 3;
  return x + rippling / (2 * std::numbers::pi * 0.35875);
}

double quantile(double share) {
  double lo = 0, hi = 1;
  for (int i = 0; i < 60; ++i) {
    const double middle = 0.5 * (lo + hi);
    (share_below(middle) < share ? lo : hi) = middle;
  }
  return 0.5 * (lo + hi);
}

}  // namespace

PixelFilter::PixelFilter(double radius) {
  for (int i = 0; i <= kSteps; ++i) quantiles_[i] = radius * (2 * quantile(double(i) / kSteps) - 1);
}

double PixelFilter::offset(double sample) const {
  const double at = std::clamp(sample, 0.0, 1.0) * kSteps;
  const int below = std::min(static_cast<int>(at), kSteps - 1);
  return std::lerp(quantiles_[below], quantiles_[below + 1], at - below);
}

}  // namespace cambium
