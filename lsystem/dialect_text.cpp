#include "lsystem/dialect_text.h"

#include <cstdio>

#include "lsystem/expression_compiler.h"

namespace cambium {
namespace {

constexpr std::size_t kMaxText = 4'000'000;

}  // namespace

SourceText as_it_stands(std::string_view text, const std::filesystem::path& file) {
  SourceText out;
  out.files = {file.string()};
  Place place{1, 1, 0};
  const std::size_t begin = text.substr(0, 3) == "\xef\xbb\xbf" ? 3 : 0;
  for (const char c : text.substr(begin)) {
    if (c != '\r') out.append(c, place);
    ++place.column;
    if (c == '\n') place = {place.line + 1, 1, 0};
  }
  out.end = place;
  return out;
}

void append(MarkedText& to, std::string_view text, const Place& place) {
  for (const char c : text) to.push_back({c, place});
}

void append_symbol(MarkedText& to, std::string_view name, const Place& place) {
  to.push_back({SourceText::kNameMark, place});
  append(to, name, place);
  to.push_back({SourceText::kNameMark, place});
}

void append_number(MarkedText& to, double value, const Place& place) {
  char number[40];
  std::snprintf(number, sizeof number, value < 0 ? "(%.17g)" : "%.17g", value);
  append(to, number, place);
}

SourceText marked_source(const MarkedText& text, const SourceText& from) {
  SourceText out;
  out.files = from.files;
  out.end = from.end;
  out.marks_names = true;
  if (text.size() > kMaxText)
    throw InputError({from.files[0], 0, 0}, "rules that become too long", "fewer, or simpler ones");
  for (const MarkedChar& c : text) out.append(c.c, c.place);
  return out;
}

double constant_of(const MarkedText& expression, const SourceText& from) {
  const SourceText source = marked_source(expression, from);
  Cursor cursor(source);
  const double value = constant_expression(cursor);
  cursor.skip_space();
  if (!cursor.at_end()) cursor.fail("the end of the line");
  return value;
}

}  // namespace cambium
