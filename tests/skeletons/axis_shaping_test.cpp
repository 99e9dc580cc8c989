#include "skeletons/axis_shaping.h"

#include "small_trees.h"

#include <gtest/gtest.h>

namespace cambium {
namespace {

double largest_turn(const Path& path) {
  double largest = 0;
  for (std::size_t i = 1; i + 1 < path.size(); ++i) {
    const Vec3 in = glm::normalize(path[i].position - path[i - 1].position);
    const Vec3 out = glm::normalize(path[i + 1].position - path[i].position);
    largest = std::max(largest, std::atan2(glm::length(glm::cross(in, out)), glm::dot(in, out)));
  }
  return largest;
}

Path zigzag_path(int nodes, double step, double zig, double radius) {
  Path path;
  for (int i = 0; i < nodes; ++i) path.push_back({{i % 2 ? zig : -zig, 0, i * step}, radius, static_cast<double>(i)});
  return path;
}

TEST(AxisShaping, DiffusionFlattensFeaturesSmallerThanTheRadius) {
  Path path = zigzag_path(200, 0.25, 0.1, 1);
  const Vec3 first = path.front().position, last = path.back().position;
  EXPECT_GT(diffuse(path, 2.5), 0.05);
  EXPECT_EQ(path.front().position, first);
  EXPECT_EQ(path.back().position, last);
  for (std::size_t i = 20; i < 180; ++i) EXPECT_LT(std::abs(path[i].position.x), 0.005);
}

TEST(AxisShaping, DiffusionLeavesStraightPathsAndLongInternodesAlone) {
  Path straight;
  for (int i = 0; i < 30; ++i) straight.push_back({Vec3(0.1, 0.2, 0.7) * static_cast<double>(i * i), 0.5, double(i)});
  EXPECT_LT(diffuse(straight, 2.5), 1e-11);
  Path lsystem = zigzag_path(20, 1, 0.2, 0.02);  // turns of 44 degrees, internodes of 50 radii
  EXPECT_LT(diffuse(lsystem, 2.5), 0.02 * 0.02);
}

TEST(AxisShaping, RoundedCornersTurnByFiveDegreesAtMost) {
  for (const double zig : {0.05, 0.5, 3.0}) {
    Path path = zigzag_path(40, 1, zig, 0.3);
    round_corners(path, 1.25, degrees(5));
    EXPECT_LE(largest_turn(path), degrees(5) * (1 + 1e-6)) << zig;
    EXPECT_EQ(path.front().at, 0);
    EXPECT_EQ(path.back().at, 39);
    for (std::size_t i = 1; i < path.size(); ++i) EXPECT_GT(path[i].at, path[i - 1].at);
  }
}

TEST(AxisShaping, PlacesFollowTheReshapedPath) {
  Path path = zigzag_path(5, 1, 0.4, 0.1);
  const Path before = path;
  round_corners(path, 1.25, degrees(5));
  for (int i = 0; i < 5; ++i) {
    const AxisPlace place = place_of(path, i);
    const Vec3 p = glm::mix(path[place.segment].position, path[place.segment + 1].position, place.t);
    EXPECT_LT(glm::distance(p, before[static_cast<std::size_t>(i)].position), 0.05);
  }
}

TEST(AxisShaping, MergingKeepsEndsAndSpacing) {
  Path path = zigzag_path(500, 0.01, 0, 0.1);
  EXPECT_GT(merge_short(path, 2.5), 470u);
  EXPECT_EQ(path.front().at, 0);
  EXPECT_EQ(path.back().at, 499);
  for (std::size_t i = 1; i < path.size(); ++i)
    EXPECT_GE(glm::distance(path[i - 1].position, path[i].position), 0.25);
}

TEST(AxisShaping, ABentInternodeKeepsItsEndsAndIsTheArcOfTheBendWarp) {
  Path path{{{0, 0, 0}, 0.1, 0}, {{1, 0, 1}, 0.1, 1}};
  const double theta = degrees(40);
  bend_internodes(path, {0, 0, 1}, theta, degrees(5));
  EXPECT_EQ(path.front().position, Vec3(0, 0, 0));
  EXPECT_EQ(path.back().position, Vec3(1, 0, 1));
  const double length = std::sqrt(2.0), rho = length / (2 * std::sin(theta / 2));
  const Vec3 outward = glm::normalize(Vec3(1, 0, -1));  // away from an upright parent
  const Vec3 center = Vec3(0.5, 0, 0.5) - rho * std::cos(theta / 2) * outward;
  double farthest = 0;
  for (const PathNode& node : path) {
    EXPECT_NEAR(glm::distance(node.position, center), rho, 1e-12);
    farthest = std::max(farthest, glm::dot(node.position, outward));
  }
  EXPECT_NEAR(farthest, rho * (1 - std::cos(theta / 2)), 1e-9);  // to the outer side by the whole sagitta
  EXPECT_LE(largest_turn(path), degrees(5) * (1 + 1e-6));
}

TEST(AxisShaping, InternodesInLineStayStraight) {
  Path path{{{0, 0, 0}, 0.1, 0}, {{0, 0, 1}, 0.1, 1}, {{0, 0, 3}, 0.1, 2}};
  bend_internodes(path, {0, 0, 1}, degrees(40), degrees(5));
  EXPECT_EQ(path.size(), 3u);
}

}  // namespace
}  // namespace cambium
