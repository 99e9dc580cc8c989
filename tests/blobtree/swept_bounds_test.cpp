// Bounds in vectors against those of one ball, and against samples.
#include "blobtree/swept_bounds.h"

#include "random_blobtrees.h"

#include <gtest/gtest.h>

#include <cmath>

namespace cambium {
namespace {

SweptSegment<double> random_segment(Draws& draws) {
  const double length = draws.chance(0.1) ? 0 : draws.in(0.01, 1);
  const double r1 = draws.in(0.01, 0.3), r2 = draws.chance(0.3) ? r1 : draws.in(0.01, 0.3);
  const double slope = length > 0 ? (r2 - r1) / length : 0;
  return {draws.point({Vec3(-1), Vec3(1)}), draws.direction(), 0, length, r1, slope};
}

BallCenters centers_of(const std::array<Vec3, kBalls>& points) {
  BallCenters centers;
  for (std::size_t k = 0; k < kBalls; ++k)
    for (int a = 0; a < 3; ++a) centers[a][k] = points[k][a];
  return centers;
}

TEST(SweptBounds, AreThoseOfOneBallAfterAnother) {
  Draws draws(11);
  for (int i = 0; i < 2000; ++i) {
    std::vector<SweptSegment<double>> segments;
    for (int k = 0, n = 1 + draws.below(4); k < n; ++k) segments.push_back(random_segment(draws));
    std::array<Vec3, kBalls> points;
    for (Vec3& p : points) p = draws.point({Vec3(-1.5), Vec3(1.5)});
    const double radius = draws.chance(0.2) ? 0 : std::pow(10, draws.in(-4, 0));
    std::vector<BallBounds> bounds(segments.size());
    bound_swept_ratios(segments.data(), segments.size(), centers_of(points), radius, bounds.data());
    for (std::size_t s = 0; s < segments.size(); ++s)
      for (std::size_t k = 0; k < kBalls; ++k) {
        const Interval one = swept_ratio_interval(segments[s], {points[k], radius});
        ASSERT_NEAR(bounds[s].lo[k], one.lo, 1e-9 * (1 + one.hi));
        ASSERT_NEAR(bounds[s].hi[k], one.hi, 1e-9 * (1 + one.hi));
      }
  }
}

TEST(SweptBounds, HoldEverySampleInTheBall) {
  Draws draws(12);
  for (int i = 0; i < 2000; ++i) {
    const SweptSegment<double> segment = random_segment(draws);
    const Vec3 center = draws.point({Vec3(-1.5), Vec3(1.5)});
    const double radius = std::pow(10, draws.in(-3, 0));
    std::array<Vec3, kBalls> points;
    points.fill(center);
    BallBounds bounds;
    bound_swept_ratios(&segment, 1, centers_of(points), radius, &bounds);
    for (int k = 0; k < 50; ++k) {
      const Vec3 p = center + radius * std::cbrt(draws.in(0, 1)) * draws.direction();
      const double x = swept_ratio(segment, p);
      ASSERT_GE(x, bounds.lo[3] * (1 - 1e-12) - 1e-12);
      ASSERT_LE(x, bounds.hi[3] * (1 + 1e-12) + 1e-12);
    }
  }
}

}  // namespace
}  // namespace cambium
