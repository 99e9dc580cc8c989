// From linear light to what a screen shows.
#pragma once

#include "blobtree/geometry.h"

namespace cambium {

/// sRGB transfer function (IEC 61966-2-1) and its inverse, one channel, [0, 1].
double srgb_from_linear(double linear);
double linear_from_srgb(double srgb);

/// A filmic curve (Hill 2017, a fit to ACES), then sRGB: linear radiance >= 0 to [0, 1]; what is not a number is black. 0.18 shows as
/// 0.43, 1 as 0.85; white begins near 8.
Vec3 display_from_linear(const Vec3& radiance);

inline double luminance(const Vec3& linear) { return glm::dot(linear, Vec3(0.2126, 0.7152, 0.0722)); }

}  // namespace cambium
