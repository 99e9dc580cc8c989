#include "blobtree/input_error.h"

#include <utility>

namespace cambium {
namespace {

std::string one_line(const SourceLocation& at, const std::string& found, const std::string& expected) {
  std::string text = at.file;
  if (at.line > 0) text += ":" + std::to_string(at.line);
  if (at.line > 0 && at.column > 0) text += ":" + std::to_string(at.column);
  if (!text.empty()) text += ": ";
  text += "found " + found + ", expected " + expected;
  for (char& c : text)
    if (static_cast<unsigned char>(c) < 0x20 || c == 0x7f) c = ' ';
  return text;
}

}  // namespace

InputError::InputError(SourceLocation location, std::string found, std::string expected)
    : std::runtime_error(one_line(location, found, expected)),
      location_(std::move(location)),
      found_(std::move(found)),
      expected_(std::move(expected)) {}

}  // namespace cambium
