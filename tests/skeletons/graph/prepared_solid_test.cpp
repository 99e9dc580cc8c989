#include "skeletons/graph/prepared_solid.h"

#include "skeletons/graph/closed_mesh.h"
#include "tests/blobtree/random_blobtrees.h"
#include "tests/skeletons/graph/closed_shapes.h"

#include <gtest/gtest.h>

namespace cambium {
namespace {

constexpr double kPi = std::numbers::pi;

std::vector<Solid> one_of_each() {
  const testing::Shape crown = testing::ball_shape(9, 12, 1, Vec3(0), 3);
  std::vector<Solid> solids = {EllipsoidSolid{{1, 0.5, 0.7}}, CylinderSolid{0.6, 1}, ConeSolid{1, 0, 1}, ConeSolid{0, 0.8, 1},
                               ConeSolid{0.3, 0.9, 0.8}, RevolutionSolid{{{0, -0.5}, {1, 0}, {0.3, 0.5}, {0.4, 1}}},
                               MeshSolid{std::make_shared<const ClosedMesh>(crown.positions, crown.triangles)}};
  for (const double angle : {1.0, 0.9, 0.75, 0.5, 0.4, 0.2, 0.01}) solids.push_back(BallSolid{1, angle * kPi});
  return solids;
}

TEST(PreparedSolid, StraightWaysMeetItWhereTheirPointsAreInIt) {
  Draws draws(1);
  for (const Solid& solid : one_of_each()) {
    SCOPED_TRACE(solid.index());
    const PreparedSolid prepared(solid);
    const Box around = bounds(solid).padded(0.3);
    const double small = 0.01;
    for (int i = 0; i < 4000; ++i) {
      const Vec3 a = draws.point(around), b = i % 2 ? draws.point(around) : a + draws.in(0, 0.2) * draws.direction();
      bool inside = false, near = false;
      for (int s = 0; s <= 100; ++s) {
        const Vec3 p = glm::mix(a, b, s / 100.0);
        inside = inside || prepared.contains(p);
        for (int axis = 0; axis < 6 && !near; ++axis) {
          Vec3 step(0);
          step[axis / 2] = axis % 2 ? small : -small;
          near = prepared.contains(p + step);
        }
      }
      const bool meets = prepared.meets(a, b);
      EXPECT_TRUE(meets || !inside);
      // A solid as thin as the thinnest cone here may lie between samples.
      const auto* ball = std::get_if<BallSolid>(&solid);
      EXPECT_TRUE(!meets || inside || near || (ball && ball->angle < 0.1));
    }
  }
}

TEST(PreparedSolid, AWayOfNoLengthMeetsWhatItsPointIsIn) {
  Draws draws(2);
  for (const Solid& solid : one_of_each()) {
    const PreparedSolid prepared(solid);
    for (int i = 0; i < 500; ++i) {
      const Vec3 p = draws.point(bounds(solid));
      EXPECT_EQ(prepared.meets(p, p), prepared.contains(p)) << solid.index();
    }
  }
}

TEST(PreparedSolid, TheMiddleIsFarthestFromTheSurface) {
  Draws draws(3);
  for (const Solid& solid : one_of_each()) {
    const PreparedSolid prepared(solid);
    for (int i = 0; i < 500; ++i) {
      const Vec3 p = draws.point(bounds(solid));
      if (!prepared.contains(p)) continue;
      EXPECT_GE(prepared.middleness(p), -1e-12) << solid.index();
      EXPECT_LE(prepared.middleness(p), 1) << solid.index();
    }
  }
  EXPECT_EQ(PreparedSolid(ConeSolid{1, 0, 1}).middleness({0, 0, 0.9}), 1);
  EXPECT_EQ(PreparedSolid(ConeSolid{1, 0, 1}).middleness({0, 0, 1}), 1);
  EXPECT_NEAR(PreparedSolid(ConeSolid{1, 0, 1}).middleness({0.05, 0, 0.9}), 0.5, 1e-12);
  EXPECT_NEAR(PreparedSolid(CylinderSolid{2, 9}).middleness({0, 0.5, 8.9}), 0.75, 1e-12);
  EXPECT_NEAR(PreparedSolid(EllipsoidSolid{{1, 2, 4}}).middleness({0, 0, 1}), 0.75, 1e-12);
}

TEST(PreparedSolid, WaysThroughATipAndAlongASideMeetIt) {
  const PreparedSolid cone(ConeSolid{1, 0, 1}), part(BallSolid{1, kPi / 4}), wide(BallSolid{1, 3 * kPi / 4}), cylinder(CylinderSolid{1, 2});
  EXPECT_TRUE(cone.meets({-1, 0, 1}, {1, 0, 1}));
  EXPECT_FALSE(cone.meets({-1, 0, 1.001}, {1, 0, 1.001}));
  EXPECT_TRUE(part.meets({-1, 0, 0}, {1, 0, 0}));
  EXPECT_FALSE(part.meets({-1, 0, -0.001}, {1, 0, -0.001}));
  EXPECT_FALSE(part.meets({0, 0, -2}, {0, 0, -0.001}));
  EXPECT_FALSE(wide.meets({0, 0, -2}, {0, 0, -0.001}));
  EXPECT_TRUE(wide.meets({0, 0, -2}, {0, 0, 0.001}));
  EXPECT_TRUE(wide.meets({-0.9, 0, -0.5}, {0.9, 0, -0.5}));
  EXPECT_TRUE(cylinder.meets({1, -5, 1}, {1, 5, 1}));
  EXPECT_TRUE(cylinder.meets({-5, 0, 2}, {5, 0, 2}));
  EXPECT_FALSE(cylinder.meets({-5, 0, 2.001}, {5, 0, 2.001}));
  EXPECT_TRUE(cylinder.meets({0, 0, -5}, {0, 0, 9}));
}

}  // namespace
}  // namespace cambium
