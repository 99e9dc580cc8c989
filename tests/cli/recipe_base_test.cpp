#include "cli/recipe_base.h"

#include <gtest/gtest.h>

#include <numbers>

#include "cli/recipe.h"
#include "temporary_folder.h"

namespace cambium {
namespace {

Recipe read(const std::string& base) {
  TemporaryFolder folder;
  return read_recipe(folder.write("a.tree.toml", "[skeleton]\nlsystem = \"a.l\"\n" + base), {});
}

TEST(RecipeBase, ReadsEveryKey) {
  const TrunkBase base = read(R"([base]
height = "120cm"
spread = 0.7
sharpness = 0.9
section = "quadrifolium"
prongs = [{ angle = 10, length = 1.5 }, { angle = "0.5pi" }]
irregularity = 0.2
ground = [0, 0, "20cm"]
up = [0, 0.2, 1]
below = "cut"
[base.roots]
length = 3
radius = 0.3
taper = 0.8
wander = 45
rise = 0.2
depth = "10cm"
branches = 1.5
)").surface.base.value();
  EXPECT_DOUBLE_EQ(base.height, 1.2);
  EXPECT_DOUBLE_EQ(base.spread, 0.7);
  EXPECT_DOUBLE_EQ(base.sharpness, 0.9);
  EXPECT_EQ(base.section, FlareSection::kQuadrifolium);
  ASSERT_EQ(base.prongs.size(), 2u);
  EXPECT_DOUBLE_EQ(base.prongs[0].angle, std::numbers::pi / 18);
  EXPECT_DOUBLE_EQ(base.prongs[0].length, 1.5);
  EXPECT_DOUBLE_EQ(base.prongs[1].angle, std::numbers::pi / 2);
  EXPECT_DOUBLE_EQ(base.irregularity, 0.2);
  EXPECT_DOUBLE_EQ(base.ground->z, 0.2);
  EXPECT_GT(base.up.y, 0);
  EXPECT_EQ(base.below, BelowGround::kCut);
  EXPECT_DOUBLE_EQ(base.roots.length, 3);
  EXPECT_DOUBLE_EQ(base.roots.radius, 0.3);
  EXPECT_DOUBLE_EQ(base.roots.taper, 0.8);
  EXPECT_DOUBLE_EQ(base.roots.wander, std::numbers::pi / 4);
  EXPECT_DOUBLE_EQ(base.roots.rise, 0.2);
  EXPECT_DOUBLE_EQ(base.roots.depth, 0.1);
  EXPECT_DOUBLE_EQ(base.roots.branches, 1.5);
}

TEST(RecipeBase, IsNoneWhereItIsNotThere) {
  EXPECT_FALSE(read("").surface.base);
  EXPECT_EQ(read("[base]\nprongs = 7\n").surface.base->count, 7);
}

TEST(RecipeBase, RefusesBadValuesAtTheirPlace) {
  struct Case {
    const char* text;
    int line, column;
  };
  const Case cases[] = {
      {"[base]\nhieght = 1", 4, 1},        {"[base]\nheight = 0", 4, 10},      {"[base]\nspread = -1", 4, 10},
      {"[base]\nsharpness = 1", 4, 13},    {"[base]\nsection = \"oval\"", 4, 11}, {"[base]\nprongs = 0", 4, 10},
      {"[base]\nprongs = []", 4, 10},      {"[base]\nprongs = [{ angle = 0 }, { angle = 360 }]", 4, 10},
      {"[base]\nup = [0, 0, 0]", 4, 6},    {"[base]\nbelow = \"open\"", 4, 9},   {"[base.roots]\nradius = 2", 4, 10},
      {"[base.roots]\nlength = -1", 4, 10},
  };
  for (const Case& c : cases) {
    try {
      read(c.text);
      ADD_FAILURE() << c.text;
    } catch (const InputError& error) {
      EXPECT_EQ(error.location().line, c.line) << c.text;
      EXPECT_EQ(error.location().column, c.column) << c.text << "\n" << error.what();
    }
  }
}

}  // namespace
}  // namespace cambium
