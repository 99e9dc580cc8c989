#include "blobtree/located_json.h"

#include <gtest/gtest.h>

#include <cmath>
#include <filesystem>

namespace cambium {
namespace {

struct Malformed {
  const char* text;
  int line, column;
  const char* found;
};

TEST(LocatedJson, NamesTheLineAndColumnOfEveryMistake) {
  const Malformed table[] = {
      {"", 1, 1, "the end of the file"},
      {"  \n ", 2, 2, "the end of the file"},
      {"{", 1, 2, "the end of the file"},
      {"[1,\n2", 2, 2, "the end of the file"},
      {"{\"a\" 1}", 1, 6, "`1`"},
      {"{\"a\":1,}", 1, 8, "`}`"},
      {"{\"a\":}", 1, 6, "`}`"},
      {"{a:1}", 1, 2, "`a`"},
      {"{1:2}", 1, 2, "`1`"},
      {"{\"a\":1 \"b\":2}", 1, 8, "a string"},
      {"[1,,2]", 1, 4, "`,`"},
      {"[,1]", 1, 2, "`,`"},
      {"[1 2]", 1, 4, "`2`"},
      {"[1}", 1, 3, "`}`"},
      {"[01]", 1, 3, "`1`"},
      {"[1.e5]", 1, 2, "`1.e5`"},
      {"[-]", 1, 2, "`-`"},
      {"[+1]", 1, 2, "`+1`"},
      {"[\n  NaN]", 2, 3, "`NaN`"},
      {"[Infinity]", 1, 2, "`Infinity`"},
      {"[-Infinity]", 1, 2, "`-Infinity`"},
      {"[1,\n 1e999]", 2, 2, "`1e999`"},
      {"[tru]", 1, 2, "`tru`"},
      {"[\"abc", 1, 2, "a string without its closing quote"},
      {"[\"\xC3\xA9\", nope]", 1, 7, "`nope`"},
      {"{} x", 1, 4, "`x`"},
      {"[1]\n]", 2, 1, "`]`"},
      {"{\"a\":1,\n \"b\":2,\n \"a\":3}", 3, 2, "the key `a` a second time"},
      {"{\"a\":[{\"b\":1,\"c\":2,\"b\":3}]}", 1, 20, "the key `b` a second time"},
  };
  for (const Malformed& row : table) {
    try {
      parse_json(row.text, "x.json");
      ADD_FAILURE() << "accepted " << row.text;
    } catch (const InputError& error) {
      EXPECT_EQ(error.location().file, "x.json");
      EXPECT_EQ(error.location().line, row.line) << row.text << "\n" << error.what();
      EXPECT_EQ(error.location().column, row.column) << row.text << "\n" << error.what();
      EXPECT_EQ(error.found(), row.found) << row.text;
    }
  }
}

TEST(LocatedJson, RefusesStringsThatAreNotText) {
  for (const std::string text : {"[\"a\nb\"]", "[\"\\x\"]", "[\"\xff\"]", "[\"\\ud800\"]"}) {
    try {
      parse_json(text, "");
      ADD_FAILURE() << text;
    } catch (const InputError& error) {
      EXPECT_EQ(error.location().line, 1) << error.what();
      EXPECT_GT(error.location().column, 2) << error.what();
    }
  }
  EXPECT_THROW(parse_json(std::string("{}\0junk", 7), ""), InputError);
}

TEST(LocatedJson, ValuesAndKeysKnowWhereTheyStand) {
  const LocatedJson document = parse_json("\xEF\xBB\xBF{\"a\": [1,\n  -2.5e1, \"x\\\"y\"],\r\n\t\"b\" : null, \"c\":true}", "f");
  const JsonValue root = document.root();
  EXPECT_EQ(root.location().column, 1);
  const JsonValue a = root.at("a");
  EXPECT_EQ(a.location().column, 7);
  EXPECT_EQ(a[1].location().line, 2);
  EXPECT_EQ(a[1].location().column, 3);
  EXPECT_EQ(a[1].number(), -25);
  EXPECT_EQ(a[2].string(), "x\"y");
  EXPECT_EQ(a[2].location().column, 11);
  EXPECT_EQ(root.member_key(1).location().line, 3);
  EXPECT_EQ(root.member_key(1).location().column, 2);
  EXPECT_EQ(root.member(1).location().column, 8);
  EXPECT_EQ(root.member(1).kind(), JsonValue::Kind::Null);
  EXPECT_TRUE(root.at("c").boolean());
  EXPECT_FALSE(root.find("d"));
  EXPECT_EQ(root.number_or("d", 3), 3);
}

// Counting from the start of the line for each would be 10^11 characters.
TEST(LocatedJson, EveryValueOfAVeryLongLineKnowsItsColumn) {
  constexpr std::size_t kValues = 200'000;
  std::string text = "[\"first line\",\n";
  for (std::size_t i = 0; i < kValues; ++i) text += i % 2 ? "1,    " : "\"\xC3\xA9\",  ";   // each six characters, every other of seven bytes
  text += "0]";
  const LocatedJson document = parse_json(text, "f");
  const JsonValue root = document.root();
  ASSERT_EQ(root.size(), kValues + 2);
  for (std::size_t i = 0; i <= kValues; ++i) {
    const SourceLocation at = root[i + 1].location();
    ASSERT_EQ(at.line, 2);
    ASSERT_EQ(at.column, static_cast<int>(6 * i) + 1);
  }
}

TEST(LocatedJson, NumbersAreTheNearestDoubles) {
  const LocatedJson document = parse_json("[0.1, 12345678901234567890, 1e-400, 5e-324, -0, 1.7976931348623157e308]", "");
  const JsonValue a = document.root();
  EXPECT_EQ(a[0].number(), 0.1);
  EXPECT_EQ(a[1].number(), 12345678901234567890.0);
  EXPECT_EQ(a[2].number(), 0.0);
  EXPECT_EQ(a[3].number(), 5e-324);
  EXPECT_TRUE(std::signbit(a[4].number()));
  EXPECT_EQ(a[5].number(), 1.7976931348623157e308);
}

TEST(LocatedJson, WrongKindsAreErrorsAtTheValue) {
  const LocatedJson document = parse_json("{\"a\":\n {\"b\": [1, 2.5, \"s\"]}, \"typo\": 1}", "f");
  const JsonValue root = document.root(), b = root.at("a").at("b");
  const auto column_of = [](auto&& read) {
    try {
      read();
    } catch (const InputError& error) {
      return error.location().column;
    }
    return -1;
  };
  EXPECT_EQ(column_of([&] { b.number(); }), 8);
  EXPECT_EQ(column_of([&] { b.elements(2); }), 8);
  EXPECT_EQ(column_of([&] { b.vec3(); }), 17);
  EXPECT_EQ(column_of([&] { b[1].integer(0, 9); }), 12);
  EXPECT_EQ(column_of([&] { b[0].integer(2, 9); }), 9);
  EXPECT_EQ(column_of([&] { b[0].string(); }), 9);
  EXPECT_EQ(column_of([&] { b.at("x"); }), 8);
  EXPECT_EQ(column_of([&] { root.at("a").at("x"); }), 2);
  EXPECT_EQ(column_of([&] { root.expect_keys({"a"}); }), 24);
  EXPECT_EQ(column_of([&] { root.expect_keys({"a", "typo"}); }), -1);
}

TEST(LocatedJson, DepthCostsNoCallStack) {
  constexpr std::size_t kDepth = 1000000;
  const LocatedJson arrays = parse_json(std::string(kDepth, '[') + std::string(kDepth, ']'), "");
  EXPECT_EQ(arrays.root().size(), 1u);
  EXPECT_THROW(parse_json(std::string(kDepth, '['), ""), InputError);
}

TEST(LoadJson, SaysWhichFileCannotBeRead) {
  const auto missing = std::filesystem::temp_directory_path() / "cambium-no-such-file.json";
  for (const auto& path : {missing, std::filesystem::temp_directory_path()}) {
    try {
      load_json(path);
      ADD_FAILURE() << path;
    } catch (const InputError& error) {
      EXPECT_EQ(error.location().file, path.string());
    }
  }
}

}  // namespace
}  // namespace cambium
