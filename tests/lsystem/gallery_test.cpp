// examples/lsystems/ and the page that shows it. The counts of the published figures are in published_models_test.cpp.
#include <gtest/gtest.h>

#include <algorithm>
#include <filesystem>
#include <fstream>
#include <sstream>

#include "grammar.h"

namespace cambium {
namespace {

const std::filesystem::path kGrammars = CAMBIUM_EXAMPLES "/lsystems";

std::string text_of(const std::filesystem::path& file) {
  std::ostringstream text;
  text << std::ifstream(file, std::ios::binary).rdbuf();
  return text.str();
}

TEST(Gallery, EveryGrammarHasARecipeAndAPictureOnThePage) {
  const std::filesystem::path page(CAMBIUM_GALLERY_PAGE);
  const std::string shown = text_of(page);
  std::size_t grammars = 0;
  for (const auto& entry : std::filesystem::directory_iterator(kGrammars)) {
    if (entry.path().extension() != ".l") continue;
    ++grammars;
    const std::string name = entry.path().stem().string();
    EXPECT_NE(text_of(kGrammars / (name + ".tree.toml")).find("\"" + name + ".l\""), std::string::npos) << name;
    const std::string picture = "gallery/" + name + ".jpg";
    EXPECT_NE(shown.find(picture), std::string::npos) << name;
    EXPECT_TRUE(std::filesystem::exists(page.parent_path() / picture)) << name;
  }
  EXPECT_EQ(grammars, 23u);
}

/// A tree that some species is: its height in metres, and nothing in its grammar that the turtle has to correct.
void expect_species(const std::string& name, double least_height, double most_height) {
  const LSystem system = LSystem::load(kGrammars / (name + ".l"));
  const Turtled tree = interpret(derive(system, {}, {}).value(), system, {}, {}).value();
  EXPECT_EQ(tree.radii_clamped, 0u) << name;
  EXPECT_TRUE(tree.skipped.empty()) << name << " leaves " << tree.skipped.begin()->first;
  double lowest = 1e9, highest = -1e9;
  for (const auto& node : tree.skeleton.nodes) {
    lowest = std::min(lowest, node.position.z);
    highest = std::max(highest, node.position.z);
  }
  EXPECT_GE(lowest, 0) << name;
  EXPECT_GE(highest, least_height) << name;
  EXPECT_LE(highest, most_height) << name;
}

TEST(Gallery, SpeciesAreOfTheirHeightAndStayAboveTheGround) {
  expect_species("poplar", 16, 22);
  expect_species("oak", 9, 15);
  expect_species("birch", 14, 20);
  expect_species("pine", 12, 18);
}

}  // namespace
}  // namespace cambium
