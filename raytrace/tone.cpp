#include "raytrace/tone.h"

#include <algorithm>
#include <cmath>

namespace cambium {

double srgb_from_linear(double linear) {
  return linear <= 0.0031308 ? 12.92 * linear : 1.055 * std::pow(linear, 1 / 2.4) - 0.055;
}

double linear_from_srgb(double srgb) { return srgb <= 0.04045 ? srgb / 12.92 : std::pow((srgb + 0.055) / 1.055, 2.4); }

Vec3 display_from_linear(const Vec3& radiance) {
  Vec3 out;
  for (int c = 0; c < 3; ++c) {
    const double x = std::isfinite(radiance[c]) ? std::max(0.0, 0.62 * radiance[c]) : 0.0;
    // Narkowicz 2015, a fit to the ACES reference curve; the factor above keeps a white wall in the sun below clipping.
    const double y = std::min(1.0, x * (2.51 * x + 0.03) / (x * (2.43 * x + 0.59) + 0.14));
    out[c] = srgb_from_linear(x > 1e4 ? 1.0 : y);
  }
  return out;
}

}  // namespace cambium
