// Numbers in text tables, the same in every locale, with the place of what is wrong.
#pragma once

#include "blobtree/input_error.h"

#include <cstdint>
#include <string>
#include <string_view>
#include <vector>

namespace cambium {

/// A piece of one line; column counts bytes from 1.
struct TextField {
  std::string_view text;
  int column = 1;
};

/// The line cut at blanks; runs of blanks count as one.
std::vector<TextField> split_at_blanks(std::string_view line);
/// The line cut at every separator; blanks and one pair of double quotes around a field are taken off.
std::vector<TextField> split_at(std::string_view line, char separator);

/// Errors: InputError unless the whole field is one finite number. `what` names it: "a radius".
double parse_finite(const TextField& field, const std::string& file, int line, const std::string& what);
double parse_positive(const TextField& field, const std::string& file, int line, const std::string& what);
/// Also takes an integer written as a float (12.0), as spreadsheets do.
std::int64_t parse_integer(const TextField& field, const std::string& file, int line, const std::string& what);

/// A field as it is quoted in a message: at most 40 bytes.
std::string quoted(std::string_view text);

/// The shortest text that reads back as the same double.
void append_number(std::string& out, double value);

/// Lines of a text without their ends (\n or \r\n), counted from 1.
class LineReader {
 public:
  explicit LineReader(std::string_view text);
  bool next(std::string_view& line);
  int number() const { return number_; }

 private:
  std::string_view rest_;
  int number_ = 0;
};

}  // namespace cambium
