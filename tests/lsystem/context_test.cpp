#include "lsystem/context.h"

#include <gtest/gtest.h>

#include <atomic>

#include "grammar.h"

namespace cambium {
namespace {

using test::derived;
using test::derived_text;
using test::grammar;
using test::parsed;

TEST(BracketPairs, UnmatchedBracketsHaveNoPartner) {
  // An axiom has to be balanced; productions can still delete one side.
  const ModuleString string = derived(parsed(grammar("A[BC[D]]E", "A --> A\nB --> *")), 1);
  BracketPairs pairs;
  ASSERT_TRUE(pairs.link(string, 0, 1, {}));
  EXPECT_EQ(pairs.partner(1), 6u);
  EXPECT_EQ(pairs.partner(3), 5u);
  std::atomic<bool> cancel{true};
  RunOptions run;
  run.cancel = &cancel;
  EXPECT_FALSE(pairs.link(string, 0, 1, run));
}

TEST(ContextMatcher, LeftContextsFollowTheAxisTowardsTheRoot) {
  EXPECT_EQ(derived_text(grammar("BC[+A]A", "B < A --> X", "ignore: +C"), 1), "BC[+X]X");
  EXPECT_EQ(derived_text(grammar("B[A]A", "A < A --> X"), 1), "B[A]A");
  EXPECT_EQ(derived_text(grammar("B[C[D]E]A", "B < A --> X"), 1), "B[C[D]E]X");
  EXPECT_EQ(derived_text(grammar("BCDA", "B C D < A --> X\nC < D --> Y"), 1), "BCYX");
}

TEST(ContextMatcher, RightContextsFollowTheAxisAwayFromTheRoot) {
  EXPECT_EQ(derived_text(grammar("A[C]+B", "A > B --> X", "ignore: +"), 1), "X[C]+B");
  EXPECT_EQ(derived_text(grammar("A[C]+B", "A > B --> X"), 1), "A[C]+B");
  EXPECT_EQ(derived_text(grammar("[A]B", "A > B --> X"), 1), "[A]B");
}

TEST(ContextMatcher, ABracketInAContextIsTheBracketThatStandsThere) {
  EXPECT_EQ(derived_text(grammar("A[B]D", "A > [B]D --> X"), 1), "X[B]D");
  EXPECT_EQ(derived_text(grammar("A[BC]D", "A > [B]D --> X"), 1), "A[BC]D");  // the branch goes on
  EXPECT_EQ(derived_text(grammar("A[B[C]]D", "A > [B]D --> X"), 1), "X[B[C]]D");
  EXPECT_EQ(derived_text(grammar("A[C][B]D", "A > [B]D --> X"), 1), "A[C][B]D");
  EXPECT_EQ(derived_text(grammar("A[C][B]D", "A > [C][B]D --> X"), 1), "X[C][B]D");
}

TEST(ContextMatcher, AnEqualsSignIsTheRestOfTheBranch) {
  EXPECT_EQ(derived_text(grammar("A[BC[E]F]D", "A > [B=]D --> X"), 1), "X[BC[E]F]D");
  EXPECT_EQ(derived_text(grammar("I(0)[I(1)K][I(2)K]I(3)", "I(a) > [I(b)=][I(c)=]I(d) --> I(b+c+d)"), 1),
            "I(6)[I(1)K][I(2)K]I(3)");
}

TEST(ContextMatcher, ConsideredSymbolsAreSeenAndAllOthersSkipped) {
  EXPECT_EQ(derived_text(grammar("A[C]+B", "A > B --> X", "consider: AB[]"), 1), "X[C]+B");
  EXPECT_EQ(derived_text(grammar("A[B]C", "A > B --> X", "consider: AB[]"), 1), "A[B]C");
  EXPECT_EQ(derived_text(grammar("A[B]C", "A > B --> X", "consider: AB"), 1), "X[B]C");  // brackets are not considered here
  EXPECT_EQ(derived_text(grammar("A~l(1)@Gc;(2)B", "A > B --> X", "ignore: ~@;"), 1), "X~l(1)@Gc;(2)B");
}

TEST(ContextMatcher, ParametersOfContextsAreBound) {
  EXPECT_EQ(derived_text(grammar("A(1)B(2)C(3)D(4)", "A(a) B(b) < C(c) > D(d) --> X(a,b,c,d)"), 1),
            "A(1)B(2)X(1,2,3,4)D(4)");
  EXPECT_EQ(derived_text(grammar("A(1)C(3)", "A(a,b) < C(c) --> X"), 1), "A(1)C(3)");
}

TEST(ContextMatcher, ARingsEndsMeet) {
  const std::string turning = grammar("ABBB", "A < B --> A\nA --> B", "ring lsystem\n");
  EXPECT_EQ(derived_text(turning, 1), "BABB");
  EXPECT_EQ(derived_text(turning, 4), "ABBB");
  EXPECT_EQ(derived_text(grammar("ABBB", "B > A --> A\nA --> B", "ring L-system: 1"), 1), "BBBA");
  EXPECT_EQ(derived_text(grammar("ABBB", "B > A --> A\nA --> B", "ring lsystem: 0"), 1), "BBBB");
  EXPECT_EQ(derived_text(grammar("C", "D < C > D --> X", "ring lsystem"), 1), "C");  // once around, and no further
}

}  // namespace
}  // namespace cambium
