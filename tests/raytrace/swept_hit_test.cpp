// Rays against segments of a sphere-swept polyline: the swept ratio is quasi-convex along a ray, so its least value, found by
// ternary search, says for certain whether a ray hits.
#include "raytrace/swept_hit.h"

#include "tests/blobtree/random_blobtrees.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>

namespace cambium {
namespace {

double ratio_at(const SweptSegment<double>& k, const Ray& ray, double t) { return swept_ratio(k, ray.at(t)); }

/// Where on the part the ratio is least.
double nearest_on(const SweptSegment<double>& k, const Ray& ray, double begin, double end) {
  for (int i = 0; i < 300; ++i) {
    const double a = begin + (end - begin) / 3, b = end - (end - begin) / 3;
    (ratio_at(k, ray, a) < ratio_at(k, ray, b) ? end : begin) = ratio_at(k, ray, a) < ratio_at(k, ray, b) ? b : a;
  }
  return 0.5 * (begin + end);
}

SweptSegment<double> random_segment(Draws& draws) {
  const double radius = std::pow(10.0, draws.in(-3, 0)), length = radius * std::pow(10.0, draws.in(-1.5, 1.5));
  const Vec3 from = draws.point({Vec3(-1), Vec3(1)});
  const double tip = draws.chance(0.3) ? radius : radius * std::pow(10.0, draws.in(-1, 0.3));
  return swept_segment(from, radius, from + (draws.chance(0.1) ? 0 : length) * draws.direction(), tip);
}

/// Through the segment or close by it; half of them touch its surface nearly.
Ray ray_at(const SweptSegment<double>& k, Draws& draws, double far) {
  const double s = draws.in(-0.2, 1.2) * k.end;
  const double r = k.radius_at(std::clamp(s, k.begin, k.end));
  const Vec3 direction = draws.direction();
  const Vec3 across = glm::normalize(glm::cross(direction, draws.direction()));
  const double off = draws.chance(0.5) ? draws.in(0, 1.3) : 1 + std::copysign(std::pow(10.0, draws.in(-9, -1)), draws.in(-1, 1));
  return {k.a + s * k.axis + off * r * across - far * direction, direction};
}

TEST(FirstInside, FindsAllAndNothingElseHoweverItGrazes) {
  Draws draws(17);
  int hits = 0, misses = 0;
  for (int i = 0; i < 20000; ++i) {
    const SweptSegment<double> k = random_segment(draws);
    const double thickest = std::max(k.radius_at(k.begin), k.radius_at(k.end)), size = k.end + 2 * thickest;
    const double far = 3 * size;
    const Ray ray = ray_at(k, draws, far);
    const RaySegment part{0, 2 * far};
    const auto t = first_inside(k, ray, part);
    const double nearest = nearest_on(k, ray, part.begin, part.end), least = ratio_at(k, ray, nearest);
    if (!t) {
      ++misses;
      EXPECT_GT(least, 1 - 1e-9) << i;
      continue;
    }
    ++hits;
    ASSERT_LT(least, 1 + 1e-9) << i;
    EXPECT_NEAR(ratio_at(k, ray, *t), 1, 1e-9) << i;
    EXPECT_LE(*t, nearest + 1e-4 * thickest) << "leaves it there: " << i;
  }
  EXPECT_GT(hits, 8000);
  EXPECT_GT(misses, 3000);
}

TEST(FirstInside, OfATwigTenMetresAwayIsExactToAMillionthOfItsRadius) {
  Draws draws(3);
  for (int i = 0; i < 5000; ++i) {
    const Vec3 from = draws.point({Vec3(-5), Vec3(5)});
    const SweptSegment<double> twig = swept_segment(from, 0.001, from + 0.05 * draws.direction(), 0.0008);
    const Ray far = ray_at(twig, draws, 10);
    const auto t = first_inside(twig, far, {9.8, 10.2});
    const Ray near{far.at(9.9), far.direction};
    const auto t_near = first_inside(twig, near, {-0.1, 0.3});
    const double least = ratio_at(twig, far, nearest_on(twig, far, 9.8, 10.2));
    if (std::abs(least - 1) < 1e-9) continue;   // grazes by less than its roundings
    ASSERT_EQ(t.has_value(), least < 1) << i << " " << least;
    ASSERT_EQ(t_near.has_value(), least < 1);
    if (t) {
      EXPECT_NEAR(ratio_at(twig, far, *t), 1, 1e-6);
      if (least < 1 - 1e-6) {
        EXPECT_NEAR(*t, *t_near + 9.9, 1e-9);
      }
    }
  }
}

TEST(FirstInside, ARayThatStartsInsideIsThereAtOnceAndOneThatLeavesIsNot) {
  const SweptSegment<double> k = swept_segment({0, 0, 0}, 0.1, {0, 0, 1}, 0.08);
  EXPECT_EQ(first_inside(k, {{0, 0, 0.5}, {1, 0, 0}}, {0, 9}), 0);
  EXPECT_EQ(first_inside(k, {{-1, 0, 0.5}, {1, 0, 0}}, {1.05, 9}), 1.05);
  EXPECT_FALSE(first_inside(k, {{0.2, 0, 0.5}, {1, 0, 0}}, {0, 9}));
  EXPECT_FALSE(first_inside(k, {{-1, 0, 0.5}, {1, 0, 0}}, {0, 0.5}));
  Draws draws(4);
  for (int i = 0; i < 2000; ++i) {
    const double h = draws.in(0.1, 0.9), angle = draws.in(0, 6.28), r = (0.1 - 0.02 * h) / std::sqrt(1 - 0.02 * 0.02);
    const Vec3 p{r * std::cos(angle), r * std::sin(angle), h}, normal = swept_normal(k, p);
    const Vec3 direction = glm::normalize(draws.direction() + 1.0001 * normal);
    EXPECT_FALSE(first_inside(k, {p + 4e-7 * normal, direction}, {0, 9})) << i;
  }
}

TEST(FirstInside, OfABallThatHoldsTheOtherIsTheBalls) {
  const SweptSegment<double> k = swept_segment({0, 0, 0}, 1, {0, 0, 0.5}, 0.3);
  const auto t = first_inside(k, {{0, 0, 5}, {0, 0, -1}}, {0, 9});
  ASSERT_TRUE(t);
  EXPECT_DOUBLE_EQ(*t, 4);
}

TEST(SweptNormal, IsTheGradientOfTheSweptRatio) {
  Draws draws(8);
  for (int i = 0; i < 500; ++i) {
    const SweptSegment<double> k = random_segment(draws);
    const Vec3 p = ray_at(k, draws, 0).origin;
    const double step = 1e-6 * k.radius;
    const Vec3 normal = swept_normal(k, p);
    const double rise = (swept_ratio(k, p + step * normal) - swept_ratio(k, p - step * normal)) / (2 * step);
    EXPECT_NEAR(rise * k.radius_at(closest_parameter(k, p - k.a)), 1, 1e-3) << i;
  }
}

TEST(SolidBounds, HoldEveryHitInTheBox) {
  Draws draws(21);
  int held = 0;
  for (int i = 0; i < 5000; ++i) {
    const SweptSegment<double> k = random_segment(draws);
    const Vec3 center = k.a + draws.in(0, 1) * k.end * k.axis + k.radius * draws.direction();
    const Box box{center - k.radius * draws.in(0.1, 2), center + k.radius * draws.in(0.1, 2)};
    const Box bounds = solid_bounds(k, box);
    const Ray ray = ray_at(k, draws, 2);
    const auto t = first_inside(k, ray, {0, 9});
    if (!t || !box.contains(ray.at(*t))) continue;
    ++held;
    EXPECT_TRUE(bounds.padded(1e-12).contains(ray.at(*t))) << i;
  }
  EXPECT_GT(held, 300);
}

TEST(FirstInside, IsAtOnceForARayThatStartsOnTheSurfaceAndGoesIn) {
  Draws draws(23);
  int inward = 0;
  for (int i = 0; i < 20000; ++i) {
    const SweptSegment<double> k = random_segment(draws);
    const double far = 3 * (k.end + 2 * thickest(k));
    const Ray other = ray_at(k, draws, far);
    const auto t = first_inside(k, other, {0, 2 * far});
    if (!t) continue;
    const Vec3 p = other.at(*t);
    const Ray ray{p, draws.direction()};
    if (glm::dot(ray.direction, swept_normal(k, p)) > -1e-3) continue;
    const auto again = first_inside(k, ray, {0, far});
    ++inward;
    ASSERT_TRUE(again) << i;
    EXPECT_LT(*again, 1e-9 * thickest(k)) << i;
  }
  EXPECT_GT(inward, 1000);
}

}  // namespace
}  // namespace cambium
