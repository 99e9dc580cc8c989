#include "lsystem/array_definitions.h"

#include <gtest/gtest.h>

#include "grammar.h"

namespace cambium {
namespace {

using test::derived_text;
using test::error_of;
using test::grammar;

TEST(ArrayDefinitions, SizesAndValuesAreConstantExpressions) {
  const std::string text =
      "#define M 4\n" + grammar("A", "A --> B(a[2],b[1][0],b[0,1],c[3])",
                                "define: {\n array a[M-1] = {1, -2, 2*3};\n array b[2][2] = {{1,2},{3,4}},\n c[M];\n}");
  EXPECT_EQ(derived_text(text, 1), "B(6,3,2,0)");
}

TEST(ArrayDefinitions, ExternalNamesAreThoseOfAnEarlierLSystem) {
  const std::string text =
      "lsystem: 1\nderivation length: 2\ndefine: { array a[2] = {5,6}; }\nStart: { n = 7; }\naxiom: ?(2)B$\nendlsystem\n"
      "lsystem: 2\ndefine: { external n, a[2]; }\naxiom: B\nB --> C(n,a[1])\nendlsystem\n";
  EXPECT_EQ(derived_text(text, 1), "?(2)C(7,6)$");
}

TEST(ArrayDefinitions, NamesOfOneLSystemAreNotAnothers) {
  const std::string first = "lsystem: 1\nStart: { n = 7; }\naxiom: A\nendlsystem\n";
  const auto error = error_of(first + "lsystem: 2\naxiom: B\nB --> C(n)\nendlsystem\n");
  ASSERT_TRUE(error);
  EXPECT_EQ(error->location().line, 7);
  EXPECT_TRUE(error_of(first + "lsystem: 2\ndefine: { external m; }\naxiom: B\nendlsystem\n"));
  EXPECT_EQ(derived_text(first + "lsystem: 2\nStart: { n = 1; }\naxiom: B\nB --> C(n)\nendlsystem\n", 1), "A");
}

}  // namespace
}  // namespace cambium
