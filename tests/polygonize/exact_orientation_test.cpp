#include "polygonize/exact_orientation.h"

#include "tests/blobtree/random_blobtrees.h"
#include "tests/polygonize/cgal_check.h"

#include <gtest/gtest.h>

namespace cambium {
namespace {

const Box kUnit{Vec3(-1), Vec3(1)};

int oracle(const Vec3& a, const Vec3& b, const Vec3& c, const Vec3& d) { return testing::cgal_orientation(a, b, c, d); }

TEST(ExactOrientation, KnownSides) {
  const Vec3 o(0), x(1, 0, 0), y(0, 1, 0), z(0, 0, 1);
  EXPECT_EQ(orientation_3d(x, y, o, z), -1);
  EXPECT_EQ(orientation_3d(y, x, o, z), 1);
  EXPECT_EQ(orientation_3d(o, x, y, x + y), 0);
  EXPECT_EQ(orientation_2d(o, x, y, 2), 1);
  EXPECT_EQ(orientation_2d(x, o, y, 2), -1);
  EXPECT_EQ(orientation_2d(o, z, x, 2), 0);
  EXPECT_TRUE(collinear(o, x, 3.0 * x));
  EXPECT_TRUE(collinear(o, o, y));
  EXPECT_FALSE(collinear(o, x, y));
}

// The reference has the opposite sign: its fourth point is above a counter-clockwise triangle, ours below.
TEST(ExactOrientation, ItAgreesWithCgalOnPointsInAndNextToAPlane) {
  Draws draws(11);
  int zeros = 0, quick_unsure = 0;
  for (int i = 0; i < 40000; ++i) {
    const double scale = std::pow(10.0, draws.in(-6, 6));
    const Vec3 a = scale * draws.point(kUnit), b = scale * draws.point(kUnit), c = a + std::pow(10.0, draws.in(-9, 0)) * scale * draws.point(kUnit);
    Vec3 d = a + draws.in(-1, 2) * (b - a) + draws.in(-1, 2) * (c - a);   // in the plane, but for rounding
    if (i % 4 == 0) d = i % 8 ? b : a + 2.0 * (b - a);                    // certainly, or nearly, on an edge
    if (i % 4 == 1) d[draws.below(3)] = std::nextafter(d.x, draws.in(-1, 1));
    const int sign = orientation_3d(a, b, c, d);
    ASSERT_EQ(sign, -oracle(a, b, c, d)) << i;
    ASSERT_EQ(sign, -orientation_3d(b, a, c, d)) << i;
    ASSERT_EQ(sign, orientation_3d(b, c, a, d)) << i;
    ASSERT_EQ(collinear(a, b, d), testing::cgal_collinear(a, b, d)) << i;
    zeros += sign == 0;
    quick_unsure += quick_orientation_3d(a, b, c, d) == 0;
  }
  EXPECT_GT(zeros, 4000);
  EXPECT_GT(quick_unsure, zeros + 8000);   // so that the expansions have been at work
}

TEST(ExactOrientation, CoordinatesOfVeryDifferentSizesAreKeptWhole) {
  Draws draws(12);
  for (int i = 0; i < 20000; ++i) {
    std::array<Vec3, 4> p;
    for (Vec3& q : p) {
      for (int a = 0; a < 3; ++a) {
        q[a] = draws.chance(0.3) ? std::round(draws.in(-2, 2)) : std::ldexp(draws.in(-1, 1), draws.below(120) - 80);
      }
    }
    ASSERT_EQ(orientation_3d(p[0], p[1], p[2], p[3]), -oracle(p[0], p[1], p[2], p[3])) << i;
    ASSERT_EQ(collinear(p[0], p[1], p[2]), testing::cgal_collinear(p[0], p[1], p[2])) << i;
  }
}

}  // namespace
}  // namespace cambium
