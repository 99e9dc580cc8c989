#include "blobtree/triangle_distance.h"

#include <gtest/gtest.h>

#include <cmath>

namespace cambium {
namespace {

TEST(TriangleDistance, IsToItsFaceItsEdgesAndItsCorners) {
  const Vec3 o(0), x(1, 0, 0), y(0, 1, 0);
  const auto distance = [&](const Vec3& p) { return std::sqrt(distance2_to_triangle(p, o, x, y)); };
  EXPECT_DOUBLE_EQ(distance({0.2, 0.3, -2}), 2);
  EXPECT_DOUBLE_EQ(distance({0.5, -3, 0}), 3);
  EXPECT_DOUBLE_EQ(distance({2, 2, 0}), std::sqrt(4.5));
  EXPECT_DOUBLE_EQ(distance({-3, -4, 0}), 5);
  EXPECT_DOUBLE_EQ(distance({4, 0, 4}), 5);
  EXPECT_DOUBLE_EQ(std::sqrt(distance2_to_triangle({0, 3, 0}, o, x, 2.0 * x)), 3);      // no area: a segment
  EXPECT_DOUBLE_EQ(std::sqrt(distance2_to_triangle({4, 3, 0}, o, x, 2.0 * x)), std::sqrt(13.0));
  EXPECT_DOUBLE_EQ(std::sqrt(distance2_to_triangle({3, 4, 0}, o, o, o)), 5);            // a point
}

}  // namespace
}  // namespace cambium
