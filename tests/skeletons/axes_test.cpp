#include "skeletons/axes.h"

#include "small_trees.h"

#include <gtest/gtest.h>

#include <algorithm>

namespace cambium {
namespace {

TEST(Axes, TheUnbracketedChildContinuesEvenIfThinner) {
  Skeleton s;
  s.nodes = {node_at({0, 0, 0}, 1, -1), node_at({0, 0, 5}, 1, 0), node_at({5, 0, 9}, 0.9, 1), node_at({0, 0, 9}, 0.2, 1)};
  s.nodes[2].lateral = true;
  s.nodes[3].lateral = false;
  const AxisTree tree = decompose_axes(s);
  ASSERT_EQ(tree.axes.size(), 2u);
  EXPECT_EQ(tree.axes[0].nodes.back().position, Vec3(0, 0, 9));
  EXPECT_EQ(tree.axes[1].nodes[0].position, Vec3(0, 0, 5));
  EXPECT_EQ(tree.axes[1].nodes[0].radius, 0.9);
  EXPECT_EQ(tree.axes[1].parent, 0);
  EXPECT_EQ(tree.axes[1].order, 1u);
  EXPECT_EQ(position_at(tree.axes[0], tree.axes[1].attach), Vec3(0, 0, 5));
}

TEST(Axes, WithoutFlagsTheThickestContinuesThenTheStraightest) {
  Skeleton s;
  s.nodes = {node_at({0, 0, 0}, 1, -1), node_at({0, 0, 5}, 1, 0), node_at({0, 0, 9}, 0.5, 1), node_at({5, 0, 9}, 0.6, 1)};
  EXPECT_EQ(decompose_axes(s).axes[0].nodes.back().position, Vec3(5, 0, 9));
  s.nodes[3].radius = 0.5;
  EXPECT_EQ(decompose_axes(s).axes[0].nodes.back().position, Vec3(0, 0, 9));
}

TEST(Axes, AnAxisWhoseChildrenAreAllBracketedContinuesInTheThickest) {
  Skeleton s;
  s.nodes = {node_at({0, 0, 0}, 1, -1), node_at({0, 0, 5}, 1, 0), node_at({5, 0, 9}, 0.7, 1), node_at({-5, 0, 9}, 0.8, 1)};
  s.nodes[2].lateral = s.nodes[3].lateral = true;
  EXPECT_EQ(decompose_axes(s).axes[0].nodes.back().position, Vec3(-5, 0, 9));
}

TEST(Axes, BranchIdsGoByOrder) {
  Skeleton s;  // a trunk with two laterals, the first of which bears one
  s.nodes = {node_at({0, 0, 0}, 1, -1),    node_at({0, 0, 5}, 1, 0),    node_at({9, 0, 5}, 0.5, 1), node_at({9, 0, 9}, 0.2, 2),
             node_at({18, 0, 5}, 0.5, 2), node_at({0, 0, 9}, 1, 1),    node_at({0, 9, 9}, 0.5, 5), node_at({0, 0, 12}, 1, 5)};
  const AxisTree tree = decompose_axes(s);
  ASSERT_EQ(tree.axes.size(), 4u);
  for (std::uint32_t i = 0; i < 4; ++i) EXPECT_EQ(tree.axes[i].branch, i);
  EXPECT_EQ(tree.axes[1].nodes.back().position, Vec3(18, 0, 5));
  EXPECT_EQ(tree.axes[2].nodes.back().position, Vec3(0, 9, 9));
  EXPECT_EQ(tree.axes[3].nodes.back().position, Vec3(9, 0, 9));
  EXPECT_EQ(tree.axes[3].order, 2u);
}

TEST(Axes, CoincidentNodesAreMergedAndBadNumbersReplaced) {
  Skeleton s;
  s.nodes = {node_at({0, 0, 0}, 1, -1), node_at({0, 0, 5}, 1, 0), node_at({0, 0, 5}, 1, 1),
             node_at({NAN, 0, 5}, NAN, 2), node_at({0, 0, 9}, 1, 3)};
  std::size_t merged = 0;
  const AxisTree tree = decompose_axes(s, RadiusSteps::kTaper, &merged);
  ASSERT_EQ(tree.axes.size(), 1u);
  EXPECT_EQ(tree.axes[0].nodes.size(), 3u);
  EXPECT_EQ(merged, 2u);
}

TEST(Axes, AThinnerBaseRadiusBecomesATaperOrIsKept) {
  Skeleton s;
  s.nodes = {node_at({0, 0, 0}, 1, -1), node_at({0, 0, 10}, 1, 0), node_at({0, 0, 20}, 0.8, 1)};
  s.nodes[2].base_radius = 0.8;
  const Axis tapered = decompose_axes(s, RadiusSteps::kTaper).axes[0], kept = decompose_axes(s, RadiusSteps::kKeep).axes[0];
  ASSERT_EQ(tapered.nodes.size(), 3u);
  EXPECT_DOUBLE_EQ(tapered.nodes[1].radius, 1);
  EXPECT_DOUBLE_EQ(tapered.nodes[2].radius, 0.8);
  EXPECT_EQ(tapered.nodes[2].base_radius, 0);
  ASSERT_EQ(kept.nodes.size(), 3u);
  EXPECT_DOUBLE_EQ(kept.nodes[2].base_radius, 0.8);
}

TEST(Axes, RemovingAnAxisRemovesWhatItBears) {
  Skeleton s;
  s.nodes = {node_at({0, 0, 0}, 1, -1), node_at({0, 0, 5}, 1, 0),   node_at({0, 0, 9}, 1, 1),  node_at({9, 0, 5}, 0.5, 1),
             node_at({9, 9, 5}, 0.5, 3), node_at({9, 5, 9}, 0.2, 3), node_at({-9, 0, 5}, 0.4, 1)};
  AxisTree tree = decompose_axes(s);
  ASSERT_EQ(tree.axes.size(), 4u);
  remove_axes(tree, {false, true, false, false});
  ASSERT_EQ(tree.axes.size(), 2u);
  EXPECT_EQ(tree.axes[1].branch, 2u);
  EXPECT_EQ(tree.axes[1].nodes.back().position, Vec3(-9, 0, 5));
}

TEST(Axes, WalkingAndSearchingFindTheSamePlaceOnAStraightAxis) {
  Axis axis;
  for (int i = 0; i < 20; ++i) axis.nodes.push_back({Vec3(0, 0, i), 1});
  for (const double z : {-3.0, 0.25, 7.5, 13.0, 30.0}) {
    const AxisPlace near = nearest_place(axis, {1, 0, z}), walked = walk_to_nearest(axis, {10, 0.5}, {1, 0, z});
    EXPECT_NEAR(position_at(axis, near).z, std::clamp(z, 0.0, 19.0), 1e-12);
    EXPECT_NEAR(position_at(axis, walked).z, std::clamp(z, 0.0, 19.0), 1e-12);
  }
}

TEST(Axes, TransportKeepsDirectionsUnitAndAcross) {
  const Vec3 from(0, 0, 1), u(1, 0, 0);
  for (const Vec3& raw : {Vec3(1, 2, 3), Vec3(-1, 0.2, 0.1), Vec3(0, 0, -1), Vec3(0, 0, 1)}) {
    const Vec3 to = glm::normalize(raw), moved = transported(u, from, to);
    EXPECT_NEAR(glm::length(moved), 1, 1e-12);
    EXPECT_NEAR(glm::dot(moved, to), 0, 1e-12);
  }
  EXPECT_NEAR(transported(u, from, from).x, 1, 1e-12);
}

}  // namespace
}  // namespace cambium
