#include "polygonize/texture_scale.h"

#include <gtest/gtest.h>

#include <cmath>
#include <numbers>

namespace cambium {
namespace {

TEST(TextureScale, StepsGoOneTwoThreeFourSixEight) {
  const int expected[] = {1, 2, 3, 4, 6, 8, 12, 16, 24, 32};
  for (int step = 0; step < 10; ++step) EXPECT_EQ(wraps_of_step(step), expected[step]) << step;
}

TEST(TextureScale, TheNearestStepIsNeverOffByMoreThanTheRootOfTwo) {
  for (double repeats = 0.71; repeats < 500; repeats *= 1.003) {
    const double off = wraps_of_step(step_of_wraps(repeats)) / repeats;
    EXPECT_LE(off, 1.4143) << repeats;
    EXPECT_GE(off, 0.7071) << repeats;
  }
  EXPECT_EQ(wraps_of_step(step_of_wraps(0.01)), 1);   // a texture goes round at least once
}

TEST(TextureScale, OneThicknessTakesItsWholeGirth) {
  RadiusAreas areas;
  areas.add(0.2, 3);
  EXPECT_NEAR(areas.best_repeat() / (2 * std::numbers::pi * 0.2), 1, 0.03);
}

// Ninety-nine parts in a hundred of the surface count, however thin the rest is.
TEST(TextureScale, ThinTwigsDecideOnlyIfTheyAreMuchOfTheSurface) {
  RadiusAreas few, many;
  few.add(0.1, 1);
  few.add(0.001, 0.005);
  many.add(0.1, 1);
  many.add(0.001, 0.2);
  EXPECT_GT(few.best_repeat(), 0.4);
  EXPECT_LT(many.best_repeat(), 2 * std::numbers::pi * 0.001 * std::sqrt(2));
  EXPECT_GT(many.best_repeat(), 2 * std::numbers::pi * 0.001 * 0.7);
}

TEST(TextureScale, NoSurfaceHasNoRepeat) {
  RadiusAreas areas;
  areas.add(0, 1);
  areas.add(1, 0);
  EXPECT_EQ(areas.best_repeat(), 0);
}

}  // namespace
}  // namespace cambium
