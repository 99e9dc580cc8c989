#include <gtest/gtest.h>

#include <atomic>

#include "grammar.h"

namespace cambium {
namespace {

using test::derived;
using test::derived_text;
using test::grammar;
using test::parsed;

TEST(Derive, OptionsOverrideTheFilesSeedAndLength) {
  const LSystem system = parsed(grammar("A", "A --> AA", "seed: 5\nderivation length: 3"));
  EXPECT_EQ(derive(system, {}, {})->size(), 8u);
  EXPECT_EQ(derive(system, {}, {})->seed, 5u);
  DeriveOptions options;
  options.steps = 1;
  options.seed = 6;
  EXPECT_EQ(derive(system, options, {})->size(), 2u);
  EXPECT_EQ(derive(system, options, {})->seed, 6u);
}

TEST(Derive, AMissingDerivationLengthIsAnError) {
  EXPECT_THROW(derive(parsed(grammar("A", "A --> AA")), {}, {}), InputError);
}

TEST(Derive, TooManyModulesAreAnErrorAtTheProduction) {
  DeriveOptions options;
  options.steps = 1000;
  options.max_modules = 10000;
  try {
    derive(parsed(grammar("A", "A --> AA")), options, {});
    FAIL();
  } catch (const InputError& error) {
    EXPECT_EQ(error.location().line, 4);
    EXPECT_EQ(error.location().column, 1);
  }
}

TEST(Derive, StopsWhenCancelled) {
  std::atomic<bool> cancel{true};
  RunOptions run;
  run.cancel = &cancel;
  DeriveOptions options;
  options.steps = 30;
  EXPECT_FALSE(derive(parsed(grammar("A", "A --> AA")), options, run));
  cancel = false;
  // From inside: progress is called after each step.
  int calls = 0;
  run.progress = [&](std::string_view, double) { cancel = ++calls == 3; };
  EXPECT_FALSE(derive(parsed(grammar("A", "A --> AA")), options, run));
  EXPECT_EQ(calls, 3);
}

TEST(Derive, ADeepChainOfBranchesNeedsNoCallStack) {
  const LSystem system = parsed(grammar("A(0)",
                                        "A(n) : n < 18 --> A(n+1)A(n+1)\nA(n) : n == 18 --> [F"
                                        "]F"));
  const ModuleString string = derived(system, 19);
  const Turtled turtled = interpret(string, system, {}, {}).value();
  EXPECT_EQ(turtled.skeleton.nodes.size(), (std::size_t{1} << 19) + 1);
  EXPECT_EQ(turtled.skeleton.nodes.back().position.z, 262144);
}

TEST(Derive, QueriesAreAnsweredByTheTurtleBeforeEveryStep) {
  // Grows until it is 3 high, and then turns.
  const std::string text = grammar("A?P(0,0,0)", "A > ?P(x,y,z) : z < 3 --> FA\nA > ?P(x,y,z) --> +(90)FA");
  EXPECT_EQ(derived_text(text, 2), "FFA?P(0,0,2)");
  EXPECT_EQ(derived_text(text, 5), "FFF+(90)F+(90)FA?P(-1,0,2)");
  const ModuleString frame =
      derived(parsed(grammar("&(90)?H(0,0,0)?U(0,0,0)?L(0,0,0)?Q(0,0,0)?P(1)", "A --> A\nhomomorphism\n& --> +F")), 1);
  const double expected[] = {90, 0, 1, 0, 0, 0, -1, -1, 0, 0, 0, 0, 0, 1};
  for (std::size_t i = 0; i < 14; ++i) EXPECT_NEAR(frame.parameters[i], expected[i], 1e-12) << i;
}

TEST(Derive, ParametersAreLimitedAsModulesAre) {
  DeriveOptions options;
  options.steps = 30;
  options.max_modules = 200'000;
  const LSystem system = parsed(grammar("A", "A --> B(1,2,3,4,5,6,7,8,9,10,11,12,13,14,15,16,17,18,19,20)AA"));
  try {
    derive(system, options, {});
    FAIL();
  } catch (const InputError& error) {
    EXPECT_NE(error.found().find("1600000 parameters"), std::string::npos) << error.what();
  }
}

TEST(Derive, SrandMakesDrawsIndependentOfTheSeed) {
  const std::string text = grammar("A", "A : {srand(7);} * --> F(ran(1))");
  EXPECT_EQ(derived_text(text, 1, 1), derived_text(text, 1, 2));
}

}  // namespace
}  // namespace cambium
