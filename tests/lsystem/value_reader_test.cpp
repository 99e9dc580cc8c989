#include "lsystem/value_reader.h"

#include <gtest/gtest.h>

#include "lsystem/preprocessor.h"

namespace cambium {
namespace {

using Layout = ValueReader::Layout;

TEST(ValueReader, ReadsNumbersWordsAndLabels) {
  const SourceText source = preprocess("Angle Factor : +1.5e1 l leaf.s\nX: 1,2 , 3 0 3 4", "t.v");
  ValueReader values(source, Layout::kLines);
  EXPECT_EQ(values.label(), "angle factor");
  EXPECT_EQ(values.number("a number"), 15);
  EXPECT_EQ(values.word(), "l");
  EXPECT_EQ(values.word("a file"), "leaf.s");
  EXPECT_TRUE(values.at_line_end());
  EXPECT_EQ(values.word(), "");
  EXPECT_FALSE(values.number_if_any());
  values.next_line();
  values.expect("X:");
  EXPECT_EQ(values.vector("a vector"), Vec3(1, 2, 3));
  EXPECT_EQ(values.direction("a direction"), Vec3(0, 0.6, 0.8));
  EXPECT_TRUE(values.at_line_end());
  EXPECT_FALSE(values.at_end());
  values.next_line();
  EXPECT_TRUE(values.at_end());
}

TEST(ValueReader, LineEndsMayBeBlanks) {
  const SourceText source = preprocess("1\n2\n\n3", "t.s");
  ValueReader values(source, Layout::kFree);
  EXPECT_EQ(values.vector("a vector"), Vec3(1, 2, 3));
}

struct Mistake {
  const char* text;
  void (*read)(ValueReader&);
  int line, column;
  const char* found;
  const char* expected;
};

TEST(ValueReader, SaysWhereAndWhatIsWrong) {
  const Mistake mistakes[] = {
      {"\n x", [](ValueReader& v) { v.number("a width"); }, 2, 2, "'x'", "a width"},
      {"inf", [](ValueReader& v) { v.number("a width"); }, 1, 1, "'inf'", "a width"},
      {"1e999", [](ValueReader& v) { v.number("a width"); }, 1, 1, "'1e999'", "a width"},
      {"  -2", [](ValueReader& v) { v.positive("a width"); }, 1, 3, "-2", "a width above 0"},
      {" 2.5", [](ValueReader& v) { v.count("points", 1, 9); }, 1, 2, "2.5", "points, a whole number from 1 to 9"},
      {"10", [](ValueReader& v) { v.count("points", 1, 9); }, 1, 1, "10", "points, a whole number from 1 to 9"},
      {"0 0 0", [](ValueReader& v) { v.direction("a heading"); }, 1, 1, "a vector without a direction", "a heading"},
      {"1 2", [](ValueReader& v) { v.vector("a point"); }, 1, 4, "the end of the file", "a point"},
      {"AB", [](ValueReader& v) { v.expect("AC"); }, 1, 1, "'AB'", "'AC'"},
      {"", [](ValueReader& v) { v.word("a name"); }, 1, 1, "the end of the file", "a name"},
  };
  for (const Mistake& mistake : mistakes) {
    const SourceText source = preprocess(mistake.text, "t.s");
    ValueReader values(source, Layout::kFree);
    try {
      mistake.read(values);
      ADD_FAILURE() << mistake.text;
    } catch (const InputError& error) {
      EXPECT_EQ(error.found(), mistake.found) << mistake.text;
      EXPECT_EQ(error.expected(), mistake.expected) << mistake.text;
      EXPECT_EQ(error.location().line, mistake.line) << mistake.text;
      EXPECT_EQ(error.location().column, mistake.column) << mistake.text;
    }
  }
}

}  // namespace
}  // namespace cambium
