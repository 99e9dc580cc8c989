// Text after the preprocessor, every character still knowing the place in the file that it came from.
#pragma once

#include "blobtree/input_error.h"

#include <cstdint>
#include <string>
#include <string_view>
#include <vector>

namespace cambium {

/// Where a character stands: line and column (in bytes) from 1, file as an index into a list of names.
struct Place {
  std::uint32_t line = 0;
  std::uint32_t column = 0;
  std::uint32_t file = 0;
};

inline SourceLocation located(const std::vector<std::string>& files, const Place& place) {
  return {place.file < files.size() ? files[place.file] : std::string(), static_cast<int>(place.line),
          static_cast<int>(place.column)};
}

/// Characters and their places, index by index; `end` is the place behind the last one.
struct SourceText {
  /// Stands before and behind a symbol's name in what was translated from another dialect (dialect_translation.h), whose
  /// symbols may be of several characters, or of such as mean something else in cpfg's language.
  static constexpr char kNameMark = '\x1e';

  std::string text;
  std::vector<Place> places;
  Place end;
  std::vector<std::string> files;
  bool marks_names = false;

  void append(char c, const Place& place) {
    text.push_back(c);
    places.push_back(place);
  }
  Place place(std::size_t index) const { return index < places.size() ? places[index] : end; }
};

/// Reading head over a SourceText, with the errors that parsers of it throw.
class Cursor {
 public:
  explicit Cursor(const SourceText& source) : source_(source) {}

  std::size_t position() const { return position_; }
  void seek(std::size_t position) { position_ = position; }
  bool at_end() const { return position_ >= source_.text.size(); }
  char peek(std::size_t ahead = 0) const {
    return position_ + ahead < source_.text.size() ? source_.text[position_ + ahead] : '\0';
  }
  bool looking_at(std::string_view word) const { return source_.text.compare(position_, word.size(), word) == 0; }
  void advance(std::size_t count = 1) { position_ += count; }
  bool accept(char c);                         ///< skips space, then takes c if it stands there
  void expect(char c, std::string_view where); ///< as accept, else InputError: expected 'c' `where`
  /// The ')' that belongs to the '(' at `open`; where another line ended without it, the error is at `open`.
  void expect_close(std::size_t open, std::string_view where);
  /// Spaces and tabs; also line ends inside parentheses or blocks (see LineEnds).
  void skip_space();
  void skip_blank_lines();                     ///< all white space
  bool at_line_end() const { return at_end() || peek() == '\n'; }
  std::string word();                          ///< identifier at the head, or empty
  bool at_marked_name() const { return source_.marks_names && peek() == SourceText::kNameMark; }
  std::string marked_name();                   ///< at its first mark
  Place place() const { return source_.place(position_); }
  Place place_of(std::size_t position) const { return source_.place(position); }
  const SourceText& source() const { return source_; }

  /// What stands at `position`, in words for a message.
  std::string describe(std::size_t position) const;
  [[noreturn]] void fail(std::string expected) const { fail_at(position_, describe(position_), std::move(expected)); }
  [[noreturn]] void fail_at(std::size_t position, std::string found, std::string expected) const;

  /// While alive, line ends count (or do not count) as white space.
  class LineEnds {
   public:
    LineEnds(Cursor& cursor, bool are_space) : cursor_(cursor), before_(cursor.lines_are_space_) {
      cursor.lines_are_space_ = are_space;
    }
    ~LineEnds() { cursor_.lines_are_space_ = before_; }
    LineEnds(const LineEnds&) = delete;
    LineEnds& operator=(const LineEnds&) = delete;

   private:
    Cursor& cursor_;
    bool before_;
  };

 private:
  const SourceText& source_;
  std::size_t position_ = 0;
  bool lines_are_space_ = false;
};

inline bool is_digit(char c) { return c >= '0' && c <= '9'; }
inline bool starts_word(char c) { return (c >= 'a' && c <= 'z') || (c >= 'A' && c <= 'Z') || c == '_'; }
inline bool in_word(char c) { return starts_word(c) || is_digit(c); }

}  // namespace cambium
