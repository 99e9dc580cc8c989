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

}  // namespace
}  // namespace cambium
