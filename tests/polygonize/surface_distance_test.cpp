#include "polygonize/surface_distance.h"

#include "tests/blobtree/random_blobtrees.h"
#include "tests/polygonize/sample_fields.h"

#include <gtest/gtest.h>

namespace cambium {
namespace {

std::optional<SurfaceDistance::Foot> nearest(const Field& field, const Vec3& p, double reach = 0.5) {
  SurfaceDistance distance(field);
  return distance.nearest(field.prune(Box{p, p}.padded(reach)), p);
}

TEST(SurfaceDistance, OfASphereInsideAndOutside) {
  const Vec3 center(0.03, -0.02, 0.01);
  const Field field = testing::sphere_field(1);
  Draws draws(1);
  for (int i = 0; i < 300; ++i) {
    const double r = i % 2 ? draws.in(0.2, 1.8) : 1 + std::pow(10.0, draws.in(-7, -1)) * (i % 4 ? 1 : -1);
    const auto foot = nearest(field, center + r * draws.direction());
    ASSERT_TRUE(foot.has_value()) << r;
    EXPECT_NEAR(foot->distance, std::abs(r - 1), 1e-3 * std::abs(r - 1) + 1e-9);
    EXPECT_NEAR(field.value(foot->point), kIso, 1e-3 * std::abs(r - 1) + 1e-8);
  }
}

// A field whose gradient does not point to the nearest point.
TEST(SurfaceDistance, OfATaperedChainComparedWithADenseSearch) {
  const Field field = testing::chain_field();
  Draws draws(2);
  int compared = 0;
  for (int i = 0; i < 60; ++i) {
    const Vec3 p = draws.point({Vec3(-0.25, -0.2, -0.2), Vec3(0.35, 0.35, 3.1)});
    const auto foot = nearest(field, p);
    if (!foot || foot->distance > 0.1) continue;
    // No surface in a ball a little smaller: all of its shell is on the side of p.
    const bool inside = field.value(p) >= kIso;
    for (int k = 0; k < 2000; ++k) {
      ASSERT_EQ(field.value(p + 0.995 * foot->distance * draws.direction()) >= kIso, inside) << i;
    }
    ++compared;
  }
  EXPECT_GT(compared, 20);
}

TEST(SurfaceDistance, OnCreasesItIsTheDistanceToTheEdge) {
  // Two spheres under a union meet in a crease: a circle in the plane x = 0.
  const auto of_both = [](const auto& combine) {
    BlobTreeBuilder builder;
    const NodeId a = builder.add(Sphere{Vec3(-0.6, 0, 0), 1, 1}), b = builder.add(Sphere{Vec3(0.6, 0, 0), 1, 1});
    return Field(builder.build(builder.add(combine({a, b}))));
  };
  using Children = std::vector<NodeId>;
  const Field valley = of_both([](Children c) { return Union{c}; }), ridge = of_both([](Children c) { return Intersection{c}; });
  Draws draws(3);
  for (int i = 0; i < 200; ++i) {
    const double turn = draws.in(0, 6.28);
    const Vec3 out(0, std::cos(turn), std::sin(turn));
    // Outside of the ridge the edge itself, at 0.8, is nearest; below the valley likewise.
    const double d = std::pow(10.0, draws.in(-5, -1.5));
    for (const bool above : {true, false}) {
      const Vec3 p = (above ? 0.8 + d : 0.8 - d) * out + Vec3(draws.in(-0.2, 0.2) * d, 0, 0);
      const auto foot = nearest(above ? ridge : valley, p);
      ASSERT_TRUE(foot.has_value());
      const double to_edge = glm::length(p - 0.8 * out);
      EXPECT_GT(foot->distance, to_edge * 0.999);
      EXPECT_LT(foot->distance, to_edge * 1.03);
    }
    // Above the valley the two sheets are nearer than the edge.
    const Vec3 p = (0.8 + d) * out;
    const auto over = nearest(valley, p);
    ASSERT_TRUE(over.has_value());
    EXPECT_NEAR(over->distance, glm::length(p - Vec3(0.6, 0, 0)) - 1, 2e-3 * d);
  }
}

TEST(SurfaceDistance, NoneWhereTheGradientVanishes) {
  const Field field = testing::sphere_field(1);
  EXPECT_FALSE(nearest(field, Vec3(20, 0, 0)).has_value());
  EXPECT_FALSE(nearest(field, Vec3(0.03, -0.02, 0.01)).has_value());
}

// A hair that leaves a ball's wide slope: beside it the gradient is the ball's alone, and leads to the ball.
TEST(SurfaceDistance, AHairBesideTheWayOfTheGradientIsFoundAroundThePoint) {
  constexpr double kHair = 1e-3;
  BlobTreeBuilder builder;
  const NodeId ball = builder.add(Sphere{Vec3(0), 1, 1}), hair = builder.add(Capsule{Vec3(0), Vec3(0, 0, 1.4), kHair, 1});
  const Field field(builder.build(builder.add(Sum{{ball, hair}})));
  const Vec3 beside(3 * kHair, 0, 1.2);
  const auto along_gradient = nearest(field, beside, 0.05);
  ASSERT_TRUE(along_gradient.has_value());
  ASSERT_GT(along_gradient->distance, 0.1) << "the case this is for";
  SurfaceDistance distance(field);
  const auto foot = distance.around(field.prune(Box{beside, beside}.padded(0.05)), beside, 0.2);
  ASSERT_TRUE(foot.has_value());
  EXPECT_GT(foot->distance, kHair);
  EXPECT_LT(foot->distance, 3 * kHair);
  EXPECT_NEAR(field.value(foot->point), kIso, 1e-2);
  EXPECT_NEAR(glm::length(beside - foot->point), foot->distance, 1e-12);
}

TEST(SurfaceDistance, NothingIsFoundAroundAPointFartherFromTheSurfaceThanTheReach) {
  const Field field = testing::sphere_field(1);
  SurfaceDistance distance(field);
  const Vec3 p(1.33, -0.02, 0.01);
  EXPECT_FALSE(distance.around(field.whole(), p, 0.29).has_value());
  const auto foot = distance.around(field.whole(), p, 0.6);
  ASSERT_TRUE(foot.has_value());
  EXPECT_NEAR(foot->distance, 0.3, 1e-3);
}

TEST(SurfaceDistance, SlidingNeverLeadsAway) {
  const Field field = testing::fork_field();
  SurfaceDistance distance(field);
  const PrunedField whole = field.whole();
  Draws draws(4);
  for (int i = 0; i < 100; ++i) {
    const Vec3 p = draws.point(field.bounds());
    const auto start = nearest(field, draws.point(field.bounds()));
    if (!start) continue;
    const auto foot = distance.slide(whole, p, start->point);
    EXPECT_LE(foot.distance, glm::length(p - start->point));
    EXPECT_NEAR(glm::length(p - foot.point), foot.distance, 1e-12);
    EXPECT_NEAR(field.value(foot.point), kIso, 2e-3);
  }
}

}  // namespace
}  // namespace cambium
