// A string of modules in cpfg notation.
#include <charconv>

#include "lsystem/lsystem.h"

namespace cambium {

namespace {

void append_module(const ModuleString& string, std::size_t module, std::string& text) {
  text += string.names[string.symbol[module]];
  if (string.arity(module) == 0) return;
  char separator = '(';
  for (std::uint32_t p = string.first[module]; p < string.first[module + 1]; ++p) {
    text += separator;
    separator = ',';
    char number[32];
    const auto end = std::to_chars(number, number + sizeof number, string.parameters[p], std::chars_format::general, 9).ptr;
    text.append(number, end);
  }
  text += ')';
}

std::string place_of(const ExplainedStep& step, std::uint32_t rule) {
  if (rule == ExplainedStep::kStayed) return "stays";
  const SourceLocation& place = step.rules[rule];
  return place.file + ":" + std::to_string(place.line) + ":" + std::to_string(place.column);
}

}  // namespace

std::string to_text(const ModuleString& string, std::size_t begin, std::size_t end) {
  std::string text;
  text.reserve((end - begin) * 2);
  for (std::size_t i = begin; i < end; ++i) append_module(string, i, text);
  return text;
}

std::string to_text(const ModuleString& string) { return to_text(string, 0, string.size()); }

std::string to_text(const ExplainedStep& step) {
  std::string text;
  std::size_t parent = 0;  // the first without a line
  const auto nothing_left_up_to = [&](std::size_t next) {
    for (; parent < next; ++parent) text += "-\t" + to_text(step.before, parent, parent + 1) + "\t*\n";
  };
  for (std::size_t begin = 0; begin < step.origins.size();) {
    const ExplainedStep::Origin origin = step.origins[begin];
    std::size_t end = begin + 1;
    while (end < step.origins.size() && step.origins[end].parent == origin.parent && step.origins[end].rule == origin.rule)
      ++end;
    nothing_left_up_to(origin.parent);
    text += place_of(step, origin.rule) + "\t" + to_text(step.before, origin.parent, origin.parent + 1) + "\t" +
            to_text(step.after, begin, end) + "\n";
    parent = origin.parent + std::size_t{1};
    begin = end;
  }
  nothing_left_up_to(step.before.size());
  return text;
}

}  // namespace cambium
