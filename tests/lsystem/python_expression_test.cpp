#include "lsystem/python_expression.h"

#include <gtest/gtest.h>

namespace cambium {
namespace {

double value(const std::string& expression, bool math = false) {
  const SourceText source = as_it_stands(expression + "\n", "test.lpy");
  Cursor in(source);
  PythonNames names;
  names.math = math;
  return constant_of(python_expression(in, names), source);
}

TEST(PythonExpression, PrecedenceIsPythons) {
  EXPECT_EQ(value("-2**2"), -4);
  EXPECT_EQ(value("2**3**2"), 512);
  EXPECT_EQ(value("2**-1"), 0.5);
  EXPECT_EQ(value("1 - 2 - 3"), -4);
  EXPECT_EQ(value("12 / 2 * 3"), 18);
  EXPECT_EQ(value("7 / 2"), 3.5);
  EXPECT_EQ(value("1 + 2 * 3"), 7);
  EXPECT_EQ(value("(1 + 2) * 3"), 9);
}

TEST(PythonExpression, QuotientsGoTowardsMinusInfinity) {
  EXPECT_EQ(value("-7 // 2"), -4);
  EXPECT_EQ(value("-7 % 3"), 2);
  EXPECT_EQ(value("7 % -3"), -2);
  EXPECT_EQ(value("7 % 3 * 2"), 2);
}

TEST(PythonExpression, ComparisonsChainBelowNot) {
  EXPECT_EQ(value("1 < 2 < 3"), 1);
  EXPECT_EQ(value("3 > 2 > 2"), 0);
  EXPECT_EQ(value("not 1 == 2"), 1);
  EXPECT_EQ(value("not 1 and 0 or 1"), 1);
  EXPECT_EQ(value("0 or 0 and 1"), 0);
  EXPECT_EQ(value("True and not False"), 1);
}

TEST(PythonExpression, TheConditionStandsInTheMiddle) {
  EXPECT_EQ(value("1 if 2 > 3 else 4 if 0 else 5"), 5);
  EXPECT_EQ(value("1 if 2 < 3 else 4"), 1);
}

TEST(PythonExpression, FunctionsOfMathTakeAndGiveRadians) {
  EXPECT_NEAR(value("sin(pi/6)", true), 0.5, 1e-15);
  EXPECT_NEAR(value("atan(1)*4", true), 3.14159265358979, 1e-14);
  EXPECT_NEAR(value("log(e**2)", true), 2, 1e-15);
  EXPECT_EQ(value("abs(-2) + int(-2.5) + min(1,2)"), 1);
}

TEST(PythonExpression, NestingAndLengthAreBounded) {
  EXPECT_THROW(value(std::string(200, '(') + "1" + std::string(200, ')')), InputError);
  EXPECT_THROW(value(std::string(200, '-') + "1"), InputError);
  std::string doubling = "5";
  for (int i = 0; i < 30; ++i) doubling = "(" + doubling + ")%7";
  EXPECT_THROW(value(doubling), InputError);
}

}  // namespace
}  // namespace cambium
