#include "grammar.h"

#include <gtest/gtest.h>

namespace cambium {
namespace {

TEST(ModuleParser, SymbolsOfTwoAndThreeCharactersAreRead) {
  const ModuleString string =
      test::derived(test::parsed(test::grammar("@Gs@G@Tx(2)@Tz@Ts(1)?P?H~l~k(2)@v@#(1)@!@M(1,2,3)1 2a?", "")), 0);
  std::vector<std::string> names;
  for (const std::uint16_t symbol : string.symbol) names.push_back(string.names[symbol]);
  const std::vector<std::string> expected = {"@Gs", "@G", "@Tx", "@T", "z", "@Ts", "?P", "?H", "~l",
                                             "~k",  "@v", "@#",  "@!", "@M", "1",  "2",  "a",  "?"};
  EXPECT_EQ(names, expected);
}

TEST(ModuleParser, EverySymbolCanBeAPredecessor) {
  EXPECT_EQ(test::derived_text(test::grammar("+!(2)#(1)@O(3)", "+ --> -\n!(w) --> !(w/2)\n#(w) --> *\n@O(r) --> ~s(r)"), 1),
            "-!(1)~s(3)");
}

TEST(ModuleParser, AProductionMayPutItsArrowOnTheNextLine) {
  EXPECT_EQ(test::derived_text(test::grammar("A(2)", "A(x)\n : x > 1\n  --> B(x)\n"), 1), "B(2)");
}

TEST(ModuleParser, BlanksBetweenModulesMeanNothing) {
  EXPECT_EQ(test::derived_text(test::grammar("A", "A-->F (1) [ + F ] ^ ( 2 ) F : 3"), 1), "F(1)[+F]^(2)F");
}

}  // namespace
}  // namespace cambium
