// A reading head over an L-Py file, which knows its lines.
#pragma once

#include <filesystem>
#include <string>
#include <string_view>

#include "lsystem/source_text.h"

namespace cambium {

/// The file without comments and texts that stand by themselves. Errors: InputError for a text without an end.
SourceText lpy_source(std::string_view text, const std::filesystem::path& file);

class LpyCursor : public Cursor {
 public:
  using Cursor::Cursor;

  /// To the first character of the next line that is not blank, or of this one; false at the end of the file.
  bool next_line();
  /// Columns of white space before the first character of the line, where the head is; a tab leads to the next multiple
  /// of 8.
  int line_indent() const;
  /// Whether the next line that is not blank is indented deeper; then the head moves to it.
  bool enter_deeper_line(int indent);
  /// Whether the next line that is not blank has this indentation, and this word; then the head moves behind it.
  bool enter_word(int indent, std::string_view word);
  std::string_view rest_of_line() const;
  /// Errors: InputError if there is anything left.
  void end_line();
  [[noreturn]] void fail_python(std::size_t at, const std::string& what) const;
};

}  // namespace cambium
