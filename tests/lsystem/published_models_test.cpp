// The numbers of lsystem.md, "Numbers that must come out exactly". ABOP's figures are the files of the gallery.
#include <gtest/gtest.h>

#include <filesystem>
#include <map>

#include "grammar.h"

namespace cambium {
namespace {

using test::counts;
using test::derived;
using test::derived_text;
using test::grammar;
using test::parsed;

LSystem model(const std::string& name) {
  return LSystem::load(std::filesystem::path(CAMBIUM_EXAMPLES "/lsystems") / (name + ".l"));
}

ModuleString derived_as_written(const LSystem& system) { return derive(system, {}, {}).value(); }

TEST(PublishedModels, AlgaeGrowLikeFibonacci) {
  const LSystem algae = parsed(grammar("b", "a --> ab\nb --> a"));
  const std::size_t expected[] = {1, 1, 2, 3, 5, 8, 13, 21, 34, 55, 89};
  for (int n = 0; n <= 10; ++n) EXPECT_EQ(derived(algae, n).size(), expected[n]) << n;
}

TEST(PublishedModels, SignalMovesOneModulePerStep) {
  const std::string signal = grammar("baaaaaaaa", "b < a --> b\nb --> a");
  EXPECT_EQ(derived_text(signal, 1), "abaaaaaaa");
  EXPECT_EQ(derived_text(signal, 2), "aabaaaaaa");
  EXPECT_EQ(derived_text(signal, 3), "aaabaaaaa");
}

TEST(PublishedModels, KochAndDragonCurvesHaveTheirLengths) {
  const ModuleString snowflake = derived(parsed(grammar("F++F++F", "F --> F-F++F-F")), 5);
  EXPECT_EQ(counts(snowflake)["F"], 3072u);
  EXPECT_EQ(snowflake.size(), 7168u);
  const ModuleString island = derived(parsed(grammar("F-F-F-F", "F --> F-F+F+FF-F-F+F")), 4);
  EXPECT_EQ(counts(island)["F"], 16384u);
  EXPECT_EQ(island.size(), 30427u);
  const ModuleString dragon = derived(parsed(grammar("L", "L --> L+R+\nR --> -L-R")), 10);
  EXPECT_EQ(counts(dragon)["L"] + counts(dragon)["R"], 1024u);
  EXPECT_EQ(dragon.size(), 3070u);
}

TEST(PublishedModels, EveryFigureHasItsModules) {
  struct Counts {
    std::size_t modules, f;
  };
  // A ternary tree's A becomes 3 A and 16 other modules, 4 of them F. So after n steps there are 3 + 3^n + 8 (3^n - 1)
  // modules, 2 * 3^n - 1 of them F.
  const std::map<std::string, Counts> rows = {
      {"abop_1_24a", {7811, 3125}},  {"abop_1_24b", {9373, 3125}},  {"abop_1_24c", {11116, 4096}},
      {"abop_1_24d", {13956, 4118}}, {"abop_1_24e", {12863, 4118}}, {"abop_1_24f", {6263, 1488}},
      {"abop_1_25", {77399, 3891}},  {"abop_2_6a", {7162, 1023}},   {"abop_2_6b", {7162, 1023}},
      {"abop_2_6c", {7162, 1023}},   {"abop_2_6d", {7162, 1023}},   {"abop_2_7a", {11253, 1023}},
      {"abop_2_7b", {11253, 1023}},  {"abop_2_7c", {11253, 1023}},  {"abop_2_7d", {11253, 1023}},
      {"abop_2_8a", {6556, 1457}},   {"abop_2_8b", {59044, 13121}}, {"abop_2_8c", {59044, 13121}},
      {"abop_2_8d", {6556, 1457}},
  };
  std::size_t figures = 0;
  for (const auto& entry : std::filesystem::directory_iterator(CAMBIUM_EXAMPLES "/lsystems")) {
    const std::string name = entry.path().stem().string();
    if (entry.path().extension() != ".l" || !name.starts_with("abop_")) continue;
    ++figures;
    const auto row = rows.find(name);
    ASSERT_NE(row, rows.end()) << name << " has no row";
    const ModuleString string = derived_as_written(LSystem::load(entry.path()));
    EXPECT_EQ(string.size(), row->second.modules) << name;
    EXPECT_EQ(counts(string)["F"], row->second.f) << name;
  }
  EXPECT_EQ(figures, rows.size());
}

TEST(PublishedModels, BushOfFigure125) {
  auto count = counts(derived_as_written(model("abop_1_25")));
  EXPECT_EQ(count["A"], 2187u);
  EXPECT_EQ(count["L"], 2607u);
}

TEST(PublishedModels, RowOfTrees) {
  const LSystem row = parsed("#define p 0.3\n#define q (1-p)\n#define h ((p*q)^0.5)\n" +
                             grammar("-(90)F(1)", "F(x) --> F(x*p)+(86)F(x*h)-(86)-(86)F(x*h)+(86)F(x*q)"));
  for (int n = 0; n <= 6; ++n) {
    const ModuleString string = derived(row, n);
    EXPECT_EQ(counts(string)["F"], std::size_t{1} << (2 * n));
    const Turtled turtled = interpret(string, row, {}, {}).value();
    EXPECT_NEAR(turtled.total_length, std::pow(1.916515, n), 1e-5 * std::pow(1.916515, n));
    EXPECT_NEAR(turtled.skeleton.nodes.back().position.x, std::pow(1.063933, n), 1e-5);
    EXPECT_NEAR(turtled.skeleton.nodes.back().position.z, 0, 1e-9);
  }
}

TEST(PublishedModels, SelfSimilarBinaryTree) {
  const LSystem tree = parsed("#define R 1.456\n" + grammar("A(1)", "A(s) --> F(s)[+(85)A(s/R)][-(85)A(s/R)]"));
  const ModuleString string = derived(tree, 11);
  EXPECT_EQ(counts(string)["F"], 2047u);
  const Turtled turtled = interpret(string, tree, {}, {}).value();
  EXPECT_NEAR(turtled.total_length, 85.2495, 5e-5);
  EXPECT_EQ(turtled.skeleton.nodes.size(), 2048u);
}

TEST(PublishedModels, HondaTreesOfFigure26) {
  const std::pair<const char*, double> rows[] = {
      {"abop_2_6a", 113.330}, {"abop_2_6b", 445.058}, {"abop_2_6c", 286.571}, {"abop_2_6d", 181.585}};
  for (const auto& [name, length] : rows) {
    const LSystem system = model(name);
    const ModuleString string = derived_as_written(system);
    auto count = counts(string);
    EXPECT_EQ(count["A"], 1u) << name;
    EXPECT_EQ(count["B"], 341u) << name;
    EXPECT_EQ(count["C"], 682u) << name;
    const Turtled turtled = interpret(string, system, {}, {}).value();
    EXPECT_NEAR(turtled.total_length, length, 6e-4) << name;
    EXPECT_NEAR(turtled.last_width, 0.441341, 6e-7) << name;
    EXPECT_EQ(turtled.skeleton.nodes.size(), 1024u) << name;
    EXPECT_EQ(turtled.radii_clamped, 0u) << name;
  }
}

TEST(PublishedModels, SympodialTreesOfFigure27) {
  const std::pair<const char*, double> rows[] = {
      {"abop_2_7a", 181.585}, {"abop_2_7b", 181.585}, {"abop_2_7c", 286.571}, {"abop_2_7d", 286.571}};
  for (const auto& [name, length] : rows) {
    const LSystem system = model(name);
    EXPECT_NEAR(interpret(derived_as_written(system), system, {}, {})->total_length, length, 6e-4) << name;
  }
}

TEST(PublishedModels, TernaryTreesOfFigure28) {
  const std::tuple<const char*, std::size_t, Vec3, double> rows[] = {{"abop_2_8a", 1457, Vec3(0, 0, -1), 0.22},
                                                                     {"abop_2_8b", 13121, Vec3(0, 0, -1), 0.14},
                                                                     {"abop_2_8c", 13121, Vec3(-0.02, 0, -1), 0.27},
                                                                     {"abop_2_8d", 1457, Vec3(-0.61, 0.19, 0.77), 0.40}};
  for (const auto& [name, f, tropism, elasticity] : rows) {
    const LSystem system = model(name);
    TurtleOptions options;
    options.tropism = tropism;
    options.elasticity = elasticity;
    const Turtled turtled = interpret(derived_as_written(system), system, options, {}).value();
    EXPECT_EQ(turtled.skeleton.nodes.size(), f + 1) << name;
    EXPECT_EQ(turtled.radii_clamped, 0u) << name;
  }
}

}  // namespace
}  // namespace cambium
