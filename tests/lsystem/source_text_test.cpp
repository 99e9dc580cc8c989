#include "lsystem/source_text.h"

#include <gtest/gtest.h>

namespace cambium {
namespace {

SourceText source_of(const std::string& text) {
  SourceText source;
  Place place{1, 1, 0};
  for (const char c : text) {
    source.append(c, place);
    ++place.column;
    if (c == '\n') place = {place.line + 1, 1, 0};
  }
  source.end = place;
  source.files = {"test.l"};
  return source;
}

TEST(SourceText, LineEndsAreSpaceOnlyWhereToldSo) {
  const SourceText source = source_of("  \n x");
  Cursor cursor(source);
  cursor.skip_space();
  EXPECT_EQ(cursor.position(), 2u);
  {
    const Cursor::LineEnds inside(cursor, true);
    cursor.skip_space();
    EXPECT_EQ(cursor.peek(), 'x');
  }
  cursor.seek(2);
  cursor.skip_space();
  EXPECT_EQ(cursor.position(), 2u);
}

TEST(SourceText, WhatStandsAtAPlaceIsNamedInWords) {
  const SourceText source = source_of("word+-->\n\x01");
  const Cursor cursor(source);
  EXPECT_EQ(cursor.describe(0), "'word'");
  EXPECT_EQ(cursor.describe(4), "'+'");
  EXPECT_EQ(cursor.describe(5), "'-->'");
  EXPECT_EQ(cursor.describe(8), "the end of the line");
  EXPECT_EQ(cursor.describe(9), "byte 0x01");
  EXPECT_EQ(cursor.describe(10), "the end of the file");
}

TEST(SourceText, AnUnclosedParenthesisIsReportedWhereItOpens) {
  for (const auto& [text, column] : {std::pair{"a(b\nc", 2u}, std::pair{"a(b c", 5u}}) {
    const SourceText source = source_of(text);
    Cursor cursor(source);
    cursor.seek(3);
    try {
      cursor.expect_close(1, "here");
      FAIL();
    } catch (const InputError& error) {
      EXPECT_EQ(error.location().line, 1);
      EXPECT_EQ(error.location().column, static_cast<int>(column));
    }
  }
}

}  // namespace
}  // namespace cambium
