// Houdini's rules: models that come out as their cpfg twins, and what is refused where.
#include <gtest/gtest.h>

#include "grammar.h"
#include "mistake.h"

namespace cambium {
namespace {

LSystem houdini(const std::string& text) { return LSystem::parse(text, "test.l", std::nullopt, Dialect::kHoudini); }

std::string houdini_text(const std::string& text, int steps, std::uint64_t seed = 0) {
  return to_text(test::derived(houdini(text), steps, seed));
}

TEST(DialectHoudini, KochIsAsInCpfg) {
  EXPECT_EQ(houdini_text("Premise: F++F++F\nRule 1: F=F-F++F-F\n", 3), test::derived_text(test::grammar("F++F++F", "F-->F-F++F-F"), 3));
}

TEST(DialectHoudini, TheMonopodialTreeOfTheBookHasTheSkeletonOfItsCpfgTwin) {
  const LSystem one = houdini(
      "# ABOP 2.6: b is the branches' angle\nvar b 45\nVariable c: 0.9\nPremise: A(1,10)\n"
      "Rule 1: A(l,w)=F(l,w)[^(b)B(l*0.6,w*.707)]\\(137.5)A(l*c,w*.707)\n"
      "Rule 2: B(l,w)=F(l,w)[+(b)$C(l*0.6,w*.707)]C(l*c,w*.707)\n"
      "Rule 3: C(l,w)=F(l,w)[-(b)$B(l*0.6,w*.707)]B(l*c,w*.707)\n");
  const LSystem other = test::parsed(test::grammar("A(1,10)",
                                                   "A(l,w) --> !(w)F(l)[&(45)B(l*0.6,w*.707)]/(137.5)A(l*0.9,w*.707)\n"
                                                   "B(l,w) --> !(w)F(l)[-(45)$C(l*0.6,w*.707)]C(l*0.9,w*.707)\n"
                                                   "C(l,w) --> !(w)F(l)[+(45)$B(l*0.6,w*.707)]B(l*0.9,w*.707)"));
  const Turtled a = interpret(test::derived(one, 6), one, {}, {}).value();
  const Turtled b = interpret(test::derived(other, 6), other, {}, {}).value();
  ASSERT_EQ(a.skeleton.nodes.size(), b.skeleton.nodes.size());
  EXPECT_GT(a.skeleton.nodes.size(), 60u);
  for (std::size_t i = 0; i < a.skeleton.nodes.size(); ++i) {
    EXPECT_LT(glm::length(a.skeleton.nodes[i].position - b.skeleton.nodes[i].position), 1e-12);
    EXPECT_NEAR(a.skeleton.nodes[i].radius, b.skeleton.nodes[i].radius, 1e-12);
  }
}

TEST(DialectHoudini, ProbabilitiesAreDrawnAsTheirCpfgTwinsWeights) {
  const char* const kHoudini = "Premise: F\nRule 1: F=F[+F]F[-F]F:0.33\nRule 2: F=F[+F]F:.33\nF=F[-F]F : 0.34\n";
  const std::string cpfg = test::grammar("F", "F-->F[+F]F[-F]F:33\nF-->F[+F]F:33\nF-->F[-F]F:34");
  for (std::uint64_t seed = 1; seed < 6; ++seed) EXPECT_EQ(houdini_text(kHoudini, 4, seed), test::derived_text(cpfg, 4, seed));
}

TEST(DialectHoudini, ConditionsEndAtTheRulesEqualsSign) {
  const char* const kText = "premise: A(0)\nA(i) : i<=1 && i>=0=F(i)A(i+1)\nA(i):i==2=B(1e-1)\nA(i):i!=2=C\n";
  EXPECT_EQ(houdini_text(kText, 3), "F(0)F(1)B(0.1)");
}

TEST(DialectHoudini, TheGenerationsDoneAreCalledT) {
  EXPECT_EQ(houdini_text("Premise: A(t)\nA(x)=B(t)A(t+1)\n", 3), "B(0)B(1)B(2)A(3)");
}

TEST(DialectHoudini, ContextsMatchAndIgnoredSymbolsAreLookedOver) {
  EXPECT_EQ(houdini_text("Premise: B+AA\nContext Ignore: +-\nB<A=B\nB=A\n", 1), "A+BA");
  EXPECT_EQ(houdini_text("Premise: ABC\nA<B>C=D\n", 1), "ADC");
}

TEST(DialectHoudini, SymbolsOfTheLanguageOfCpfgAreSymbols) {
  EXPECT_EQ(houdini_text("Premise: \"(0.9)*~(10)F;@?_!'#\nF=F\"\n", 1), "\"(0.9)*~(10)F\";@?_!'#");
}

TEST(DialectHoudini, TheNodesValuesAreRead) {
  const LSystem system = houdini("Generations: 2\nRandom Seed: 7\nStep Size: 2 # metres\nThickness = 0.5\nPremise: F\nF=FF\n");
  const auto string = derive(system, {}, {});
  EXPECT_EQ(string->seed, 7u);
  const Turtled turtled = interpret(*string, system, {}, {}).value();
  EXPECT_DOUBLE_EQ(turtled.total_length, 8);
  EXPECT_DOUBLE_EQ(turtled.last_width, 0.5);
}

using test::expect_error;
using test::Mistake;

TEST(DialectHoudini, MistakesAreRefusedWhereTheyStand) {
  const Mistake mistakes[] = {
      {"", 1, 1, "the end of the file", "'Premise:'"},
      {"A=B\n", 2, 1, "the end of the file", "'Premise:'"},
      {"Premise: A\nPremise: B\n", 2, 1, "a second premise", "one"},
      {"Premise: A=B\n", 1, 11, "'='", "a symbol"},
      {"Premise: A:B\n", 1, 11, "':'", "a symbol or the end of the line"},
      {"Premise: A[B\n", 1, 11, "'['", "']'"},
      {"Premise: A]\n", 1, 11, "']'", "'['"},
      {"Premise: 3\n", 1, 10, "'3'", "a symbol"},
      {"Premise: A(1\n", 1, 11, "'('", "')'"},
      {"Premise: A(1 2)\n", 1, 14, "'2'", "')' or ','"},
      {"Premise: A()\n", 1, 12, "')'", "an expression"},
      {"Premise: A(rand(1))\n", 1, 12, "'rand(', a function of HScript", "a function of numbers"},
      {"Premise: A(ch(\"x\"))\n", 1, 12, "'ch('", "a function of numbers"},
      {"Premise: A($F)\n", 1, 12, "'$'", "HScript is out of reach"},
      {"Premise: A(`x`)\n", 1, 12, "'`'", "HScript is out of reach"},
      {"Premise: A(x)\n", 1, 12, "'x'", "what the turtle knows is out of reach"},
      {"Premise: A(sin(1,2))\n", 1, 12, "'sin' with 2 arguments", "1"},
      {"Premise: A(1+)\n", 1, 14, "')'", "an expression"},
      {"Premise: A\nA B\n", 2, 4, "the end of the line", "'=' of a rule"},
      {"Premise: A\nA:x>3=B\n", 2, 3, "'x'", "a parameter of the rule"},
      {"Premise: A\nA(x):x>3\n", 2, 9, "the end of the line", "'=' of a rule"},
      {"Premise: A\nA:=B\n", 2, 3, "'='", "an expression"},
      {"Premise: A\n=B\n", 2, 1, "'='", "a rule"},
      {"Premise: A\nA=B:\n", 2, 5, "the end of the line", "an expression"},
      {"Premise: A\nA=B:0.5:1\n", 2, 8, "':'", "the end of the line"},
      {"Premise: A\nA(1)=B\n", 2, 3, "'1'", "the name of a parameter"},
      {"Premise: A\nA(x,x)=B\n", 2, 5, "'x' twice", "different names"},
      {"Premise: A\nA(x=B\n", 2, 4, "'='", "')' or ','"},
      {"Premise: A\nA<B<C=D\n", 2, 4, "'<'", "'>'"},
      {"Premise: A\n<B=D\n", 2, 1, "'<'", "a left context"},
      {"Premise: A\nRule 1: A=3\n", 2, 11, "'3'", "a symbol"},
      {"Premise: A\nRule 1 A=B\n", 2, 6, "'1'", "a symbol"},
      {"Premise: A\nAngle: x\n", 2, 8, "'x'", "a parameter of the rule, or b, c, d or t"},
      {"Premise: A\nAngle:\n", 2, 7, "the end of the line", "an expression"},
      {"Premise: A\nStep Size: 1 2\n", 2, 14, "'2'", "the end of the line"},
      {"Premise: A\nGenerations: 2.5\n", 2, 14, "2.5", "a whole number"},
      {"Premise: A\nvar x 3\n", 2, 5, "'x'", "the variable b, c or d"},
      {"Premise: A\nvar b\n", 2, 6, "the end of the line", "an expression"},
      {"Premise: A\nContext Ignore: 3\n", 2, 17, "'3'", "a symbol"},
      {"Premise: \303\244\n", 1, 10, "byte 0xc3", "a symbol"},
  };
  for (const Mistake& mistake : mistakes) {
    try {
      const LSystem system = houdini(mistake.text);
      ADD_FAILURE() << mistake.text << "\nis read as " << to_text(test::derived(system, 0));
    } catch (const InputError& error) {
      expect_error(error, mistake, "test.l");
    }
  }
}

}  // namespace
}  // namespace cambium
