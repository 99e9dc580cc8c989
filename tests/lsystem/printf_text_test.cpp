#include "lsystem/printf_text.h"

#include <gtest/gtest.h>

namespace cambium {
namespace {

std::string text(const char* format, std::initializer_list<double> values) {
  return printf_text(format, values.begin(), values.size());
}

TEST(PrintfText, ConvertsNumbersAsCDoes) {
  EXPECT_EQ(text("a %g b\\n", {1.5}), "a 1.5 b\n");
  EXPECT_EQ(text("%5.2f|%-4d|%e", {3.14159, 7.9, 1000}), " 3.14|7   |1.000000e+03");
  EXPECT_EQ(text("%lf %ld %c", {0.5, -2, 65}), "0.500000 -2 A");
  EXPECT_EQ(text("100%% \\\"%x\\\"", {255}), "100% \"ff\"");
}

TEST(PrintfText, MissingValuesAreZeroAndOthersAreDropped) {
  EXPECT_EQ(text("%g,%g", {1}), "1,0");
  EXPECT_EQ(text("%g", {1, 2}), "1");
}

TEST(PrintfText, WhatIsNoConversionStays) {
  EXPECT_EQ(text("%s %", {1}), "%s %");
  EXPECT_EQ(text("%n%p", {1}), "%n%p");
  EXPECT_EQ(text("%99999999999d", {1}).size(), 127u);
}

}  // namespace
}  // namespace cambium
