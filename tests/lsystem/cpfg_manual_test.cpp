// What cpfg's manual (Mech et al., CPFG Version 4.0 User's Manual, chapter 5.1 "L-system file") lays down of the language, each
// statement in our words with the section it belongs to. Where the manual is silent, what cpfg's published grammar and matcher do.
#include "grammar.h"

#include <gtest/gtest.h>

namespace cambium {
namespace {

using test::derived;
using test::derived_text;
using test::grammar;
using test::parsed;

std::string drawn_symbols(const std::string& text, int steps) {
  const LSystem system = parsed(text);
  std::string out;
  const Turtled turtled = interpret(derived(system, steps), system, {}, {}).value();
  for (const auto& [name, count] : turtled.skipped) out += name + std::to_string(count);
  return out;
}

// 5.1: productions are tried in the order in which they are written, and the first that matches is applied.
TEST(CpfgManual, ProductionsAreAnOrderedList) {
  EXPECT_EQ(derived_text(grammar("A(2)A(1)", "A(x) : x > 1 --> B\nA(x) --> C\nA(x) --> D"), 1), "BC");
}

// 5.1: a module that no production matches is rewritten into itself.
TEST(CpfgManual, TheIdentityProductionIsImplied) { EXPECT_EQ(derived_text(grammar("ABA", "B --> C"), 3), "ACA"); }

// 5.1: a production applies if symbols and numbers of parameters agree and the condition holds; parameters of contexts count as well.
TEST(CpfgManual, MatchingTakesSymbolsAndNumbersOfParameters) {
  EXPECT_EQ(derived_text(grammar("A(1)B(2)A(1,1)B(2)", "A(x) < B(y) : x < y --> C(x+y)"), 1), "A(1)C(3)A(1,1)B(2)");
}

// 5.1: `*` in place of a context means none, as a condition true, as a successor the empty string.
TEST(CpfgManual, AStarIsWhateverIsEmpty) {
  EXPECT_EQ(derived_text(grammar("AB#(2)", "* < A > * : * --> C\nB --> *\n* < #(d) : d < 9 --> #(d+1)"), 1), "C#(3)");
}

// 5.1: keywords may be written with capitals.
TEST(CpfgManual, KeywordsMayBeginWithCapitals) {
  EXPECT_EQ(derived_text("Lsystem: 1\nDerivation length: 1\nDefine: { array a[1] = {4}; }\nStart: {n=0;}\nStart each: {n=n+1;}\n"
                         "End Each: {n=n+1;}\nEnd: {n=0;}\nConsider: A[]\nAxiom: A\nA --> A(a[0],n)\nEndlsystem\n",
                         1),
            "A(4,1)");
}

// 5.1: a line that begins with a tab goes on with the one before.
TEST(CpfgManual, ATabContinuesALine) {
  EXPECT_EQ(derived_text(grammar("A(\n\t1)", "A(x)\n\t: x == 1\n\t--> B\n\t[C]\n\tD : 0.5\nD --> E"), 1), "B[C]D");
}

// 5.1: of productions with probabilities one of those that match is drawn; their numbers need not add up to anything.
TEST(CpfgManual, ProbabilitiesAreWeights) {
  const std::string halves = grammar("D(10)", "D(n) : n > 0 --> D(n-1)D(n-1)\nD(n) : n == 0 --> X : 33\nD(n) : n == 0 --> Y : 33");
  auto count = test::counts(derived(parsed(halves), 11, 2));
  EXPECT_EQ(count["X"] + count["Y"], 1024u);
  EXPECT_NEAR(static_cast<double>(count["X"]), 512, 64);
  // Contexts may differ among them.
  const std::string context = grammar("CD(10)", "D(n) : n > 0 --> D(n-1)D(n-1)\nC < D(n) --> X : 1\nD(n) --> Y : 3");
  EXPECT_EQ(test::counts(derived(parsed(context), 11, 2))["Y"] + test::counts(derived(parsed(context), 11, 2))["X"], 1024u);
}

// 5.1.1: a variable set in a global block is seen in all productions; one that a production sets first is its own.
TEST(CpfgManual, VariablesAreGlobalOrAProductionsOwn) {
  EXPECT_EQ(derived_text(grammar("AB", "A : {g = g+1; l = 5;} * --> A(g,l)\nB --> B(g)", "Start: {g = 10;}"), 1), "A(11,5)B(11)");
}

// 5.1.2: statements before the condition are executed even if it fails then; those behind it only if the production is applied.
TEST(CpfgManual, StatementsStandBeforeAndBehindTheCondition) {
  const std::string text = grammar("AAB", "A : {tried = tried+1;} tried > 1 {applied = applied+1;} --> C\nB --> B(tried,applied)",
                                   "Start: {tried = 0; applied = 0;}");
  EXPECT_EQ(derived_text(text, 1), "ACB(2,1)");
}

// 5.1.2: assignments, if and else, while, do; a statement may be a mere expression.
TEST(CpfgManual, StatementsAreThoseOfC) {
  EXPECT_EQ(derived_text(grammar("A(3)", "A(n) : {s = 0; do {s = s+n; n = n-1;} while (n > 0); if (s == 6) {t = 1;} else {t = 2;} s - t;}"
                                         " 1 --> B(s,t)"),
                         1),
            "B(6,1)");
}

// 5.1.3: Start is executed before the derivation, StartEach before and EndEach behind every step, End at last.
TEST(CpfgManual, GlobalStatementsHaveTheirTime) {
  std::string printed;
  DeriveOptions options;
  options.print = [&](std::string_view text) { printed += text; };
  const LSystem system = parsed("lsystem: 1\nderivation length: 2\nStart: {n = 0; printf(\"start \");}\nStartEach: {n = n+1; printf(\"%.0f(\", n);}\n"
                                "EndEach: {printf(\")\");}\nEnd: {printf(\" end\\n\");}\naxiom: A\nA : {printf(\"A\");} * --> A\nendlsystem\n");
  derive(system, options, {});
  EXPECT_EQ(printed, "start 1(A)2(A) end\n");
}

// 5.1.4: arrays have several dimensions, are filled row by row, and may be assigned to.
TEST(CpfgManual, ArraysAreFilledByRows) {
  EXPECT_EQ(derived_text(grammar("A", "A --> B(a[1][0],a[0][2])", "Define: {\n\tarray a[2][3] =\n\t\t{1,2,3,\n\t\t 4,5,6};\n}\nStart: {a[0][2] = 9;}"), 1),
            "B(4,9)");
}

// 5.1.5: angles of the trigonometric functions are in degrees.
TEST(CpfgManual, AnglesAreInDegrees) {
  const ModuleString string = derived(parsed(grammar("F(sin(30),cos(60),tan(45),asin(0.5),acos(0.5),atan(1))", "")), 0);
  const double expected[] = {0.5, 0.5, 1, 30, 60, 45};
  for (int i = 0; i < 6; ++i) EXPECT_NEAR(string.parameters[static_cast<std::size_t>(i)], expected[i], 1e-12) << i;
}

// 5.1.5: srand(n) begins the random numbers that follow anew, so the file's seed does not matter behind it.
TEST(CpfgManual, SrandReplacesTheSeed) {
  const auto with_seed = [](const char* seed) {
    return derived_text(grammar("A", "A --> B(ran(1))", std::string("seed: ") + seed + "\nStart: {srand(7);}"), 1);
  };
  EXPECT_EQ(with_seed("1"), with_seed("2"));
}

// 5.1.6: between ?(n,s) and $ the productions of the L-system with the label n apply, its axiom and derivation length do not count.
TEST(CpfgManual, ASubLSystemRewritesBetweenItsMarks) {
  const std::string text =
      "lsystem: 1\nderivation length: 9\naxiom: A?(2,0.5)AB$A\nA --> C\nB --> D\nendlsystem\n"
      "lsystem: 2\nderivation length: 99\naxiom: X\nA --> E[A]\nendlsystem\n";
  EXPECT_EQ(derived_text(text, 1), "C?(2,0.5)E[A]B$C");
  EXPECT_EQ(derived_text(text, 2), "C?(2,0.5)E[E[A]]B$C");
}

// 5.1.6: the mark itself is the caller's module, and calls nest.
TEST(CpfgManual, SubLSystemsNest) {
  const std::string text =
      "lsystem: 1\naxiom: ?(2)A?(3)A$A$A?(4)\nA --> one\n?(n) : n == 4 --> four\nendlsystem\n"
      "lsystem: 2\naxiom: A\nA --> two\nendlsystem\nlsystem: 3\naxiom: A\nA --> three\nendlsystem\nlsystem: 4\naxiom: A\nendlsystem\n";
  EXPECT_EQ(derived_text(text, 1), "?(2)two?(3)three$two$onefour");
  EXPECT_TRUE(test::error_of("lsystem: 1\naxiom: ?(7)A$\nendlsystem\nlsystem: 2\naxiom: A\nendlsystem\n"));
}

// 5.1.6: what a sub-L-system makes is decomposed and interpreted by its own rules.
TEST(CpfgManual, ASubLSystemHasItsOwnHomomorphism) {
  const std::string text =
      "lsystem: 1\naxiom: A?(2)A$\nA --> B\nhomomorphism\nB --> X\nendlsystem\n"
      "lsystem: 2\naxiom: A\nA --> C\ndecomposition\nC --> BB\nhomomorphism\nB --> Y\nendlsystem\n";
  EXPECT_EQ(derived_text(text, 1), "B?(2)BB$");
  EXPECT_EQ(drawn_symbols(text, 1), "X1Y2");
}

// 5.1.7: the homomorphism changes the picture, not the string.
TEST(CpfgManual, AHomomorphismLeavesTheStringAlone) {
  const std::string text = "lsystem: 1\naxiom: A\nA --> AB\nhomomorphism: no warnings\nA --> X\nB --> Y\nendlsystem\n";
  EXPECT_EQ(derived_text(text, 2), "ABB");
  EXPECT_EQ(drawn_symbols(text, 2), "X1Y2");
}

// 5.1.7: it is applied recursively, to the maximum depth, which is 1 if the section does not say.
TEST(CpfgManual, ASectionsMaximumDepthBoundsItsRecursion) {
  const auto text = [](const std::string& depth) { return "lsystem: 1\naxiom: A\nB --> B\nhomomorphism\n" + depth + "A --> XA\nendlsystem\n"; };
  EXPECT_EQ(drawn_symbols(text(""), 0), "A1X1");
  EXPECT_EQ(drawn_symbols(text("maximum depth: 4\n"), 0), "A1X4");
  EXPECT_EQ(drawn_symbols(text("maximum depth: 0\n"), 0), "A1");
}

// 5.1.7: a homomorphism may have a seed of its own, so that it looks the same whatever the derivation drew.
TEST(CpfgManual, AHomomorphismMayHaveASeed) {
  const LSystem system = parsed("lsystem: 1\nderivation length: 0\naxiom: A\nA --> A\nhomomorphism\nseed: 5\nA --> F(1+ran(1))\nendlsystem\n");
  DeriveOptions one, other;
  one.seed = 1;
  other.seed = 2;
  EXPECT_EQ(interpret(*derive(system, one, {}), system, {}, {})->total_length, interpret(*derive(system, other, {}), system, {}, {})->total_length);
}

// Decomposition: it follows every step, and the axiom; each section has its own maximum depth.
TEST(CpfgManual, ADecompositionFollowsEveryStep) {
  const std::string text = "lsystem: 1\naxiom: A(3)\nA(n) --> A(n+2)\ndecomposition\nmaximum depth: 100\nA(n) : n > 1 --> IA(n-1)\n"
                           "homomorphism\nmaximum depth: 2\nI --> J\nJ --> K\nK --> L\nendlsystem\n";
  EXPECT_EQ(derived_text(text, 0), "IIA(1)");
  EXPECT_EQ(derived_text(text, 2), "IIIIIIA(1)");
  EXPECT_EQ(drawn_symbols(text, 0), "A1K2");
}

// Decomposition: contexts are those around the module that is being decomposed, in the string before the step.
TEST(CpfgManual, ADecompositionsContextIsThatOfTheWholeModule) {
  EXPECT_EQ(derived_text(grammar("CAD", "A --> BB\nD --> E\ndecomposition\nC < B > D --> X\nB > E --> Y"), 1), "CXXE");
}

// Decomposition is also tried where no production matched.
TEST(CpfgManual, ADecompositionNeedsNoProduction) {
  EXPECT_EQ(derived_text(grammar("A(2)", "B --> B\ndecomposition\nmaximum depth: 2\nA(x) --> C(x)D\nC(x) --> E(x)"), 0), "E(2)D");
}

// Bracketed contexts: a right context can lead out of the branch that the predecessor is in.
TEST(CpfgManual, ARightContextCanLeaveABranch) {
  EXPECT_EQ(derived_text(grammar("A[4FE]B", "4 > F=]B --> 5"), 1), "A[5FE]B");
  EXPECT_EQ(derived_text(grammar("A[4F[E]]B", "4 > F]B --> 5"), 1), "A[5F[E]]B");
  EXPECT_EQ(derived_text(grammar("A[4FE]B", "4 > F]B --> 5"), 1), "A[4FE]B");
}

// Text in a parameter is a label's, which only is drawn.
TEST(CpfgManual, LabelsHaveTextForAParameter) {
  const LSystem system = parsed(grammar("A(2)", "A(x) --> F@L(\" %.f, (\", x)F"));
  EXPECT_EQ(interpret(derived(system, 1), system, {}, {})->skipped.at("@L"), 1u);
}

// The macro processor is C's.
TEST(CpfgManual, MacrosAreCs) {
  EXPECT_EQ(derived_text("#define Apex A\n#define MAX(a,b) (((a)>(b))?(a):(b))\n#define TWICE(x) \\\n\tF(x) F(x)\n"
                         "#if 0\nlsystem\n#elif defined(Apex) && !defined(Bud)\nlsystem: 1\n#endif\naxiom: Apex(1)\n"
                         "Apex(s) : MAX(s,2) == 2 --> TWICE(MAX(s+1,0))\nendlsystem\n",
                         1),
            "F(2)F(2)");
}

}  // namespace
}  // namespace cambium
