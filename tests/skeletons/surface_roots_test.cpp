#include "skeletons/surface_roots.h"

#include <gtest/gtest.h>

#include <cmath>
#include <map>
#include <numbers>

namespace cambium {
namespace {

constexpr double kPi = std::numbers::pi;

Skeleton trunk() {
  Skeleton s;
  for (int i = 0; i < 4; ++i) s.nodes.push_back({{0.5, 0, 1.0 * i}, 0.3, i - 1, {}, {}});
  return s;
}

TEST(SurfaceRoots, StandAroundTheTrunkOneForEachProng) {
  Skeleton s = trunk();
  const auto prongs = draw_prongs(7, 0, 1);
  add_surface_roots(s, prongs, {}, {.wander = 0, .branches = 0}, 1);
  std::vector<std::size_t> first;
  for (std::size_t i = 4; i < s.nodes.size(); ++i)
    if (s.nodes[i].parent == 0) first.push_back(i);
  ASSERT_EQ(first.size(), 7u);
  for (std::size_t k = 0; k < 7; ++k) {
    const SkeletonNode& node = s.nodes[first[k]];
    EXPECT_TRUE(node.lateral.value_or(false));
    EXPECT_NEAR(node.base_radius.value(), 0.35 * 0.3, 1e-12);
    const Vec3 out = node.position - s.nodes[0].position;
    EXPECT_NEAR(std::remainder(std::atan2(out.y, out.x) - prongs[k].angle, 2 * kPi), 0, 1e-9);
  }
}

TEST(SurfaceRoots, TaperAndGoUnderTheGround) {
  Skeleton s = trunk();
  add_surface_roots(s, {{0.7, 1.0}}, {}, {.length = 3, .depth = 0.25, .branches = 0}, 1);
  EXPECT_GT(s.nodes[5].position.z, 0);
  EXPECT_NEAR(s.nodes.back().position.z, -0.25, 1e-9);
  double length = 0;
  for (std::size_t i = 5; i < s.nodes.size(); ++i) {
    EXPECT_LE(s.nodes[i].radius, s.nodes[i - 1].radius + 1e-12);
    const Vec3 step = s.nodes[i].position - s.nodes[i - 1].position;
    length += std::hypot(step.x, step.y);
  }
  EXPECT_NEAR(length, 3 + 0.3, 0.3) << "from the surface of the trunk";
  EXPECT_GE(s.nodes.back().radius, 0.05 * 0.105 - 1e-12);
}

TEST(SurfaceRoots, FollowASlope) {
  Skeleton s = trunk();
  const GroundPlane slope{{0.5, 0, 0}, glm::normalize(Vec3(-1, 0, 3))};
  add_surface_roots(s, draw_prongs(5, 0.3, 2), slope, {.depth = 0.2}, 1);
  double highest = -9, lowest = 9;
  for (std::size_t i = 4; i < s.nodes.size(); ++i) {
    const double height = glm::dot(s.nodes[i].position - slope.point, slope.normal);
    EXPECT_LT(height, 0.5 * 0.13);
    EXPECT_GT(height, -0.2 * 1.3);
    highest = std::max(highest, s.nodes[i].position.z), lowest = std::min(lowest, s.nodes[i].position.z);
  }
  EXPECT_GT(highest, 0.4);
  EXPECT_LT(lowest, -0.4);
}

TEST(SurfaceRoots, LongProngsGoOnAsLongAndThickRoots) {
  Skeleton s = trunk();
  add_surface_roots(s, {{0, 1.5}, {kPi, 0.5}}, {}, {.branches = 0}, 1);
  double east = 0, west = 0;
  for (const SkeletonNode& node : s.nodes) east = std::max(east, node.position.x - 0.5), west = std::max(west, 0.5 - node.position.x);
  EXPECT_GT(east, 1.8 * west);
  EXPECT_GT(s.nodes[4].radius, 1.2 * 0.35 * 0.3 * std::sqrt(0.5));
}

TEST(SurfaceRoots, BearAsManySideRootsAsAskedFor) {
  Skeleton s = trunk();
  add_surface_roots(s, draw_prongs(200, 0.5, 3), {}, {.branches = 1.5}, 5);
  int sides = 0;
  for (std::size_t i = 4; i < s.nodes.size(); ++i) sides += s.nodes[i].lateral.value_or(false) && s.nodes[i].parent != 0;
  EXPECT_NEAR(sides / 200.0, 1.5, 0.15);
}

TEST(SurfaceRoots, DoNotChangeWhereAnotherProngDoes) {
  Skeleton a = trunk(), b = trunk();
  auto prongs = draw_prongs(4, 0.5, 3);
  add_surface_roots(a, prongs, {}, {}, 5);
  prongs.back().length *= 2;
  add_surface_roots(b, prongs, {}, {}, 5);
  std::size_t same = 4;
  while (same < a.nodes.size() && a.nodes[same].position == b.nodes[same].position) ++same;
  int roots = 0;
  for (std::size_t i = 4; i < same; ++i) roots += a.nodes[i].parent == 0;
  EXPECT_EQ(roots, 3);
}

TEST(SurfaceRoots, ProngsNeverMeetAndVaryAsMuchAsAskedFor) {
  for (const double irregularity : {0.0, 0.5, 1.0})
    for (std::uint64_t seed = 0; seed < 50; ++seed) {
      const auto prongs = draw_prongs(6, irregularity, seed);
      for (std::size_t i = 1; i < prongs.size(); ++i) EXPECT_GT(prongs[i].angle, prongs[i - 1].angle);
      EXPECT_GT(prongs[0].angle + 2 * kPi, prongs[5].angle);
      for (const Prong& prong : prongs) EXPECT_LE(std::abs(prong.length - 1), 0.7 * irregularity);
    }
}

TEST(SurfaceRoots, OfNoLengthAreNone) {
  Skeleton s = trunk();
  add_surface_roots(s, draw_prongs(4, 0.5, 3), {}, {.length = 0}, 5);
  EXPECT_EQ(s.nodes.size(), 4u);
}

}  // namespace
}  // namespace cambium
