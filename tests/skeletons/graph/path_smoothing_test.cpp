#include "skeletons/graph/path_smoothing.h"

#include <gtest/gtest.h>

#include <cmath>

namespace cambium {
namespace {

/// A path that steps up and to and fro, and a spur of one node from its middle.
struct Zigzag {
  std::vector<Vec3> positions;
  std::vector<std::uint32_t> parents;
  std::vector<bool> fixed;

  Zigzag() {
    for (std::uint32_t i = 0; i < 21; ++i) positions.push_back({0.3 * (i % 2), 0, i}), parents.push_back(i == 0 ? 0 : i - 1);
    positions.push_back({1, 0, 10}), parents.push_back(10);
    fixed.resize(positions.size(), false);
  }
  double widest_step() const {
    double widest = 0;
    for (std::size_t i = 2; i < 20; ++i) widest = std::max(widest, std::abs(positions[i].x - positions[i - 1].x));
    return widest;
  }
};

TEST(PathSmoothing, TakesOutZigzagInAPassOrTwo) {
  Zigzag path;
  smooth_paths(path.positions, path.parents, path.fixed, nullptr, 3);
  EXPECT_LT(path.widest_step(), 0.05);
}

TEST(PathSmoothing, DoesNothingInNoPass) {
  Zigzag path;
  smooth_paths(path.positions, path.parents, path.fixed, nullptr, 0);
  EXPECT_EQ(path.widest_step(), 0.3);
}

TEST(PathSmoothing, LeavesRootEndsAndFixedNodesWhereTheyAre) {
  Zigzag path;
  path.fixed[7] = true;
  const auto before = path.positions;
  smooth_paths(path.positions, path.parents, path.fixed, nullptr, 50);
  for (const std::size_t node : {0, 7, 20, 21}) EXPECT_EQ(path.positions[node], before[node]) << node;
  EXPECT_NE(path.positions[8], before[8]);
}

TEST(PathSmoothing, DoesNotPushNodesIntoObstacles) {
  Zigzag path;
  const Obstacles obstacles({}, {HalfSpaceObstacle{{0.29, 0, 0}, {1, 0, 0}}});   // all x below 0.29
  const auto before = path.positions;
  smooth_paths(path.positions, path.parents, path.fixed, &obstacles, 5);
  for (std::size_t i = 1; i < 20; i += 2) EXPECT_EQ(path.positions[i], before[i]);
}

}  // namespace
}  // namespace cambium
