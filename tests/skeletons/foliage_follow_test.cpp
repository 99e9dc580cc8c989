#include "skeletons/foliage_follow.h"

#include "leafy_trees.h"
#include "skeletons/conditioning.h"
#include "small_trees.h"

#include <gtest/gtest.h>

#include <random>

namespace cambium {
namespace {

SurfaceOptions untouched() {
  SurfaceOptions options;
  options.conditioning.enabled = false;
  options.conditioning.smooth = 0;
  return options;
}

double distance_to(const Axis& axis, const Vec3& p) { return glm::distance(position_at(axis, nearest_place(axis, p)), p); }

void expect_square(const OrganPlacement& organ) {
  EXPECT_LT(glm::distance(glm::cross(organ.left, organ.heading), organ.up), 1e-12);
  EXPECT_NEAR(glm::length(organ.left), 1, 1e-12);
  EXPECT_NEAR(glm::length(organ.heading), 1, 1e-12);
}

TEST(FoliageFollow, WhereNothingMovesEveryOrganStaysAndKnowsItsBranch) {
  const Skeleton tree = fork_tree(0.1, 0.05, 60, 2);
  const Foliage foliage = leaves_at({{2, {0, 0, 4}}, {3, {2, 0, 3}}, {-1, {9, 9, 9}}});
  const Surfaced made = surface(tree, untouched(), foliage);
  ASSERT_EQ(made.foliage.organs.size(), 3u);
  for (int i = 0; i < 3; ++i) {
    const OrganPlacement& organ = made.foliage.organs[static_cast<std::size_t>(i)];
    EXPECT_LT(glm::distance(organ.position, foliage.organs[static_cast<std::size_t>(i)].position), 1e-12);
    EXPECT_LT(glm::distance(organ.heading, Vec3(0, 0, 1)), 1e-12);
  }
  EXPECT_EQ(made.organ_branches, (std::vector<std::uint32_t>{0, 1, 0}));
  EXPECT_EQ(made.report.organs_pruned, 0u);
  EXPECT_EQ(made.foliage.shapes.size(), 1u);
}

TEST(FoliageFollow, OrgansStayOnAnAxisThatIsSmoothed) {
  std::mt19937 random(7);
  std::uniform_real_distribution<double> jitter(-0.3, 0.3);
  Skeleton tree;
  std::vector<std::pair<std::int32_t, Vec3>> places;
  for (int i = 0; i < 200; ++i) {
    tree.nodes.push_back(node_at({jitter(random), jitter(random), 0.25 * i}, 1, i - 1));
    places.emplace_back(i, tree.nodes.back().position);
  }
  AxisTree axes = decompose_axes(tree, RadiusSteps::kTaper, nullptr, nodes_ridden(leaves_at(places)));
  Surfaced made;
  condition(axes, {}, Profile::kChain, {}, made.report);
  ASSERT_GT(made.report.largest_move, 0.1);
  follow_wood(leaves_at(places), tree, axes, made);
  ASSERT_EQ(made.foliage.organs.size(), 200u);
  double before = 0;
  for (std::size_t i = 0; i < 200; ++i) {
    before = std::max(before, distance_to(axes.axes[0], places[i].second));
    EXPECT_LT(distance_to(axes.axes[0], made.foliage.organs[i].position), 1e-9);
    expect_square(made.foliage.organs[i]);
  }
  EXPECT_GT(before, 0.1);
}

TEST(FoliageFollow, AnOrganBesideItsNodeKeepsItsDistance) {
  Skeleton tree = zigzag(40, 0.5, 0.3, 1);
  const Foliage foliage = leaves_at({{20, tree.nodes[20].position + Vec3(0, 2, 0)}});
  const Surfaced made = surface(tree, {}, foliage);
  ASSERT_EQ(made.foliage.organs.size(), 1u);
  const Vec3 at = made.foliage.organs[0].position;
  EXPECT_NEAR(at.y, 2, 1e-6);
  EXPECT_LT(std::abs(at.x), 0.2) << "the zigzag was smoothed away and the organ did not go along";
}

TEST(FoliageFollow, BendsOfTheChainProfileTakeOrgansAlong) {
  const Skeleton tree = fork_tree(0.05, 0.02, 90, 2);
  SurfaceOptions options = untouched();
  options.bend = {0, 0.6};
  Skeleton longer = tree;
  longer.nodes.push_back(node_at({3, 0, 2.9}, 0.02, 3));   // turns up, so that there is something to bend
  longer.nodes.back().lateral = false;
  const Surfaced straight = surface(longer, untouched(), leaves_at({{3, {2, 0, 2}}, {4, {3, 0, 2.9}}}));
  const Surfaced bent = surface(longer, options, leaves_at({{3, {2, 0, 2}}, {4, {3, 0, 2.9}}}));
  ASSERT_EQ(bent.foliage.organs.size(), 2u);
  EXPECT_GT(glm::distance(bent.foliage.organs[1].heading, straight.foliage.organs[1].heading), 0.05);
  for (const OrganPlacement& organ : bent.foliage.organs) expect_square(organ);
}

TEST(FoliageFollow, WhatIsSawnOffTakesItsOrgansWithIt) {
  Skeleton tree = fork_tree(0.1, 0.05, 60, 2);
  tree.nodes.push_back(node_at(tree.nodes[3].position + Vec3(0, 1, 0), 0.03, 3));   // a twig on the lateral
  tree.nodes.back().lateral = true;
  tree.nodes.push_back(node_at(tree.nodes[3].position + Vec3(1, 0, 0), 0.03, 3));
  tree.nodes.back().lateral = false;
  const Foliage foliage = leaves_at({{2, tree.nodes[2].position}, {3, tree.nodes[3].position}, {4, tree.nodes[4].position},
                                     {5, tree.nodes[5].position}});
  SurfaceOptions options;
  options.prunes.push_back({{1, std::nullopt}, 0.5, std::nullopt});
  const Surfaced made = surface(tree, options, foliage);
  ASSERT_EQ(made.foliage.organs.size(), 1u);
  EXPECT_EQ(made.foliage.organs[0].node, 2);
  EXPECT_EQ(made.report.organs_pruned, 3u);
  EXPECT_EQ(made.organ_branches.size(), 1u);
}

TEST(FoliageFollow, AnOrganBelowTheCutStays) {
  Skeleton tree = fork_tree(0.1, 0.05, 60, 2);
  tree.nodes.push_back(node_at(tree.nodes[3].position + Vec3(1, 0, 0), 0.03, 3));
  tree.nodes.back().lateral = false;
  SurfaceOptions options;
  options.prunes.push_back({{1, std::nullopt}, 2.4, std::nullopt});
  const Surfaced made = surface(tree, options, leaves_at({{3, tree.nodes[3].position}, {4, tree.nodes[4].position}}));
  ASSERT_EQ(made.foliage.organs.size(), 1u);
  EXPECT_EQ(made.foliage.organs[0].node, 3);
}

TEST(FoliageFollow, AnOrganOnATwigWithinTheTrunkStaysWhereItIs) {
  Skeleton tree = fork_tree(1, 0.1, 90, 5);
  tree.nodes[3].position = {0.5, 0, 5};   // inside the trunk, and all there is of that branch
  const Surfaced made = surface(tree, {}, leaves_at({{3, {1.5, 0, 5}}}));
  ASSERT_EQ(made.foliage.organs.size(), 1u);
  EXPECT_LT(glm::distance(made.foliage.organs[0].position, Vec3(1.5, 0, 5)), 1e-9);
  EXPECT_EQ(made.organ_branches[0], 0u);
}

}  // namespace
}  // namespace cambium
