// How far a point is from a triangle.
#pragma once

#include "blobtree/geometry.h"

namespace cambium {

/// Squared, in double, to rounding. A triangle without area counts as the segment or point that it is.
double distance2_to_triangle(const Vec3& p, const Vec3& a, const Vec3& b, const Vec3& c);

}  // namespace cambium
