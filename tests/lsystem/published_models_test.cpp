// The numbers of lsystem.md, "Numbers that must come out exactly".
#include "grammar.h"

#include <gtest/gtest.h>

#include <filesystem>

namespace cambium {
namespace {

using test::counts;
using test::derived;
using test::derived_text;
using test::grammar;
using test::parsed;

LSystem model(const std::string& name) { return LSystem::load(std::filesystem::path(CAMBIUM_LSYSTEM_MODELS) / (name + ".l")); }

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

TEST(PublishedModels, PlantLikeStructuresOfFigure124) {
  struct Row {
    const char* axiom;
    const char* productions;
    int steps;
    std::size_t f, size;
  };
  const Row rows[] = {
      {"F", "F --> F[+F]F[-F]F", 5, 3125, 7811},
      {"F", "F --> F[+F]F[-F][F]", 5, 3125, 9373},
      {"F", "F --> FF-[-F+F+F]+[+F-F-F]", 4, 4096, 11116},
      {"X", "X --> F[+X]F[-X]+X\nF --> FF", 7, 4118, 13956},
      {"X", "X --> F[+X][-X]FX\nF --> FF", 7, 4118, 12863},
      {"X", "X --> F-[[X]+X]+F[+FX]-X\nF --> FF", 5, 1488, 6263},
  };
  for (const Row& row : rows) {
    const ModuleString string = derived(parsed(grammar(row.axiom, row.productions)), row.steps);
    EXPECT_EQ(counts(string)["F"], row.f) << row.productions;
    EXPECT_EQ(string.size(), row.size) << row.productions;
  }
}

TEST(PublishedModels, BushOfFigure125) {
  // Two slashes in a row would begin a comment, as in cpfg.
  const ModuleString bush = derived(parsed(grammar("A",
                                                   "A --> [&FL!A]/ / / / /'[&FL!A]/ / / / / / /'[&FL!A]\n"
                                                   "F --> S/ / / / /F\n"
                                                   "S --> FL\n"
                                                   "L --> ['''^^{-f+f+f-|-f+f+f}]")),
                                    7);
  auto count = counts(bush);
  EXPECT_EQ(bush.size(), 77399u);
  EXPECT_EQ(count["A"], 2187u);
  EXPECT_EQ(count["F"], 3891u);
  EXPECT_EQ(count["L"], 2607u);
}

TEST(PublishedModels, RowOfTrees) {
  const LSystem row = parsed(
      "#define p 0.3\n#define q (1-p)\n#define h ((p*q)^0.5)\n" +
      grammar("-(90)F(1)", "F(x) --> F(x*p)+(86)F(x*h)-(86)-(86)F(x*h)+(86)F(x*q)"));
  for (int n = 0; n <= 6; ++n) {
    const ModuleString string = derived(row, n);
    EXPECT_EQ(counts(string)["F"], std::size_t{1} << (2 * n));
    const Turtled turtled = interpret(string, row, {});
    EXPECT_NEAR(turtled.total_length, std::pow(1.916515, n), 1e-5 * std::pow(1.916515, n));
    EXPECT_NEAR(turtled.skeleton.nodes.back().position.x, std::pow(1.063933, n), 1e-5);
    EXPECT_NEAR(turtled.skeleton.nodes.back().position.z, 0, 1e-9);
  }
}

TEST(PublishedModels, SelfSimilarBinaryTree) {
  const LSystem tree = parsed("#define R 1.456\n" + grammar("A(1)", "A(s) --> F(s)[+(85)A(s/R)][-(85)A(s/R)]"));
  const ModuleString string = derived(tree, 11);
  EXPECT_EQ(counts(string)["F"], 2047u);
  const Turtled turtled = interpret(string, tree, {});
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
    EXPECT_EQ(string.size(), 7162u) << name;
    EXPECT_EQ(count["F"], 1023u) << name;
    EXPECT_EQ(count["A"], 1u) << name;
    EXPECT_EQ(count["B"], 341u) << name;
    EXPECT_EQ(count["C"], 682u) << name;
    const Turtled turtled = interpret(string, system, {});
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
    const ModuleString string = derived_as_written(system);
    EXPECT_EQ(string.size(), 11253u) << name;
    EXPECT_EQ(counts(string)["F"], 1023u) << name;
    EXPECT_NEAR(interpret(string, system, {}).total_length, length, 6e-4) << name;
  }
}

TEST(PublishedModels, TernaryTreesOfFigure28) {
  const std::tuple<const char*, std::size_t, Vec3, double> rows[] = {{"abop_2_8b", 13121, Vec3(0, 0, -1), 0.14},
                                                                     {"abop_2_8c", 13121, Vec3(-0.02, 0, -1), 0.27},
                                                                     {"abop_2_8d", 1457, Vec3(-0.61, 0.19, 0.77), 0.40}};
  for (const auto& [name, f, tropism, elasticity] : rows) {
    const LSystem system = model(name);
    const ModuleString string = derived_as_written(system);
    EXPECT_EQ(counts(string)["F"], f) << name;
    TurtleOptions options;
    options.tropism = tropism;
    options.elasticity = elasticity;
    const Turtled turtled = interpret(string, system, options);
    EXPECT_EQ(turtled.skeleton.nodes.size(), f + 1) << name;
    EXPECT_EQ(turtled.radii_clamped, 0u) << name;
  }
}

}  // namespace
}  // namespace cambium
