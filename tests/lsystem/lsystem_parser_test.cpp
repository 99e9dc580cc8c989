#include "grammar.h"

#include <gtest/gtest.h>

#include <filesystem>
#include <fstream>

namespace cambium {
namespace {

using test::derived_text;
using test::error_of;
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
  const Turtled turtled = interpret(string, system, {});
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

TEST(LSystemParser, MalformedInputNamesItsLineAndColumn) {
  struct Row {
    const char* text;
    int line, column;
    const char* found;  // a part of it
  };
  const std::string head = "lsystem: 1\naxiom: A(1)\n";  // the production is line 3
  const Row whole_files[] = {
      {"", 1, 1, "the end of the file"},
      {"axiom: A\n", 1, 1, "'axiom'"},
      {"lsystem 1\n", 1, 9, "'1'"},
      {"lsystem: 1\nendlsystem\n", 1, 1, "without an axiom"},
      {"\n lsystem: 1\naxiom: A\n", 2, 2, "without an end"},
      {"lsystem: 1\naxiom: A\naxiom: B\nendlsystem\n", 3, 1, "second axiom"},
      {"lsystem: 1\naxiom:\nendlsystem\n", 2, 7, "the end of the line"},
      {"lsystem: 1\naxiom: A[B\nendlsystem\n", 2, 9, "'['"},
      {"lsystem: 1\naxiom: A]B\nendlsystem\n", 2, 9, "']'"},
      {"lsystem: 1\naxiom: F(1 2)\nendlsystem\n", 2, 12, "'2'"},
      {"lsystem: 1\nseed: -1\naxiom: A\nendlsystem\n", 2, 7, "-1"},
      {"lsystem: 1\nderivation length: 2.5\naxiom: A\nendlsystem\n", 2, 20, "2.5"},
      {"lsystem: 1\nderivation length: N\naxiom: A\nendlsystem\n", 2, 20, "'N'"},
      {"lsystem: 1\ndefine: { int a; }\naxiom: A\nendlsystem\n", 2, 11, "'int'"},
      {"lsystem: 1\ndefine: { array a[0]; }\naxiom: A\nendlsystem\n", 2, 19, "'0'"},
      {"lsystem: 1\ndefine: { array a[1] = {1,2}; }\naxiom: A\nendlsystem\n", 2, 27, "more values"},
      {"lsystem: 1\nStart: { x = ; }\naxiom: A\nendlsystem\n", 2, 14, "';'"},
      {"lsystem: 1\nStart: { x = 1;\naxiom: A\nendlsystem\n", 3, 6, "':'"},
      {"lsystem: 1\naxiom: A\nendlsystem\nrest", 4, 1, "'rest'"},
      {"lsystem: 1 /* no end\naxiom: A\nendlsystem\n", 1, 12, "a comment"},
      {"#if 1\nlsystem: 1\naxiom: A\nendlsystem\n", 1, 1, "#if"},
      {"lsystem: 1\n #else\naxiom: A\nendlsystem\n", 2, 2, "#else"},
      {"#define M(a,b) a\nlsystem: 1\naxiom: F(M(1))\nendlsystem\n", 3, 10, "'M' with 1 argument"},
      {"#define M(a) a\nlsystem: 1\naxiom: F(M(1)\nendlsystem\n", 3, 9, "'('"},
      {"#define M(a,a) a\n", 1, 13, "'a' twice"},
      {"#include <stdio.h>\n", 1, 10, "<stdio.h>"},
      {"\n  #include \"no such file\"\n", 2, 12, "no such file"},
      {"#error stop\n", 1, 1, "stop"},
      {"#if 1 +\n#endif\n", 1, 7, "the end"},
      {"lsystem: 1\naxiom: \xc3\xa4\nendlsystem\n", 2, 8, "byte 0xc3"},
  };
  for (const Row& row : whole_files) {
    const auto error = error_of(row.text);
    ASSERT_TRUE(error) << row.text;
    EXPECT_EQ(error->location().line, row.line) << row.text << "\n" << error->what();
    EXPECT_EQ(error->location().column, row.column) << row.text << "\n" << error->what();
    EXPECT_NE(error->found().find(row.found), std::string::npos) << row.text << "\n" << error->what();
    EXPECT_EQ(error->location().file, "test.l");
  }
  const Row productions[] = {
      {"A(s) F(t)", 3, 10, "the end of the line"},
      {"A(s)", 3, 5, "the end of the line"},
      {"A(s --> F(s)", 3, 5, "'-->'"},
      {"A(1) --> F(1)", 3, 3, "'1'"},
      {"A(s,s) --> F(s)", 3, 5, "'s' twice"},
      {"A(s) -->", 3, 9, "the end of the line"},
      {"A(s) --> F(t)", 3, 12, "'t'"},
      {"A(s) --> F(sine(s))", 3, 12, "'sine'"},
      {"A(s) --> F(sin(s,s))", 3, 12, "'sin' with 2 arguments"},
      {"A(s) --> F(func(1,s))", 3, 12, "'func'"},
      {"A(s) --> F(s+)", 3, 14, "')'"},
      {"A(s) --> F((s)", 3, 11, "'(' without an end"},
      {"A(s) --> F(1e999)", 3, 12, "'1e999'"},
      {"A(s) --> [F(s)", 3, 10, "'['"},
      {"A(s) --> F(s)]", 3, 14, "']'"},
      {"A(s) --> F(s) : ", 3, 17, "the end of the line"},
      {"A(s) --> F(s) \"x\"", 3, 15, "'\"'"},
      {"A(s) : --> F(s)", 3, 8, "'-->'"},
      {"A(s) : s > --> F(s)", 3, 12, "'-->'"},
      {"A(s) : {x=s} s --> F(s)", 3, 12, "'}'"},
      {"< A(s) --> F(s)", 3, 1, "'<'"},
      {"B < C < A(s) --> F(s)", 3, 7, "'<'"},
      {"A(s) > --> F(s)", 3, 8, "'-->'"},
      {"[ --> F", 3, 1, "'['"},
      {"B] < A(s) --> F", 3, 2, "']'"},
      {"A(s) --> ~", 3, 10, "'~'"},
      // Errors of derivation name the expression.
      {"A(s) --> F(s/(s-1))", 3, 13, "a division by zero"},
      {"A(s) : s % 0 == 1 --> F(s)", 3, 10, "division by zero"},
      {"A(s) --> F(sqrt(-s))", 3, 12, "sqrt(-1)"},
      {"A(s) --> F(log(0))", 3, 12, "log(0)"},
      {"A(s) --> F(1e300*1e300)", 3, 17, "not finite"},
      {"A(s) --> F(s) : -1", 3, 17, "negative weight"},
      {"A(s) : {while (1) x = 1;} * --> F(s)", 3, 9, "does not end"},
  };
  for (const Row& row : productions) {
    const auto error = error_of(head + row.text + "\nendlsystem\n");
    ASSERT_TRUE(error) << row.text;
    EXPECT_EQ(error->location().line, row.line) << row.text << "\n" << error->what();
    EXPECT_EQ(error->location().column, row.column) << row.text << "\n" << error->what();
    EXPECT_NE(error->found().find(row.found), std::string::npos) << row.text << "\n" << error->what();
  }
}

}  // namespace
}  // namespace cambium
