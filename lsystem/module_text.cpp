// A string of modules in cpfg notation.
#include "lsystem/lsystem.h"

#include <charconv>

namespace cambium {

std::string to_text(const ModuleString& string) {
  std::string text;
  text.reserve(string.size() * 2 + string.parameters.size() * 8);
  for (std::size_t i = 0; i < string.size(); ++i) {
    text += string.names[string.symbol[i]];
    for (std::uint32_t p = string.first[i]; p < string.first[i + 1]; ++p) {
      text += p == string.first[i] ? '(' : ',';
      char number[32];
      const auto end = std::to_chars(number, number + sizeof number, string.parameters[p], std::chars_format::general, 9).ptr;
      text.append(number, end);
    }
    if (string.first[i] != string.first[i + 1]) text += ')';
  }
  return text;
}

}  // namespace cambium
