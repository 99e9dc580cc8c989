#include "raytrace/tone.h"

#include <algorithm>
#include <cmath>

namespace cambium {

double srgb_from_linear(double linear) {
  return linear <= 0.0031308 ? 12.92 * linear : 1.055 * std::pow(linear, 1 / 2.4) - 0.055;
}

double linear_from_srgb(double srgb) { return srgb <= 0.04045 ? srgb / 12.92 : std::pow((srgb + 0.055) / 1.055, 2.4); }

namespace {

constexpr double kGain = 1.3;        // shows middle grey, 0.18, as 0.43 of the screen's range
constexpr double kBrightest = 1e4;   // beyond, all is white: the curve's squares stay finite

/// Not a number and what is darker than black: black.
double limited(double radiance) { return radiance > 0 ? std::min(kGain * radiance, kBrightest) : 0; }

}  // namespace

Vec3 display_from_linear(const Vec3& radiance) {
  // Hill's fit to the ACES reference rendering and output transforms: the curve works on channels that overlap, so that bright
  // colours fade to white as on film and none turns into another. Columns, as glm has them.
  static const glm::dmat3 kToOverlapping(0.59719, 0.07600, 0.02840, 0.35458, 0.90834, 0.13383, 0.04823, 0.01566, 0.83777);
  static const glm::dmat3 kFromOverlapping(1.60475, -0.10208, -0.00327, -0.53108, 1.10813, -0.07276, -0.07367, -0.00605, 1.07602);
  const Vec3 v = kToOverlapping * Vec3(limited(radiance.x), limited(radiance.y), limited(radiance.z));
  const Vec3 curved = (v * (v + 0.0245786) - 0.000090537) / (v * (0.983729 * v + 0.4329510) + 0.238081);
  const Vec3 shown = glm::clamp(kFromOverlapping * curved, 0.0, 1.0);
  return {srgb_from_linear(shown.x), srgb_from_linear(shown.y), srgb_from_linear(shown.z)};
}

}  // namespace cambium
