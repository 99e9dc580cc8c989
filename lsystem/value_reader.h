// Numbers and words, one after the other, of the files that come with a model: views, surfaces, contours.
#pragma once

#include <optional>
#include <string>
#include <string_view>

#include "blobtree/geometry.h"
#include "lsystem/source_text.h"

namespace cambium {

/// Errors are InputErrors with the line and column of what is wrong.
class ValueReader {
 public:
  enum class Layout { kLines, kFree };  ///< whether line ends separate more than blanks do

  ValueReader(const SourceText& source, Layout layout) : cursor_(source), lines_(cursor_, layout == Layout::kFree) {}

  bool at_end();       ///< only blanks are left
  bool at_line_end();  ///< the same of the line
  void next_line();    ///< skips what is left of this one
  Place place();       ///< of what is next

  std::optional<double> number_if_any();
  double number(std::string_view what);  ///< finite; `what` is what was expected
  double positive(std::string_view what);
  std::size_t count(std::string_view what, std::size_t least, std::size_t most);
  Vec3 vector(std::string_view what);       ///< three numbers, with or without commas between them
  Vec3 direction(std::string_view what);    ///< the same, made a unit vector
  std::string word();                       ///< up to the next blank; empty if there is none
  std::string word(std::string_view what);  ///< the same, which has to be there
  std::string label();  ///< up to a ':' on this line, in lower case, the ':' skipped; empty if there is none
  bool accept(std::string_view text);
  void expect(std::string_view text);
  [[noreturn]] void fail(std::string expected);

 private:
  Cursor cursor_;
  Cursor::LineEnds lines_;
};

}  // namespace cambium
