#include "grammar.h"

#include <gtest/gtest.h>

#include <filesystem>
#include <fstream>

namespace cambium {
namespace {

using test::derived_text;
using test::grammar;
using test::parsed;

TEST(LSystemParser, KeywordsAreReadInAnyCase) {
  const std::string text =
      "LSYSTEM: 1\nSeed : 3\nDERIVATION LENGTH: 1+1\nAxiom: A\nA --> AB\nEndLsystem\n";
  EXPECT_EQ(to_text(derive(parsed(text), {}, {}).value()), "ABB");
}

TEST(LSystemParser, TheFirstOfSeveralSystemsRunsUnlessALabelNamesAnother) {
  const std::string text = "lsystem: one\naxiom: A\nendlsystem\nlsystem: two\naxiom: B\nendlsystem\n";
  DeriveOptions options;
  options.steps = 0;
  EXPECT_EQ(to_text(derive(LSystem::parse(text, "t.l"), options, {}).value()), "A");
  EXPECT_EQ(to_text(derive(LSystem::parse(text, "t.l", "two"), options, {}).value()), "B");
  EXPECT_THROW(LSystem::parse(text, "t.l", "three"), InputError);
}

TEST(LSystemParser, ArraysAndBlocksMakeVariables) {
  const std::string text = grammar("A(0)", "A(i) : i < 3 --> F(a[1][i])A(i+1+shift)\nA(i) : i >= 3 --> X(steps,b[1])",
                                   "define: { array a[2,3] = {{1,2,3},{4,5,6}}, b[2] = {-7}; }\n"
                                   "Start: { shift = 0; steps = 0; b[1] = 9; }\nEndEach: { steps = steps + 1; }");
  EXPECT_EQ(derived_text(text, 4), "F(4)F(5)F(6)X(3,9)");
}

TEST(LSystemParser, DecompositionAndHomomorphismHaveTheirOwnProductions) {
  const std::string text =
      "lsystem: 1\nderivation length: 2\naxiom: A(4)\nA(n) --> A(n+1)\ndecomposition\nmaximum depth: 10\n"
      "A(n) : n > 1 --> BA(n-2)\nhomomorphism\nmaximum depth: 2\nB --> F(2)\nendlsystem\n";
  const LSystem system = parsed(text);
  const ModuleString string = derive(system, {}, {}).value();
  // 4 -> BB0; 1 stays; 2 -> B0.
  EXPECT_EQ(to_text(string), "BBBA(0)");
  const Turtled turtled = interpret(string, system, {}, {}).value();
  EXPECT_EQ(turtled.skeleton.nodes.size(), 4u);
  EXPECT_EQ(turtled.total_length, 6);
}

TEST(LSystemParser, SuccessorsGoOnOverIndentedLinesAndInsideBrackets) {
  EXPECT_EQ(derived_text(grammar("A", "A --> F\n   [+F\nB]\n   C\nB --> X"), 1), "F[+FB]C");
}

TEST(LSystemParser, IncludesANeighbour) {
  const auto folder = std::filesystem::temp_directory_path() / "cambium_lsystem_parser_test";
  std::filesystem::create_directories(folder);
  std::ofstream(folder / "angles.h") << "#define ANGLE 30\n";
  std::ofstream(folder / "main.l") << "#include \"angles.h\"\n" + grammar("+(ANGLE)", "");
  EXPECT_EQ(to_text(test::derived(LSystem::load(folder / "main.l"), 0)), "+(30)");
  std::ofstream(folder / "angles.h") << "\n#define ANGLE\n#define B(x\n";
  try {
    LSystem::load(folder / "main.l");
    FAIL();
  } catch (const InputError& error) {
    EXPECT_EQ(error.location().file, (folder / "angles.h").string());
    EXPECT_EQ(error.location().line, 3);
  }
  std::ofstream(folder / "main.l") << "#include \"main.l\"\n";
  EXPECT_THROW(LSystem::load(folder / "main.l"), InputError);
  EXPECT_THROW(LSystem::load(folder / "none.l"), InputError);
  EXPECT_THROW(LSystem::load(folder), InputError);
  std::filesystem::remove_all(folder);
}

}  // namespace
}  // namespace cambium
