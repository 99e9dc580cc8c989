#include "skeletons/graph/subgraph.h"

#include <gtest/gtest.h>

#include <cmath>

namespace cambium {
namespace {

constexpr double kPi = std::numbers::pi;

double angle_between(const Vec3& a, const Vec3& b) { return std::acos(std::clamp(glm::dot(a, b), -1.0, 1.0)); }

TEST(Subgraph, PointsAwayFromTheRootOfTheGraphBefore) {
  const Vec3 v = subgraph_direction({}, {3, 4, 1}, {0, 0, 1}, {}, 1);
  EXPECT_NEAR(glm::length(v - Vec3(0.6, 0.8, 0)), 0, 1e-12);
}

TEST(Subgraph, IsTurnedDownwardsByTheAngleButNotBeyondTheVertical) {
  GraphLevel level;
  level.turn.angle = -0.12 * kPi;
  const Vec3 v = subgraph_direction(level, {1, 1, 0}, {0, 0, 0}, {}, 1);
  EXPECT_NEAR(v.z, -std::sin(0.12 * kPi), 1e-12);
  EXPECT_NEAR(v.x, v.y, 1e-12);
  level.turn.angle = -0.6 * kPi;
  EXPECT_NEAR(subgraph_direction(level, {1, 1, 0}, {0, 0, 0}, {}, 1).z, -1, 1e-12);
  level.turn.angle = 0.6 * kPi;
  EXPECT_NEAR(subgraph_direction(level, {1, 1, 0}, {0, 0, 0}, {}, 1).z, 1, 1e-12);
}

TEST(Subgraph, VerticalTurnedByPiHangsDown) {
  GraphLevel level;
  level.orientation = GraphOrientation::kVertical;
  EXPECT_EQ(subgraph_direction(level, {1, 1, 0}, {0, 0, 0}, {}, 1).z, 1);
  level.turn.angle = -kPi;
  EXPECT_NEAR(subgraph_direction(level, {1, 1, 0}, {0, 0, 0}, {}, 1).z, -1, 1e-12);
}

TEST(Subgraph, IsTurnedAboutAnyAxis) {
  GraphLevel level;
  level.turn = {kPi / 2, Vec3{0, 0, 5}};
  EXPECT_NEAR(glm::length(subgraph_direction(level, {1, 0, 0}, {0, 0, 0}, {}, 1) - Vec3(0, 1, 0)), 0, 1e-12);
}

TEST(Subgraph, RandomDirectionsAreEvenOverTheSphere) {
  GraphLevel level;
  level.orientation = GraphOrientation::kRandom;
  Vec3 mean{0.0};
  double squares = 0;
  constexpr int kDraws = 20'000;
  for (int i = 0; i < kDraws; ++i) {
    const Vec3 v = subgraph_direction(level, {1, 0, 0}, {0, 0, 0}, {}, static_cast<std::uint64_t>(i));
    ASSERT_NEAR(glm::length(v), 1, 1e-12);
    mean += v / double(kDraws);
    squares += v.z * v.z / kDraws;
  }
  EXPECT_LT(glm::length(mean), 0.02);
  EXPECT_NEAR(squares, 1 / 3.0, 0.01);
}

TEST(Subgraph, IsBlownTowardsWhereTheWindGoes) {
  const Vec3 v = subgraph_direction({}, {0, 0, 1}, {0, 0, 0}, GraphWind{{7, 0, 0}, 1}, 1);
  EXPECT_NEAR(glm::length(v - glm::normalize(Vec3(1, 0, 1))), 0, 1e-12);
}

TEST(Subgraph, FillsTheConeOfItsBallAndNothingElse) {
  GraphLevel level;
  level.alpha = 0.3 * kPi;
  const Vec3 root{1, 2, 3}, direction = glm::normalize(Vec3{1, -1, 0.5});
  const GraphVolume volume = subgraph_volume(level, root, direction, 2, nullptr);
  for (int i = 0; i < 4096; ++i) {
    const Vec3 p = root + Vec3{i % 16 / 3.0 - 2.5, i / 16 % 16 / 3.0 - 2.5, i / 256 / 3.0 - 2.5};
    const double far = glm::length(p - root), angle = angle_between(glm::normalize(p - root), direction);
    EXPECT_EQ(volume.contains(p), far <= 2 && angle <= level.alpha) << i;
  }
}

TEST(Subgraph, OfAShapeStandsOnItsRootAlongItsDirection) {
  GraphLevel level;
  level.shape = {PlacedSolid{.solid = EllipsoidSolid{{0.2, 0.2, 0.5}}, .origin = {0, 0, 0.5}}};
  const Vec3 root{1, 2, 3}, direction{0, -1, 0};
  const GraphVolume volume = subgraph_volume(level, root, direction, 4, nullptr);
  EXPECT_TRUE(volume.contains(root + 3.99 * direction));
  EXPECT_FALSE(volume.contains(root + 4.01 * direction));
  EXPECT_TRUE(volume.contains(root + 2.0 * direction + Vec3(0, 0, 0.79)));
  EXPECT_FALSE(volume.contains(root + 2.0 * direction + Vec3(0, 0, 0.81)));
  EXPECT_FALSE(volume.contains(root - 0.01 * direction));
}

}  // namespace
}  // namespace cambium
