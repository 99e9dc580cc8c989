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
  CounterRandom random(0);
  const std::vector<ArrayInfo> arrays;
  return Machine(source.files, arrays, random).value(code, nullptr);
}

// Runs a block and gives the value of its variable `r`.
double result_of(const std::string& text) {
  const SourceText source = source_of(text);
  Cursor cursor(source);
  Scope scope;
  Code code;
  ExpressionCompiler(cursor, scope, code).block();
  CounterRandom random(0);
  const std::vector<ArrayInfo> arrays;
  std::vector<double> locals(scope.locals.size() + 1, 0.0);
  Machine(source.files, arrays, random).run(code, locals.data());
  return locals[scope.locals.at("r")];
}

TEST(ExpressionCompiler, PrecedenceIsThatOfCAndPowerBindsTightest) {
  EXPECT_EQ(value_of("1+2*3-4/2"), 5);
  EXPECT_EQ(value_of("(1+2)*3"), 9);
  EXPECT_EQ(value_of("10-3-2"), 5);
  EXPECT_EQ(value_of("2^3^2"), 512);
  EXPECT_EQ(value_of("-2^2"), -4);
  EXPECT_EQ(value_of("2^-1"), 0.5);
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

TEST(ExpressionCompiler, StatementsRunAsInC) {
  EXPECT_EQ(result_of("{ r = 1; if (r > 2) r = 5; else { r = 7; r += 1; } }"), 8);
  EXPECT_EQ(result_of("{ r = 0; i = 0; while (i < 5) { r = r + i; i += 1; } }"), 10);
  EXPECT_EQ(result_of("{ r = 1; for (i = 0; i < 10; i = i + 1) r *= 2; printf(\"%g\\n\", r); }"), 1024);
}

TEST(ExpressionCompiler, DeepNestingIsAnErrorNotACrash) {
  EXPECT_THROW(value_of(std::string(100000, '(') + "1" + std::string(100000, ')')), InputError);
  EXPECT_THROW(value_of(std::string(100000, '-') + "1"), InputError);
  EXPECT_THROW(result_of(std::string(100000, '{')), InputError);
  std::string sum = "1";
  for (int i = 0; i < 100000; ++i) sum += "+1";
  EXPECT_EQ(value_of(sum), 100001);
}

}  // namespace
}  // namespace cambium
