#include "skeletons/branch_edits.h"

#include "blobtree/field.h"
#include "blobtree/input_error.h"
#include "small_trees.h"

#include <gtest/gtest.h>

namespace cambium {
namespace {

/// A trunk with three laterals along +x at z = 10, 20 and 30, each with a twig up at x = 4.
Skeleton comb() {
  Skeleton s;
  s.nodes.push_back(node_at({0, 0, 0}, 0.5, -1));
  for (int i = 1; i <= 4; ++i) {
    s.nodes.push_back(node_at({0, 0, 10.0 * i}, 0.5, i == 1 ? 0 : static_cast<std::int32_t>(s.nodes.size()) - 4));
    if (i == 4) break;
    const auto at = static_cast<std::int32_t>(s.nodes.size()) - 1;
    s.nodes.push_back(node_at({4, 0, 10.0 * i}, 0.2, at));
    s.nodes.push_back(node_at({8, 0, 10.0 * i}, 0.2, at + 1));
    s.nodes.push_back(node_at({4, 0, 10.0 * i + 4}, 0.1, at + 1));
  }
  return s;
}

Surfaced pruned(const Prune& prune, Profile profile = Profile::kChain) {
  SurfaceOptions options;
  options.profile = profile;
  options.prunes.push_back(prune);
  return surface(comb(), options);
}

TEST(BranchEdits, TheCombIsWhatTheOtherTestsTakeItFor) {
  const AxisTree tree = decompose_axes(comb());
  ASSERT_EQ(tree.axes.size(), 7u);
  EXPECT_EQ(tree.axes[0].nodes.back().position, Vec3(0, 0, 40));
  EXPECT_EQ(tree.axes[2].nodes.back().position, Vec3(8, 0, 20));
  EXPECT_NEAR(length_inside_parent(tree, 2), 0.5, 1e-9);
  EXPECT_EQ(length_inside_parent(tree, 0), 0);
}

TEST(BranchEdits, OnlyTheNamedBranchIsCut) {
  const Field whole(surface(comb(), {}).tree);
  for (const Profile profile : {Profile::kChain, Profile::kGalbraith}) {
    SurfaceOptions options;
    options.profile = profile;
    const Field uncut(surface(comb(), options).tree);
    const Field cut(pruned({{2, {}}, 1.5, {}}, profile).tree);
    EXPECT_GT(cut.value({1.9, 0, 20}), kIso);    // the plane is at x = 0.5 + 1.5
    EXPECT_LT(cut.value({2.1, 0, 20}), kIso);
    EXPECT_EQ(cut.value({6, 0, 20}), 0);
    EXPECT_EQ(cut.value({4, 0, 23}), 0);         // its twig went with it
    for (const Vec3& p : {Vec3(6, 0.1, 10), Vec3(6, 0.1, 30), Vec3(4, 0.05, 13), Vec3(4, 0.05, 33), Vec3(0.1, 0, 15), Vec3(0.4, 0, 39)})
      EXPECT_NEAR(cut.value(p), uncut.value(p), 1e-12);
  }
}

TEST(BranchEdits, TheCutFaceIsFlatAndCrisp) {
  const Field cut(pruned({{2, {}}, 1.5, {}}).tree);
  for (const double y : {0.0, 0.08, 0.15})
    for (const double z : {0.0, 0.1}) {
      EXPECT_NEAR(cut.value({2, y, 20 + z}), kIso, 1e-9);
      EXPECT_EQ(cut.value({2.02, y, 20 + z}), 0);
    }
}

TEST(BranchEdits, LateralsBeforeTheCutStayWholeEvenBeyondThePlane) {
  Prune prune{{2, {}}, 5.5, glm::normalize(Vec3(1, 0, 0.9))};  // at x = 6; the plane meets the twig at x = 4 near z = 22.2
  const Field uncut(surface(comb(), {}).tree), cut(pruned(prune).tree);
  for (const double z : {21.0, 22.0, 23.0, 23.9}) EXPECT_DOUBLE_EQ(cut.value({4.02, 0, z}), uncut.value({4.02, 0, z}));
  EXPECT_EQ(cut.value({7, 0, 20}), 0);
}

TEST(BranchEdits, AnEarlierPartOfABentBranchBeyondThePlaneIsNotCut) {
  Skeleton s;  // up, over and down again, cut on the way down by a level plane at z = 5
  const Vec3 places[] = {{0, 0, 0}, {0, 0, 10}, {5, 0, 15}, {10, 0, 10}, {10, 0, 0}};
  for (int i = 0; i < 5; ++i) s.nodes.push_back(node_at(places[i], 0.3, i - 1));
  const Surfaced uncut = surface(s, {});
  SurfaceOptions options;
  options.prunes.push_back({{0, {}}, uncut.report.total_length - 5, {}});
  const Field cut(surface(s, options).tree);
  EXPECT_GT(cut.value({10, 0, 5.1}), kIso);
  EXPECT_EQ(cut.value({10, 0, 4.9}), 0);
  EXPECT_NEAR(cut.value({0.3, 0, 2}), kIso, 0.02);  // smoothing moves the bend by a fiftieth of the radius
  EXPECT_NEAR(cut.value({0.3, 0, 5}), kIso, 0.02);
}

TEST(BranchEdits, APositionNamesTheNearestBranch) {
  Prune prune;
  prune.where.position = Vec3(7, 1, 31);
  prune.distance = 1;
  const Field cut(pruned(prune).tree);
  EXPECT_EQ(cut.value({6, 0, 30}), 0);
  EXPECT_GT(cut.value({6, 0, 20}), kIso);
}

TEST(BranchEdits, ACutBeyondTheTipOrOfABranchThatIsGoneIsNoted) {
  const Surfaced beyond = pruned({{2, {}}, 50, {}});
  ASSERT_EQ(beyond.report.notes.size(), 1u);
  EXPECT_EQ(Field(beyond.tree).value({6, 0, 20}), Field(surface(comb(), {}).tree).value({6, 0, 20}));
  SurfaceOptions options;
  options.prunes = {{{2, {}}, 1, {}}, {{5, {}}, 1, {}}};
  EXPECT_EQ(surface(comb(), options).report.notes.size(), 2u);
}

TEST(BranchEdits, PrunesThatNameNoBranchAreInputErrors) {
  EXPECT_THROW(pruned({{7, {}}, 1, {}}), InputError);
  EXPECT_THROW(pruned({{{}, {}}, 1, {}}), InputError);
  EXPECT_THROW(pruned({{2, {}}, NAN, {}}), InputError);
  EXPECT_THROW(pruned({{2, {}}, -1, {}}), InputError);
  EXPECT_THROW(pruned({{2, {}}, 1, Vec3(0.0)}), InputError);
}

}  // namespace
}  // namespace cambium
