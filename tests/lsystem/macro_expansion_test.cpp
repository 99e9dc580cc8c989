#include "lsystem/preprocessor.h"

#include <gtest/gtest.h>

namespace cambium {
namespace {

std::string expanded(const std::string& text) {
  std::string out = preprocess(text, "test.l").text;
  while (!out.empty() && out.back() == '\n') out.pop_back();
  return out;
}

TEST(MacroExpansion, ObjectLikeMacrosReplaceWholeNamesOnly) {
  EXPECT_EQ(expanded("#define A 1\nA AB _A A(A) 1A"), "1 AB _A 1(1) 1A");
}

TEST(MacroExpansion, FunctionLikeMacrosTakeArguments) {
  EXPECT_EQ(expanded("#define MAX(a,b) ((a)>(b))\nMAX(f(1,2), MAX(x,y))"), "((f(1,2))>(((x)>(y))))");
  EXPECT_EQ(expanded("#define Z() 7\nZ() Z"), "7 Z");
  EXPECT_EQ(expanded("#define S(x) [x]\nS(\n 1\n)"), "[1]");
}

TEST(MacroExpansion, AMacroIsNotExpandedInsideItself) {
  EXPECT_EQ(expanded("#define A B\n#define B A\nA"), "A");
  EXPECT_EQ(expanded("#define A A+1\nA"), "A+1");
}

TEST(MacroExpansion, LinesKnowTheirNumber) {
  EXPECT_EQ(expanded("#define HERE __LINE__\n__LINE__ HERE"), "2 2");
  EXPECT_EQ(expanded("#define M(a) a __LINE__ a__LINE__\n\nM(__LINE__)"), "\n3 3 a__LINE__");
}

TEST(MacroExpansion, ExplosionsAreErrors) {
  std::string text = "#define A0 x\n";
  for (int i = 1; i <= 40; ++i) {
    const std::string before = "A" + std::to_string(i - 1);
    text += "#define A" + std::to_string(i) + " " + before + " " + before + "\n";
  }
  EXPECT_THROW(preprocess(text + "A40\n", "test.l"), InputError);
  std::string chain = "#define B0 x\n";
  for (int i = 1; i <= 1000; ++i) chain += "#define B" + std::to_string(i) + " B" + std::to_string(i - 1) + "\n";
  EXPECT_THROW(preprocess(chain + "B1000\n", "test.l"), InputError);
}

}  // namespace
}  // namespace cambium
