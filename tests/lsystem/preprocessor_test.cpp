#include "lsystem/preprocessor.h"

#include <gtest/gtest.h>

namespace cambium {
namespace {

std::string expanded(const std::string& text) {
  std::string out = preprocess(text, "test.l").text;
  while (!out.empty() && out.back() == '\n') out.pop_back();
  return out;
}

TEST(Preprocessor, CommentsBecomeASpaceAndSplicesVanish) {
  EXPECT_EQ(expanded("a/* b\n c */d // e\nf\\\ng"), "a d \nfg");
  EXPECT_EQ(expanded("\"/* text */\""), "\"/* text */\"");
}

TEST(Preprocessor, ConditionsKeepOneBranch) {
  EXPECT_EQ(expanded("#define N 2\n#if N > 1 && defined(N)\na\n#else\nb\n#endif"), "a");
  EXPECT_EQ(expanded("#ifdef N\na\n#elif M\nb\n#else\nc\n#endif"), "c");
  EXPECT_EQ(expanded("#ifndef N\na\n#if 0\nb\n#endif\n#endif"), "a");
  EXPECT_EQ(expanded("#if 0\n#if 1/0\n#endif\n#error no\n#endif\nx"), "x");
  EXPECT_EQ(expanded("#define N\n#undef N\n#ifdef N\na\n#endif\nb"), "b");
}

TEST(Preprocessor, AHashThatBeginsNoDirectiveIsATurtleSymbol) { EXPECT_EQ(expanded("#(2)F\n# F"), "#(2)F\n# F"); }

TEST(Preprocessor, DirectivesThatConcernOnlyCAreSkipped) { EXPECT_EQ(expanded("#pragma once\n#line 3 \"x\"\n#warning no\nF"), "F"); }

TEST(Preprocessor, EveryCharacterKnowsItsPlace) {
  const SourceText source = preprocess("/* one\ntwo */ #\n#define X ab\nq X\n", "test.l");
  const std::size_t q = source.text.find('q');
  EXPECT_EQ(source.places[q].line, 4u);
  EXPECT_EQ(source.places[q].column, 1u);
  const std::size_t b = source.text.find('b');
  EXPECT_EQ(source.places[b].line, 4u);
  EXPECT_EQ(source.places[b].column, 3u);
}

}  // namespace
}  // namespace cambium
