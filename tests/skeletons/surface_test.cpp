#include "skeletons/surface.h"

#include "blobtree/field.h"
#include "blobtree/input_error.h"
#include "grown_trees.h"
#include "small_trees.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <random>
#include <utility>

namespace cambium {
namespace {

TEST(Surface, CountsWhatItMade) {
  const SurfaceReport report = surface(fork_tree(0.5, 0.2, 90, 10), {}).report;
  EXPECT_EQ(report.internodes_in, 3u);
  EXPECT_EQ(report.internodes, 3u);
  EXPECT_EQ(report.axes, 2u);
  EXPECT_EQ(report.max_order, 1u);
  EXPECT_EQ(report.roots, 1u);
  EXPECT_EQ(report.min_radius, 0.2);
  EXPECT_EQ(report.max_radius, 0.5);
  EXPECT_NEAR(report.total_length, 30, 1e-12);
}

TEST(Surface, EveryBranchKnowsItsParentAndWhereItLeavesIt) {
  const std::vector<BranchInfo> branches = surface(fork_tree(0.5, 0.2, 90, 10), {}).branches;
  ASSERT_EQ(branches.size(), 2u);
  EXPECT_EQ(branches[0].parent, -1);
  EXPECT_LT(glm::distance(branches[0].pivot, Vec3(0)), 1e-9);
  EXPECT_LT(glm::distance(branches[0].axis, Vec3(0, 0, 1)), 1e-9);
  EXPECT_EQ(branches[1].parent, 0);
  EXPECT_LT(glm::distance(branches[1].pivot, Vec3(0, 0, 10)), 1e-9);
  EXPECT_LT(glm::distance(branches[1].axis, Vec3(1, 0, 0)), 1e-9);
}

TEST(Surface, AnEmptySkeletonAndOptionsOutOfRangeAreInputErrors) {
  EXPECT_THROW(surface({}, {}), InputError);
  SurfaceOptions options;
  options.width = 0.6;
  EXPECT_THROW(surface(fork_tree(0.5, 0.2, 90, 10), options), InputError);
  options.width = 0.5;
  options.lip = -1;
  EXPECT_THROW(surface(fork_tree(0.5, 0.2, 90, 10), options), InputError);
  options.lip = 0;
  options.bend = {INFINITY};
  EXPECT_THROW(surface(fork_tree(0.5, 0.2, 90, 10), options), InputError);
}

TEST(Surface, CoordinatesBeyondWhatABlobTreeHoldsAreAnInputError) {
  Skeleton s = fork_tree(0.5, 0.2, 90, 10);
  s.nodes[2].position.z = 1e12;
  EXPECT_THROW(surface(s, {}), InputError);
}

TEST(Surface, NoiseBecomesALegalFieldInBothProfiles) {
  std::mt19937 random(5);
  std::uniform_real_distribution<double> place(-1, 1);
  for (int round = 0; round < 30; ++round) {
    Skeleton s;
    for (int i = 0; i < 120; ++i) {
      const Vec3 p(place(random), place(random), place(random));
      s.nodes.push_back(node_at(i % 7 == 0 && i > 0 ? s.nodes.back().position : p, 0.02 + 0.2 * std::abs(place(random)),
                                i == 0 ? -1 : static_cast<std::int32_t>(random() % static_cast<unsigned>(i))));
      if (i % 3 == 0) s.nodes.back().lateral = i % 2 == 0;
      if (i % 5 == 0) s.nodes.back().base_radius = 0.1;
    }
    SurfaceOptions options;
    options.profile = round % 2 ? Profile::kChain : Profile::kGalbraith;
    options.conditioning.enabled = round % 3 != 0;
    options.bend = {0.2, 1.0, -0.5};
    options.random_scars = {5, 0.0};
    options.prunes.push_back({{1, {}}, 0.2, {}});
    const Surfaced made = surface(s, options);
    const Field field(made.tree);
    EXPECT_TRUE(field.bounds().bounded());
    EXPECT_TRUE(std::isfinite(field.value(Vec3(0.0))));
  }
}

// Linear in the number of internodes, so small trees speak for large ones.
TEST(Surface, ABlobTreeTakesAtMost200BytesPerInternode) {
  const std::pair<const char*, Skeleton> trees[] = {
      {"axis", grown_axis(10000)}, {"binary tree", grown_binary_tree(10000)}, {"branches", grown_branches(10000)}};
  for (const auto& [name, skeleton] : trees) {
    for (const Profile profile : {Profile::kChain, Profile::kGalbraith}) {
      SCOPED_TRACE(name);
      SurfaceOptions options;
      options.profile = profile;
      const Surfaced made = surface(skeleton, options);
      // Rounded corners make more internodes of those given; both are to hold.
      const std::size_t internodes = std::min(made.report.internodes_in, made.report.internodes);
      EXPECT_GE(internodes, 9000u);
      EXPECT_LE(made.tree.memory_bytes(), 200 * internodes);
    }
  }
}

}  // namespace
}  // namespace cambium
