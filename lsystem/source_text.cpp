#include "lsystem/source_text.h"

#include <algorithm>
#include <cstdio>
#include <utility>

namespace cambium {

bool Cursor::accept(char c) {
  skip_space();
  if (at_end() || peek() != c) return false;
  advance();
  return true;
}

void Cursor::expect(char c, std::string_view where) {
  if (!accept(c)) fail(std::string("'") + c + "' " + std::string(where));
}

void Cursor::expect_close(std::size_t open, std::string_view where) {
  if (accept(')')) return;
  if (at_line_end() || place().line != place_of(open).line) fail_at(open, "'(' without an end", "')' on the same line");
  fail("')' " + std::string(where));
}

void Cursor::skip_space() {
  while (!at_end()) {
    const char c = peek();
    if (c != ' ' && c != '\t' && c != '\r' && !(c == '\n' && lines_are_space_)) return;
    advance();
  }
}

void Cursor::skip_blank_lines() {
  const LineEnds all(*this, true);
  skip_space();
}

std::string Cursor::word() {
  if (at_end() || !starts_word(peek())) return {};
  const std::size_t begin = position_;
  while (!at_end() && in_word(peek())) advance();
  return source_.text.substr(begin, position_ - begin);
}

std::string Cursor::marked_name() {
  const std::size_t end = std::min(source_.text.find(SourceText::kNameMark, position_ + 1), source_.text.size());
  std::string name = source_.text.substr(position_ + 1, end - position_ - 1);
  position_ = std::min(end + 1, source_.text.size());
  return name;
}

std::string Cursor::describe(std::size_t position) const {
  const std::string& text = source_.text;
  if (source_.marks_names && position < text.size() && text[position] == SourceText::kNameMark)
    return "'" + text.substr(position + 1, text.find(SourceText::kNameMark, position + 1) - position - 1) + "'";
  if (position >= text.size()) return "the end of the file";
  const char c = text[position];
  if (c == '\n') return "the end of the line";
  if (text.compare(position, 3, "-->") == 0) return "'-->'";
  const auto byte = static_cast<unsigned char>(c);
  if (byte < 0x20 || byte >= 0x7f) {
    char code[16];
    std::snprintf(code, sizeof code, "byte 0x%02x", byte);
    return code;
  }
  std::size_t end = position;
  while (end < text.size() && end - position < 40 && in_word(text[end])) ++end;
  std::string quoted(1, '\'');
  quoted.append(text, position, end > position ? end - position : 1);
  quoted += '\'';
  return quoted;
}

void Cursor::fail_at(std::size_t position, std::string found, std::string expected) const {
  throw InputError(located(source_.files, source_.place(position)), std::move(found), std::move(expected));
}

}  // namespace cambium
