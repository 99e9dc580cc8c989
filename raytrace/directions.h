// Directions: frames about one, and samples around one.
#pragma once

#include "blobtree/geometry.h"

#include <array>

namespace cambium {

/// Right-handed orthonormal pair around a unit vector.
std::array<Vec3, 2> tangents(const Vec3& n);
/// Uniform on the unit disc, equal areas to equal areas (Shirley and Chiu 1997).
std::array<double, 2> disc_point(const std::array<double, 2>& sample);
/// Cosine-distributed about a unit normal.
Vec3 cosine_direction(const Vec3& normal, const std::array<double, 2>& sample);
/// Unit vector of an azimuth (from x towards y) and an elevation, radians.
Vec3 direction_of(double azimuth, double elevation);

}  // namespace cambium
