#include "cli/recipe_leaf.h"

#include <gtest/gtest.h>

#include "temporary_folder.h"

namespace cambium {
namespace {

Recipe read(const std::string& leaves, const std::vector<std::string>& overrides = {}) {
  TemporaryFolder folder;
  return read_recipe(folder.write("a.tree.toml", "[skeleton]\nlsystem = \"a.l\"\n" + leaves), overrides);
}

TEST(RecipeLeaf, ReadsEveryKey) {
  const Recipe recipe = read(R"([[leaf]]
name = "~blade"
size = ["40mm", 0.06]
scale = 1.5
color = [0.1, 0.3, 0.05]
texture = "leaf.png"
translucency = 0.5
roughness = 0.4
[[leaf]]
mesh = "leaf.obj"
)");
  EXPECT_TRUE(recipe.leaves);
  ASSERT_EQ(recipe.leaf.size(), 2u);
  const LeafRecipe& leaf = recipe.leaf[0];
  EXPECT_EQ(leaf.name, "blade");
  EXPECT_DOUBLE_EQ((*leaf.card)[0], 0.04);
  EXPECT_DOUBLE_EQ((*leaf.card)[1], 0.06);
  EXPECT_DOUBLE_EQ(leaf.scale, 1.5);
  EXPECT_EQ(leaf.color, Vec3(0.1, 0.3, 0.05));
  EXPECT_EQ(leaf.texture->file.filename(), "leaf.png");
  EXPECT_DOUBLE_EQ(leaf.translucency, 0.5);
  EXPECT_DOUBLE_EQ(leaf.roughness, 0.4);
  EXPECT_EQ(recipe.leaf[1].name, "*");
  EXPECT_EQ(recipe.leaf[1].mesh->file.filename(), "leaf.obj");
  EXPECT_FALSE(recipe.leaf[1].color);
}

TEST(RecipeLeaf, LeavesCanBeLeftOutAndSetFromTheCommandLine) {
  EXPECT_FALSE(read("", {"leaves=false"}).leaves);
  const Recipe recipe = read("[[leaf]]\nname = \"a\"\n", {"leaf.0.translucency=0.9", "leaf.1.size=[\"1cm\", \"2cm\"]"});
  ASSERT_EQ(recipe.leaf.size(), 2u);
  EXPECT_DOUBLE_EQ(recipe.leaf[0].translucency, 0.9);
  EXPECT_DOUBLE_EQ((*recipe.leaf[1].card)[1], 0.02);
}

TEST(RecipeLeaf, MatchesByNameByOutlineOrAll) {
  LeafRecipe leaf;
  EXPECT_TRUE(leaf.matches("anything"));
  leaf.name = "polygon";
  EXPECT_TRUE(leaf.matches("polygon1"));
  EXPECT_TRUE(leaf.matches("polygon23"));
  EXPECT_FALSE(leaf.matches("polygonal"));
  EXPECT_FALSE(leaf.matches("blade"));
  leaf.name = "polygon2";
  EXPECT_TRUE(leaf.matches("polygon2"));
  EXPECT_FALSE(leaf.matches("polygon23"));
}

TEST(RecipeLeaf, RefusesWhatItCannotUseNamingThePlace) {
  const struct { const char* text; int line; const char* in_message; } table[] = {
      {"leaves = 3\n", 3, "true or false"},
      {"[leaf]\nname = \"a\"\n", 3, "array"},
      {"[[leaf]]\nname = 3\n", 4, "string"},
      {"[[leaf]]\nname = \"\"\n", 4, "name of an organ"},
      {"[[leaf]]\nname = \"~\"\n", 4, "name of an organ"},
      {"[[leaf]]\nsize = [1]\n", 4, "array of 2"},
      {"[[leaf]]\nsize = [0, 1]\n", 4, "greater than 0"},
      {"[[leaf]]\nsize = [1, 1]\nmesh = \"a.obj\"\n", 5, "not both"},
      {"[[leaf]]\nmesh = \"a.ply\"\n", 4, ".obj"},
      {"[[leaf]]\ncolor = [0, 1.1, 0]\n", 4, "0 to 1"},
      {"[[leaf]]\nscale = -1\n", 4, "greater than 0"},
      {"[[leaf]]\ntranslucency = 1.5\n", 4, "0 to 1"},
      {"[[leaf]]\nroughness = 0\n", 4, "0.05 to 1"},
      {"[[leaf]]\nshine = 2\n", 4, "unknown key"},
  };
  for (const auto& bad : table) {
    SCOPED_TRACE(bad.text);
    // Keys of the root stand before its tables.
    TemporaryFolder folder;
    const std::string text = std::string("# one\n# two\n") + bad.text + "[skeleton]\nlsystem = \"a.l\"\n";
    try {
      read_recipe(folder.write("a.tree.toml", text), {});
      FAIL() << "was read";
    } catch (const InputError& error) {
      EXPECT_EQ(error.location().line, bad.line) << error.what();
      EXPECT_NE(std::string(error.what()).find(bad.in_message), std::string::npos) << error.what();
    }
  }
}

}  // namespace
}  // namespace cambium
