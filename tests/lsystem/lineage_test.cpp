#include "lsystem/lineage.h"

#include <gtest/gtest.h>

#include <set>

#include "grammar.h"

namespace cambium {
namespace {

using test::derived;
using test::derived_text;
using test::grammar;
using test::parsed;

TEST(Lineage, SlotsDependOnTheNameAndItsOccurrenceAlone) {
  const Modules first = derived(parsed(grammar("P", "P --> A[B]A")), 1);
  const Modules second = derived(parsed(grammar("P", "P --> XA(3)[YB]!A")), 1);
  EXPECT_EQ(first.key[0], second.key[1]);  // the first A
  EXPECT_EQ(first.key[2], second.key[4]);  // B
  EXPECT_EQ(first.key[4], second.key[7]);  // the second A
  EXPECT_NE(first.key[0], first.key[4]);
}

TEST(Lineage, KeysInAStringAreAllDifferent) {
  const ModuleString string = derived(parsed(grammar("A(9)", "A(n) : n > 0 --> F(1)[+A(n-1)]A(n-1)\nF(x) --> F(x)F(x)")), 9);
  EXPECT_EQ(std::set<std::uint64_t>(string.key.begin(), string.key.end()).size(), string.size());
}

// What the trunk T bears: the branches B draw their own lengths.
const std::string kTrunk = "T(n) : n > 0 --> F(1)[+(ran(90))B(3)]T(n-1)\n";
const std::string kBranch = "B(n) : n > 0 --> f(ran(1))B(n-1)\n";

std::string branches(const std::string& productions, int steps) {
  const ModuleString string = derived(parsed(grammar("T(6)", productions)), steps, 77);
  std::string out;
  for (std::size_t i = 0; i < string.size(); ++i)
    if (string.names[string.symbol[i]] == "f" || string.names[string.symbol[i]] == "+")
      out += std::to_string(string.parameters[string.first[i]]) + " ";
  return out;
}

TEST(Lineage, EditingOneRuleLeavesOtherBranchesAlone) {
  const std::string before = branches(kTrunk + kBranch, 10);
  // Other modules in the trunk's successor; draws of what no branch descends from.
  EXPECT_EQ(branches("T(n) : n > 0 --> !(0.1)F(1)LL[@v+(ran(90))B(3)]/(137)T(n-1)\n" + kBranch, 10), before);
  EXPECT_EQ(branches(kTrunk + kBranch + "F(x) : ran(1) < 0.5 --> F(x)F(ran(2))L(ran(1))\n", 10), before);
  // Grown on for longer, the draws of what was there are the same.
  EXPECT_EQ(branches(kTrunk + kBranch, 14), before);
}

TEST(Lineage, ADrawInTheRuleOfABranchChangesThatRulesBranchesOnly) {
  const std::string trunk = "T(n) : n > 0 --> F(1)[+A(3)][-B(3)]T(n-1)\nA(n) : n > 0 --> f(ran(1))A(n-1)\n";
  const std::string before = derived_text(grammar("T(4)", trunk + "B(n) : n > 0 --> g(ran(1))B(n-1)"), 8, 5);
  const std::string after = derived_text(grammar("T(4)", trunk + "B(n) : n > 0 --> g(ran(1)+ran(1))HB(n-1)"), 8, 5);
  const auto lengths = [](const std::string& text) {
    std::string out;
    for (std::size_t at = text.find("f("); at != std::string::npos; at = text.find("f(", at + 1))
      out += text.substr(at, text.find(')', at) - at);
    return out;
  };
  EXPECT_NE(before, after);
  EXPECT_EQ(lengths(before), lengths(after));
}

TEST(Lineage, ACutBranchTakesNothingFromItsNeighbours) {
  const std::string grown = derived_text(grammar("A[B]C", "A --> F(ran(1))A\nC --> G(ran(1))C"), 3, 8);
  const std::string cut = derived_text(grammar("A[%B]C", "A --> F(ran(1))A\nC --> G(ran(1))C"), 3, 8);
  EXPECT_EQ(grown.substr(grown.find(']')), cut.substr(cut.find(']')));
}

}  // namespace
}  // namespace cambium
