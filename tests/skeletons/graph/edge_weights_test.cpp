#include "skeletons/graph/edge_weights.h"

#include "blobtree/input_error.h"

#include <gtest/gtest.h>

#include <limits>

namespace cambium {
namespace {

TEST(WeightPaint, ABallScalesByItsFactorInTheMiddleAndNotAtAllFromItsRimOn) {
  for (const double factor : {0.1, 1.0, 7.0}) {
    const WeightPaint paint({{.center = {1, 2, 3}, .radius = 2, .factor = factor}}, nullptr);
    EXPECT_DOUBLE_EQ(paint.factor({1, 2, 3}), factor);
    EXPECT_EQ(paint.factor({3, 2, 3}), 1);
    EXPECT_EQ(paint.factor({10, 2, 3}), 1);
    double last = factor;
    for (double t = 0; t <= 2.2; t += 0.01) {   // smooth, and never back
      const double now = paint.factor({1, 2 + t, 3});
      EXPECT_LE(std::abs(now - last), 0.02 * std::abs(factor - 1));
      EXPECT_LE(std::abs(now - 1), std::abs(last - 1));
      last = now;
    }
  }
}

TEST(WeightPaint, BallsAndGridMultiply) {
  const WeightPaint paint({{.center = {0, 0, 0}, .radius = 1, .factor = 3}, {.center = {0, 0, 0}, .radius = 2, .factor = 0.5}},
                          [](const Vec3& p) { return 2 + p.x; });
  EXPECT_DOUBLE_EQ(paint.factor({0, 0, 0}), 3.0);
  EXPECT_DOUBLE_EQ(paint.factor({5, 0, 0}), 7.0);
  EXPECT_TRUE(WeightPaint{}.empty());
  EXPECT_FALSE(paint.empty());
}

TEST(WeightPaint, BallsWithoutSizeOrFactorAreRefusedByTheirKey) {
  const std::pair<WeightBall, const char*> bad[] = {{{.radius = 0}, "radius"}, {{.factor = 0}, "factor"}, {{.factor = -1}, "factor"},
                                                    {{.center = {std::numeric_limits<double>::quiet_NaN(), 0, 0}}, "center"}};
  for (const auto& [ball, key] : bad) {
    try {
      WeightPaint({ball}, nullptr);
      FAIL() << key;
    } catch (const InputError& error) {
      EXPECT_NE(error.found().find(key), std::string::npos) << error.found();
    }
  }
}

TEST(EdgeWeights, AreTheSameBothWaysAndEvenlyDrawnBetweenTheirBounds) {
  const Vec3 p{0, 0, 0}, q{0, 3, 0};
  const EdgeWeights weights{.low = 1, .high = 3};
  double sum = 0, least = 9, most = 0;
  for (std::uint32_t v = 1; v <= 4000; ++v) {
    const double weight = weights.of(1, v, 7 * v, p, q);
    EXPECT_EQ(weight, weights.of(1, 7 * v, v, q, p));
    sum += weight, least = std::min(least, weight), most = std::max(most, weight);
  }
  EXPECT_NEAR(sum / 4000, 2, 0.05);
  EXPECT_NEAR(least, 1, 0.01);
  EXPECT_NEAR(most, 3, 0.01);
  EXPECT_NE(weights.of(1, 2, 3, p, q), weights.of(2, 2, 3, p, q));
}

TEST(EdgeWeights, AreScaledByLengthAndPaint) {
  const Vec3 p{0, 0, 0}, q{0, 3, 0};
  const WeightPaint paint({{.center = {0, 1.5, 0}, .radius = 1, .factor = 4}}, nullptr);
  const EdgeWeights plain, longer{.times_length = true}, painted{.paint = &paint};
  EXPECT_FLOAT_EQ(longer.of(1, 2, 3, p, q), 3 * plain.of(1, 2, 3, p, q));
  EXPECT_FLOAT_EQ(painted.of(1, 2, 3, p, q), 4 * plain.of(1, 2, 3, p, q));
}

}  // namespace
}  // namespace cambium
