#include "skeletons/conditioning.h"

#include "small_trees.h"

#include <gtest/gtest.h>

#include <random>

namespace cambium {
namespace {

SurfaceReport conditioned(AxisTree& tree, Profile profile = Profile::kChain, const ConditioningOptions& options = {}) {
  SurfaceReport report;
  condition(tree, options, profile, {}, report);
  return report;
}

TEST(Conditioning, RadiiDoNotRiseTowardsTheTipAndAreClampedToTheMinimum) {
  Skeleton s;
  const double radii[] = {1.0, 1.2, 0.8, 0.9, 1e-9};
  for (int i = 0; i < 5; ++i) s.nodes.push_back(node_at({0, 0, 10.0 * i}, radii[i], i - 1));
  AxisTree tree = decompose_axes(s);
  const SurfaceReport report = conditioned(tree);
  const double expected[] = {1.0, 1.0, 0.8, 0.8, 1.2e-3};
  ASSERT_EQ(tree.axes[0].nodes.size(), 5u);
  for (int i = 0; i < 5; ++i) EXPECT_DOUBLE_EQ(tree.axes[0].nodes[static_cast<std::size_t>(i)].radius, expected[i]);
  EXPECT_EQ(report.radii_clamped, 3u);
}

TEST(Conditioning, ALateralIsNoThickerThanWhatBearsIt) {
  AxisTree tree = decompose_axes(fork_tree(1, 3, 60, 20));
  conditioned(tree);
  for (const AxisNode& node : tree.axes[1].nodes) EXPECT_LE(node.radius, 1.0);
}

TEST(Conditioning, KnuckledAxesBecomeSmooth) {
  std::mt19937 random(7);
  std::uniform_real_distribution<double> jitter(-0.2, 0.2);
  Skeleton s;
  for (int i = 0; i < 400; ++i) s.nodes.push_back(node_at({jitter(random), jitter(random), 0.25 * i}, 1, i - 1));
  AxisTree tree = decompose_axes(s);
  const SurfaceReport report = conditioned(tree);
  const Axis& axis = tree.axes[0];
  for (std::size_t i = 1; i + 1 < axis.nodes.size(); ++i) {
    const Vec3 in = glm::normalize(axis.nodes[i].position - axis.nodes[i - 1].position);
    const Vec3 out = glm::normalize(axis.nodes[i + 1].position - axis.nodes[i].position);
    EXPECT_LE(std::acos(std::min(1.0, glm::dot(in, out))), degrees(5) + 1e-6);
  }
  EXPECT_GT(report.largest_move, 0.05);
  EXPECT_LT(report.largest_move, 1.0);
  EXPECT_EQ(axis.nodes.front().position, s.nodes.front().position);
  EXPECT_EQ(axis.nodes.back().position, s.nodes.back().position);
}

TEST(Conditioning, CleanLongInternodesStayWhereTheyAre) {
  AxisTree tree = decompose_axes(fork_tree(0.1, 0.05, 45, 5));
  const SurfaceReport report = conditioned(tree);
  EXPECT_LT(report.largest_move, 1e-12);
  EXPECT_EQ(report.nodes_dropped, 0u);
  EXPECT_EQ(report.laterals_rerooted, 0u);
  EXPECT_EQ(tree.axes[0].nodes.size(), 3u);
  EXPECT_EQ(tree.axes[1].nodes.size(), 2u);
}

TEST(Conditioning, ALateralStartsWhereItLeavesItsParent) {
  Skeleton s;  // a lateral that first climbs inside the trunk, with a twig still inside and one outside
  s.nodes = {node_at({0, 0, 0}, 1, -1),      node_at({0, 0, 10}, 1, 0),   node_at({0, 0, 30}, 1, 1),   node_at({0.3, 0, 12}, 0.2, 1),
             node_at({0.6, 0, 14}, 0.2, 3), node_at({6, 0, 16}, 0.2, 4), node_at({0, 8, 14}, 0.1, 4), node_at({6, 8, 16}, 0.1, 5),
             node_at({12, 0, 18}, 0.2, 5)};
  AxisTree tree = decompose_axes(s);
  ASSERT_EQ(tree.axes.size(), 4u);
  const SurfaceReport report = conditioned(tree);
  ASSERT_EQ(tree.axes.size(), 4u);
  EXPECT_EQ(report.laterals_rerooted, 2u);
  EXPECT_EQ(report.nodes_dropped, 2u);
  const Axis& lateral = tree.axes[1];
  EXPECT_NEAR(lateral.nodes[0].position.x, 0, 1e-12);
  EXPECT_NEAR(lateral.nodes[0].position.z, 14 + 2 * 0.4 / 5.4, 1e-6);  // where the segment leaves x = 1
  EXPECT_EQ(tree.axes[2].parent, 0);  // the twig that began inside
  EXPECT_EQ(tree.axes[2].order, 1u);
  EXPECT_NEAR(tree.axes[2].nodes[0].position.z, 14, 1e-9);
  EXPECT_EQ(tree.axes[3].parent, 1);
  EXPECT_LT(glm::distance(tree.axes[3].nodes[0].position, Vec3(6, 0, 16)), 0.1);
}

TEST(Conditioning, ALateralThatNeverLeavesIsDroppedAndItsTwigsMove) {
  Skeleton s;
  s.nodes = {node_at({0, 0, 0}, 1, -1), node_at({0, 0, 10}, 1, 0), node_at({0, 0, 30}, 1, 1),
             node_at({0.3, 0, 12}, 0.2, 1), node_at({0.5, 0, 13}, 0.2, 3), node_at({9, 0, 14}, 0.1, 3)};
  AxisTree tree = decompose_axes(s);
  conditioned(tree);
  ASSERT_EQ(tree.axes.size(), 2u);
  EXPECT_EQ(tree.axes[1].branch, 2u);
  EXPECT_EQ(tree.axes[1].parent, 0);
}

TEST(Conditioning, GalbraithHasNoInternodeShorterThanTwoAndAHalfRadii) {
  AxisTree tree = decompose_axes(zigzag(300, 0.3, 0.02, 0.4));
  conditioned(tree, Profile::kGalbraith);
  const Axis& axis = tree.axes[0];
  for (std::size_t i = 1; i < axis.nodes.size(); ++i)
    EXPECT_GE(glm::distance(axis.nodes[i - 1].position, axis.nodes[i].position), 2.5 * axis.nodes[i - 1].radius);
}

TEST(Conditioning, SwitchedOffItOnlyMakesRadiiLegal) {
  Skeleton s = zigzag(50, 0.1, 0.2, 0.5);
  s.nodes[10].radius = 0.9;
  s.nodes[20].radius = 0;
  AxisTree tree = decompose_axes(s);
  ConditioningOptions off;
  off.enabled = false;
  const SurfaceReport report = conditioned(tree, Profile::kChain, off);
  ASSERT_EQ(tree.axes[0].nodes.size(), 50u);
  EXPECT_EQ(tree.axes[0].nodes[10].radius, 0.9);
  EXPECT_GT(tree.axes[0].nodes[20].radius, 0);
  EXPECT_EQ(tree.axes[0].nodes[7].position, s.nodes[7].position);
  EXPECT_EQ(report.radii_clamped, 1u);
}

TEST(Conditioning, NeverFailsOnNoise) {
  std::mt19937 random(11);
  std::uniform_real_distribution<double> place(-1, 1);
  for (int round = 0; round < 40; ++round) {
    Skeleton s;
    for (int i = 0; i < 200; ++i)
      s.nodes.push_back(node_at(Vec3(place(random), place(random), place(random)) * (round % 4 ? 1.0 : 0.01), 0.1 + 0.3 * std::abs(place(random)),
                                i == 0 ? -1 : static_cast<std::int32_t>(random() % static_cast<unsigned>(i))));
    for (const Profile profile : {Profile::kChain, Profile::kGalbraith}) {
      AxisTree tree = decompose_axes(s);
      SurfaceReport report;
      condition(tree, {}, profile, {0.3, -0.5}, report);
      for (const Axis& axis : tree.axes)
        for (std::size_t i = 0; i < axis.nodes.size(); ++i) {
          ASSERT_TRUE(std::isfinite(glm::length(axis.nodes[i].position)));
          if (i > 0) { ASSERT_LE(axis.nodes[i].radius, axis.nodes[i - 1].radius * (1 + 1e-12)); }
        }
    }
  }
}

}  // namespace
}  // namespace cambium
