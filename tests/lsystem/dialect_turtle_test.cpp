// What the commands of other turtles are to cpfg's: by where they lead.
#include "lsystem/dialect_turtle.h"

#include <gtest/gtest.h>

#include "grammar.h"
#include "lsystem/drawn_form.h"

namespace cambium {
namespace {

std::string in_cpfg(const std::string& text, Dialect dialect, const TurtleOptions& options = {}) {
  const LSystem system = LSystem::parse(text, "test.l", std::nullopt, dialect);
  return to_text(drawn_form(test::derived(system, 0), system.program(), options, {}).value());
}

std::string from_lpy(const std::string& axiom) { return in_cpfg("Axiom: " + axiom + "\nendlsystem\n", Dialect::kLpy); }
std::string from_houdini(const std::string& premise) { return in_cpfg(premise, Dialect::kHoudini); }

TEST(DialectTurtle, LpyRollsTheOtherWayRound) {
  EXPECT_EQ(from_lpy("/(10)\\(20)RollL(30)"), "\\(10)/(20)\\(30)");
  EXPECT_EQ(from_lpy("+(1)-(2)&(3)^(4)|"), "+(1)-(2)&(3)^(4)|");
}

TEST(DialectTurtle, LpyWidthsAreRadii) {
  EXPECT_EQ(from_lpy("_(2)!(3)SetWidth(4)_!@O(1)"), "#(4)!(6)!(8)#!@O(2)");
  EXPECT_EQ(from_lpy("F(3,2)F(3,0)"), "!(4)F(3)F(3)");
}

TEST(DialectTurtle, LpyTurnsSixtyDegreesUnlessTold) {
  EXPECT_EQ(from_lpy("+F"), "+(60)F(1)");
  EXPECT_EQ(in_cpfg("Axiom: +\nendlsystem\n", Dialect::kLpy, {.angle = 0.5235987755982988}), "+(30)");
}

TEST(DialectTurtle, LpyScalesEndWithTheirBranch) { EXPECT_EQ(from_lpy("@D(2)F[@Dd(4)F]F@Di(3)f(1)"), "F(2)[F(0.5)]F(2)f(6)"); }

TEST(DialectTurtle, LettersWithoutAMeaningGetNone) {
  EXPECT_EQ(from_lpy("GgA"), "A");
  EXPECT_EQ(from_houdini("Premise: gA"), "!(0.05)A");
}

TEST(DialectTurtle, HoudiniTurnsTheOtherWayRound) {
  EXPECT_EQ(from_houdini("Premise: +(1)-(2)&(3)^(4)\\(5)/(6)*|"), "!(0.05)-(1)+(2)^(3)&(4)/(5)\\(6)/(180)|");
}

TEST(DialectTurtle, HoudiniScalesLengthsAnglesAndWidthsUpToTheEndOfABranch) {
  EXPECT_EQ(from_houdini("Premise: F[\"(0.5)F_F]F;+@+!(0.5)F?F"),
            "!(0.05)F(0.1)[F(0.05)F(0.0555555556)]F(0.1)-(19.6)-(28)!(0.025)F(0.1)!(0.03125)F(0.1)");
}

TEST(DialectTurtle, HoudiniHalvesAndWidthsOfOneInternode) {
  EXPECT_EQ(from_houdini("Premise: H h(4) F(2,0.5)G(1)"), "!(0.05)F(0.05)f(2)!(0.5)F(2)!(0.05)G(1)");
}

TEST(DialectTurtle, HoudinisGravityBendsOneInternode) {
  EXPECT_EQ(from_houdini("Gravity: 3\nPremise: TFT(2)FF"), "!(0.05)@Ts(3)F(0.1)@Ts(0)@Ts(2)F(0.1)@Ts(0)F(0.1)");
}

TEST(DialectTurtle, HoudinisRandomTurnsAreWithinBoundsAndOfTheSeed) {
  const LSystem system = LSystem::parse("Premise: ~(10)~(10)", "test.l", std::nullopt, Dialect::kHoudini);
  const auto turns = [&](std::uint64_t seed) {
    return drawn_form(test::derived(system, 0, seed), system.program(), {}, {}).value().parameters;
  };
  const std::vector<double> one = turns(1);
  ASSERT_EQ(one.size(), 7u);   // the width, and three turns each
  for (std::size_t i = 1; i < 7; ++i) EXPECT_LE(std::abs(one[i]), 10);
  EXPECT_NE(one[1], one[4]);
  EXPECT_EQ(one, turns(1));
  EXPECT_NE(one, turns(2));
}

TEST(DialectTurtle, QueriesOfLpyAreAnswered) {
  const LSystem system = LSystem::parse("Axiom: F(2)?P(0,0,0)\nendlsystem\n", "test.lpy", std::nullopt, Dialect::kLpy);
  EXPECT_EQ(to_text(test::derived(system, 0)), "F(2)?P(0,0,2)");
}

}  // namespace
}  // namespace cambium
