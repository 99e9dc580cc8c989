#include "lsystem/turtle.h"

#include <gtest/gtest.h>

#include <numbers>

namespace cambium {
namespace {

constexpr double kRight = std::numbers::pi / 2;

void expect_near(const Vec3& a, const Vec3& b) { EXPECT_LT(glm::length(a - b), 1e-12) << a.x << ' ' << a.y << ' ' << a.z; }

TEST(Turtle, QuarterTurnsGoWhereTheSpecificationSays) {
  TurtleFrame yawed, pitched, rolled;
  yawed.yaw(kRight);
  expect_near(yawed.heading, {-1, 0, 0});
  expect_near(yawed.left, {0, 0, -1});
  pitched.pitch(kRight);
  expect_near(pitched.heading, {0, 1, 0});
  expect_near(pitched.up, {0, 0, -1});
  rolled.roll(kRight);
  expect_near(rolled.left, {0, 1, 0});
  expect_near(rolled.up, {1, 0, 0});
}

TEST(Turtle, TurningBackKeepsU) {
  TurtleFrame frame;
  frame.turn_back();
  expect_near(frame.heading, {0, 0, -1});
  expect_near(frame.up, {0, 1, 0});
}

TEST(Turtle, LevellingMakesLHorizontalAndKeepsTheFramesHand) {
  TurtleFrame frame;
  frame.level();
  expect_near(frame.left, {-1, 0, 0});  // H vertical: nothing to do
  frame.pitch(0.7);
  TurtleFrame pitched = frame;
  frame.level();
  expect_near(frame.left, pitched.left);  // it was level
  frame.roll(1.1);
  frame.yaw(0.4);
  const Vec3 heading = frame.heading;
  frame.level();
  EXPECT_NEAR(frame.left.z, 0, 1e-12);
  expect_near(frame.heading, heading);
  expect_near(glm::cross(frame.left, frame.heading), frame.up);
}

TEST(Turtle, TropismTurnsTowardsItsVectorByItsTorque) {
  TurtleFrame frame;
  frame.yaw(kRight);
  frame.bend({0, 0, -1}, 0.2);  // |H x T| = 1
  EXPECT_NEAR(glm::dot(frame.heading, Vec3(0, 0, -1)), std::sin(0.2), 1e-12);
  expect_near(glm::cross(frame.left, frame.heading), frame.up);
  TurtleFrame upright;
  upright.bend({0, 0, 1}, 5);
  expect_near(upright.heading, {0, 0, 1});
}

TEST(Turtle, OrientingMakesAnOrthonormalFrame) {
  TurtleFrame frame;
  const Vec3 up(0, 3, 0);
  EXPECT_TRUE(frame.orient({0, 1, 5}, &up));
  expect_near(frame.heading, glm::normalize(Vec3(0, 1, 5)));
  EXPECT_GT(frame.up.y, 0.9);
  expect_near(glm::cross(frame.left, frame.heading), frame.up);
  EXPECT_TRUE(frame.orient({0, 0, 1}, &up));
  expect_near(frame.left, {-1, 0, 0});
  EXPECT_FALSE(frame.orient({0, 2, 0}, &up));
  EXPECT_FALSE(frame.orient({0, 0, 0}, nullptr));
  EXPECT_TRUE(frame.orient({0, 1, 0}, nullptr));
}

}  // namespace
}  // namespace cambium
