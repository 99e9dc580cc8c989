// Where rings are put around a chain, and that walls between them stay near its surface.
#include "polygonize/tube_rings.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>

namespace cambium {
namespace {

std::vector<ChainNode> arc(double bend_radius, double radius, int nodes) {
  std::vector<ChainNode> made;
  for (int i = 0; i < nodes; ++i) {
    const double angle = 1.5 * i / (nodes - 1);
    made.push_back({{bend_radius * (1 - std::cos(angle)), 0, bend_radius * std::sin(angle)}, radius});
  }
  return made;
}

double farthest_of_walls(const ChainPath& path, const std::vector<TubeRing>& rings) {
  double farthest = 0;
  for (std::size_t i = 0; i + 1 < rings.size(); ++i) {
    const std::uint32_t n = rings[i].sides, m = rings[i + 1].sides;
    for (std::uint32_t k = 0; k < n; ++k) {
      const Vec3 a = ring_corner(path, rings[i], k).position, b = ring_corner(path, rings[i], (k + 1) % n).position;
      const Vec3 c = ring_corner(path, rings[i + 1], k * m / n).position;
      farthest = std::max(farthest, path.distance_of(a, b, c, (rings[i].at + rings[i + 1].at) / 2));
    }
  }
  return farthest;
}

TEST(TubeRings, AStraightTwigHasFewAndTheyReachItsEnds) {
  const std::vector<ChainNode> nodes{{{0, 0, 0}, 0.002}, {{0, 0, 0.01}, 0.002}, {{0, 0, 0.02}, 0.002}, {{0, 0, 0.1}, 0.002}};
  const ChainPath path(nodes);
  const auto parts = plan_rings(path, {0.003, 0.095}, {0.0005, 6});
  ASSERT_EQ(parts.size(), 1u);
  const std::vector<TubeRing>& rings = parts[0];
  EXPECT_EQ(rings.front().at, 0.003);
  EXPECT_EQ(rings.back().at, 0.095);
  EXPECT_LE(rings.size(), 6u);
  for (std::size_t i = 0; i + 1 < rings.size(); ++i) EXPECT_LE(rings[i + 1].at - rings[i].at, kRingRadii * 0.002 + 1e-9);
  for (const TubeRing& ring : rings) EXPECT_EQ(ring.sides, 6u);
}

TEST(TubeRings, ThereAreAsManySidesAsTheToleranceAsksFor) {
  const std::vector<ChainNode> nodes{{{0, 0, 0}, 0.1}, {{0, 0, 5}, 0.01}};
  const ChainPath path(nodes);
  const auto parts = plan_rings(path, {0.2, 4.8}, {0.001, 6});
  ASSERT_EQ(parts.size(), 1u);
  EXPECT_GT(parts[0].front().sides, 20u);
  EXPECT_LT(parts[0].back().sides, 12u);
  for (const TubeRing& ring : parts[0]) {
    const double bow = path.radius(ring.at) * (1 - std::cos(3.14159265 / ring.sides));
    EXPECT_LE(bow, 0.00091);
  }
  const auto round = plan_rings(path, {0.2, 4.8}, {0.1, 30});
  ASSERT_EQ(round.size(), 1u);
  for (const TubeRing& ring : round[0]) EXPECT_GE(ring.sides, 30u);
}

TEST(TubeRings, WallsAroundABendStayWithinTheTolerance) {
  for (const double tolerance : {0.01, 0.002, 0.0004}) {
    const auto nodes = arc(0.5, 0.05, 60);
    const ChainPath path(nodes);
    const auto parts = plan_rings(path, {0.1, path.length() - 0.1}, {tolerance, 6});
    ASSERT_EQ(parts.size(), 1u);
    EXPECT_LE(farthest_of_walls(path, parts[0]), tolerance);
    EXPECT_GT(farthest_of_walls(path, parts[0]), tolerance / 5);   // and no better than that asks for
  }
}

TEST(TubeRings, WallsFollowAStemThatSwellsAndShrinks) {
  std::vector<ChainNode> nodes;
  for (int i = 0; i < 80; ++i) nodes.push_back({{0, 0, 0.02 * i}, 0.1 + 0.006 * (i % 4 == 0)});
  const ChainPath path(nodes);
  for (const auto& rings : plan_rings(path, {0.1, path.length() - 0.1}, {0.002, 6})) EXPECT_LE(farthest_of_walls(path, rings), 0.002);
}

TEST(TubeRings, CornersStandOutByAsMuchAsSidesLieIn) {
  const std::vector<ChainNode> nodes{{{0, 0, 0}, 0.01}, {{0, 0, 1}, 0.01}};
  const ChainPath path(nodes);
  const TubeRing ring = plan_rings(path, {0.1, 0.9}, {0.001, 6})[0][0];
  const Vec3 a = ring_corner(path, ring, 0).position, b = ring_corner(path, ring, 1).position;
  EXPECT_NEAR(path.distance(0.1, a), -path.distance(0.1, (a + b) / 2.0), 1e-4);
}

TEST(TubeRings, RingsDoNotReachEachOther) {
  const auto nodes = arc(0.08, 0.05, 30);   // the inside of the bend is at 0.03
  const ChainPath path(nodes);
  for (const auto& rings : plan_rings(path, {0.02, path.length() - 0.02}, {0.01, 6}))
    for (std::size_t i = 0; i + 1 < rings.size(); ++i)
      for (std::uint32_t k = 0; k < rings[i].sides; ++k) {
        EXPECT_LT(glm::dot(ring_corner(path, rings[i], k).position - rings[i + 1].center, rings[i + 1].along), 0);
      }
}

TEST(TubeRings, ASharpBendPartsThem) {
  const std::vector<ChainNode> nodes{{{0, 0, 0}, 0.05}, {{0, 0, 2}, 0.05}, {{2, 0, 2.2}, 0.05}};
  const ChainPath path(nodes);
  const auto parts = plan_rings(path, {0.1, path.length() - 0.1}, {0.002, 6});
  ASSERT_EQ(parts.size(), 2u);
  EXPECT_LT(parts[0].back().at, 2);
  EXPECT_GT(parts[1].front().at, 2);
  EXPECT_GT(parts[0].back().at, 1);
}

}  // namespace
}  // namespace cambium
