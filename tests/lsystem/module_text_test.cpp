#include "grammar.h"

#include <gtest/gtest.h>

namespace cambium {
namespace {

TEST(ModuleText, WritesParametersWithNineDigits) {
  EXPECT_EQ(test::derived_text(test::grammar("F(1/3)+(-45)@Gs~l(2)[A(1e20,0.00001,123456789.4)]", ""), 0),
            "F(0.333333333)+(-45)@Gs~l(2)[A(1e+20,1e-05,123456789)]");
}

TEST(ModuleText, ReadsBackAsAnAxiom) {
  const std::string text = "A[&(30)!(0.25)F(1.5)]/(137.5)$F";
  EXPECT_EQ(test::derived_text(test::grammar(text, ""), 0), text);
}

TEST(ModuleText, AStepIsExplainedByTheRulesThatMadeIt) {
  const LSystem system = test::parsed(test::grammar("A(1)BC[D]A(2)", "A(x) : x < 2 --> F(x)A(x+1)\nB --> *\nD --> EE\ndecomposition\nE --> GH\nF(x) --> f(x)"));
  DeriveOptions options;
  options.steps = 1;
  EXPECT_EQ(to_text(explain_step(system, options, {}).value()),
            "test.l:9:1\tA(1)\tf(1)\n"
            "test.l:4:1\tA(1)\tA(2)\n"
            "-\tB\t*\n"
            "stays\tC\tC\n"
            "stays\t[\t[\n"
            "test.l:8:1\tD\tGHGH\n"
            "stays\t]\t]\n"
            "stays\tA(2)\tA(2)\n");
}

TEST(ModuleText, AnExplainedStepIsTheLastOfTheDerivation) {
  const LSystem system = test::parsed(test::grammar("A", "A --> A[B(ran(1))]A"));
  DeriveOptions options;
  options.steps = 6;
  const ExplainedStep step = explain_step(system, options, {}).value();
  EXPECT_EQ(to_text(step.after), to_text(derive(system, options, {}).value()));
  EXPECT_EQ(step.origins.size(), step.after.size());
  options.steps = 5;
  EXPECT_EQ(to_text(step.before), to_text(derive(system, options, {}).value()));
  options.steps = 0;
  EXPECT_THROW(explain_step(system, options, {}), InputError);
}

}  // namespace
}  // namespace cambium
