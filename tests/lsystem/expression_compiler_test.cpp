#include "lsystem/expression_compiler.h"

#include <gtest/gtest.h>

namespace cambium {
namespace {

SourceText source_of(const std::string& text) {
  SourceText source;
  for (std::size_t i = 0; i < text.size(); ++i) source.append(text[i], {1, static_cast<std::uint32_t>(i + 1), 0});
  source.files = {"test.l"};
  return source;
}

double value_of(const std::string& text) {
  const SourceText source = source_of(text);
  Cursor cursor(source);
  Scope scope;
  Code code;
  ExpressionCompiler(cursor, scope, code).expression();
  cursor.skip_space();
  if (!cursor.at_end()) cursor.fail("the end");
  return constant_value(code, {source.files, {}, {}});
}

// With a parameter x.
double value_of(const std::string& text, double x) {
  const SourceText source = source_of(text);
  Cursor cursor(source);
  Scope scope;
  scope.locals = {{"x", 0}};
  Code code;
  ExpressionCompiler(cursor, scope, code).expression();
  const CodeTables tables{source.files, {}, {}};
  CounterRandom random(0);
  std::vector<double> globals;
  return Machine(tables, random, globals).value(code, &x);
}

TEST(ExpressionCompiler, PrecedenceIsThatOfCpfg) {
  EXPECT_EQ(value_of("1+2*3-4/2"), 5);
  EXPECT_EQ(value_of("(1+2)*3"), 9);
  EXPECT_EQ(value_of("10-3-2"), 5);
  EXPECT_EQ(value_of("2^3^2"), 64);   // from the left, as cpfg's grammar has it
  EXPECT_EQ(value_of("-2^2"), 4);     // and its signs bind tighter
  EXPECT_EQ(value_of("2*3^2"), 18);
  EXPECT_EQ(value_of("2^-1"), 0.5);
  EXPECT_EQ(value_of("1 <> 2"), 1);
  EXPECT_EQ(value_of("7%4+1"), 4);
  EXPECT_EQ(value_of("1 < 2 == 1 && !0 || 0"), 1);
  EXPECT_EQ(value_of("1+1 >= 2 && 3 != 4"), 1);
  EXPECT_EQ(value_of("0 && 1/0"), 0);
  EXPECT_EQ(value_of("5 || 1/0"), 1);
  EXPECT_EQ(value_of(".5e1 - -1"), 6);
}

TEST(ExpressionCompiler, FunctionsTakeDegrees) {
  EXPECT_NEAR(value_of("sin(30)"), 0.5, 1e-15);
  EXPECT_NEAR(value_of("acos(0)"), 90, 1e-12);
  EXPECT_NEAR(value_of("atan2(1,-1)"), 135, 1e-12);
  EXPECT_EQ(value_of("floor(-1.5)+ceil(1.5)+trunc(-1.5)"), -1);
  EXPECT_EQ(value_of("min(1,2)+max(1,2)*sign(-3)+fabs(-4)"), 3);
  EXPECT_NEAR(value_of("exp(log(2))*sqrt(4)"), 4, 1e-15);
}

TEST(ExpressionCompiler, AChoiceEvaluatesOneSide) {
  EXPECT_EQ(value_of("1 ? 2 : 3"), 2);
  EXPECT_EQ(value_of("0 ? 1/0 : 3"), 3);
  EXPECT_EQ(value_of("0 ? 1 : 0 ? 2 : 3"), 3);
  EXPECT_EQ(value_of("(0 ? 1 : 2) + 3"), 5);
  EXPECT_EQ(value_of("(x > 1 ? 1 : 2) + 3", 5), 4);
}

TEST(ExpressionCompiler, ConstantsAreWorkedOutOnce) {
  const auto instructions = [](const std::string& text) {
    const SourceText source = source_of(text);
    Cursor cursor(source);
    Scope scope;
    scope.locals = {{"x", 0}};
    Code code;
    ExpressionCompiler(cursor, scope, code).expression();
    return code.instructions.size();
  };
  EXPECT_EQ(instructions("(0.3*(1-0.3))^0.5"), 1u);
  EXPECT_EQ(instructions("x*sqrt(2)"), 3u);
  EXPECT_EQ(instructions("ran(1)"), 2u);       // drawn each time
  EXPECT_EQ(instructions("1/0"), 3u);          // fails when it is needed
  EXPECT_EQ(value_of("(x && 3) + 2 * 5", 1), 11);
}

TEST(ExpressionCompiler, DeepNestingIsAnErrorNotACrash) {
  EXPECT_THROW(value_of(std::string(100000, '(') + "1" + std::string(100000, ')')), InputError);
  EXPECT_THROW(value_of(std::string(100000, '-') + "1"), InputError);
  std::string sum = "1";
  for (int i = 0; i < 100000; ++i) sum += "+1";
  EXPECT_EQ(value_of(sum), 100001);
}

}  // namespace
}  // namespace cambium
