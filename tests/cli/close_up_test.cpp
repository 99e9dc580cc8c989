// Branches named by number become a place in the picture, or an error at the number.
#include "cli/close_up.h"

#include "blobtree/blobtree.h"

#include <gtest/gtest.h>

namespace cambium {
namespace {

Field trunk() {
  BlobTreeBuilder b;
  return Field(b.build(b.add(Chain{{{{0, 0, 0}, 0.10}, {{0, 0, 2}, 0.06}}})));
}

const std::vector<BranchInfo> kBranches{{-1, {0, 0, 0}, {0, 0, 1}}, {0, {0, 0, 1}, {1, 0, 0}}, {0, {0, 0, 5}, {1, 0, 0}}};

std::string refused(RenderRecipe render, std::span<const BranchInfo> branches) {
  try {
    aim_at_branches(render, trunk(), branches);
  } catch (const InputError& error) {
    return error.what();
  }
  return "";
}

TEST(CloseUp, FramesWhereTheBranchLeavesByItsParentsRadius) {
  RenderRecipe render;
  render.close_up = NamedBranch{1, {}};
  aim_at_branches(render, trunk(), kBranches);
  ASSERT_TRUE(render.camera.frame);
  EXPECT_TRUE(render.camera.frame->contains(kBranches[1].pivot));
  EXPECT_NEAR(render.camera.frame->size().x, 6 * 0.08, 1e-9);
  EXPECT_GT(render.camera.frame->center().x, 0);   // towards the branch
  EXPECT_FALSE(render.camera.focus);
}

TEST(CloseUp, FocusesWhereTheBranchLeaves) {
  RenderRecipe render;
  render.focus_branch = NamedBranch{1, {}};
  aim_at_branches(render, trunk(), kBranches);
  EXPECT_EQ(render.camera.focus, kBranches[1].pivot);
  EXPECT_FALSE(render.camera.frame);
}

TEST(CloseUp, RefusesABranchThatIsNotThereWithItsPlace) {
  RenderRecipe render;
  render.close_up = NamedBranch{7, {"a.tree.toml", 3, 12}};
  EXPECT_EQ(refused(render, kBranches), "a.tree.toml:3:12: found branch 7, expected 0 to 2: see cambium info");
  EXPECT_NE(refused(render, {}).find("a BlobTree file has none"), std::string::npos);
  render.close_up = NamedBranch{2, {"a.tree.toml", 3, 12}};
  EXPECT_NE(refused(render, kBranches).find("cut away"), std::string::npos);
}

TEST(CloseUp, LeavesACameraAloneThatNamesNoBranch) {
  RenderRecipe render;
  aim_at_branches(render, trunk(), {});
  EXPECT_FALSE(render.camera.frame);
  EXPECT_FALSE(render.camera.focus);
}

}  // namespace
}  // namespace cambium
