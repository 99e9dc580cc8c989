#include "lsystem/macro_expansion.h"

#include <algorithm>
#include <utility>

namespace cambium {
namespace {

constexpr int kMaxDepth = 64;
constexpr std::size_t kMaxWork = 4'000'000;

bool blank(char c) { return c == ' ' || c == '\t' || c == '\n'; }

}  // namespace

std::string word_at(const MarkedText& text, std::size_t index) {
  std::string word;
  if (index < text.size() && starts_word(text[index].c))
    for (; index < text.size() && in_word(text[index].c); ++index) word.push_back(text[index].c);
  return word;
}

void MacroTable::fail(const Place& at, std::string found, std::string expected) const {
  throw InputError(located(files_, at), std::move(found), std::move(expected));
}

void MacroTable::spend(std::size_t characters, const Place& at) {
  work_ += characters;
  if (work_ > kMaxWork) fail(at, "more than 4000000 characters after preprocessing", "a smaller L-system");
}

void MacroTable::define(const MarkedText& definition, const Place& at) {
  const std::string name = word_at(definition, 0);
  if (name.empty()) fail(definition.empty() ? at : definition[0].place, "no name", "the name of a macro");
  Macro macro;
  std::size_t i = name.size();
  const auto skip = [&] {
    while (i < definition.size() && blank(definition[i].c)) ++i;
  };
  if (i < definition.size() && definition[i].c == '(') {
    macro.takes_arguments = true;
    const Place open = definition[i++].place;
    skip();
    while (i < definition.size() && definition[i].c != ')') {
      const std::string parameter = word_at(definition, i);
      if (parameter.empty()) fail(definition[i].place, std::string("'") + definition[i].c + "'", "a parameter of the macro");
      if (std::find(macro.parameters.begin(), macro.parameters.end(), parameter) != macro.parameters.end())
        fail(definition[i].place, "'" + parameter + "' twice", "different parameters");
      macro.parameters.push_back(parameter);
      i += parameter.size();
      skip();
      if (i < definition.size() && definition[i].c == ',') {
        ++i;
        skip();
      } else if (i < definition.size() && definition[i].c != ')') {
        fail(definition[i].place, std::string("'") + definition[i].c + "'", "',' or ')'");
      }
    }
    if (i >= definition.size()) fail(open, "'(' without an end", "')'");
    ++i;
  }
  skip();
  macro.body.assign(definition.begin() + static_cast<long>(i), definition.end());
  macros_[name] = std::move(macro);
}

std::size_t MacroTable::read_arguments(const MarkedText& in, std::size_t open, std::vector<MarkedText>& out) const {
  out.emplace_back();
  int depth = 1;
  std::size_t i = open + 1;
  for (; i < in.size(); ++i) {
    const char c = in[i].c;
    if (c == '(') ++depth;
    if (c == ')' && --depth == 0) break;
    if (c == ',' && depth == 1)
      out.emplace_back();
    else
      out.back().push_back(in[i]);
  }
  if (i >= in.size()) fail(in[open].place, "'(' without an end", "')' after the macro's arguments");
  for (MarkedText& argument : out) {
    while (!argument.empty() && blank(argument.back().c)) argument.pop_back();
    argument.erase(argument.begin(),
                   std::find_if_not(argument.begin(), argument.end(), [](const MarkedChar& c) { return blank(c.c); }));
  }
  return i + 1;
}

void MacroTable::expand_into(const MarkedText& in, MarkedText& out, int depth) {
  for (std::size_t i = 0; i < in.size();) {
    const char c = in[i].c;
    spend(1, in[i].place);
    std::size_t length = 1;
    if (c == '"') {
      while (i + length < in.size() && in[i + length].c != '"' && in[i + length].c != '\n') ++length;
      length = std::min(length + 1, in.size() - i);
    } else if (is_digit(c)) {
      // One preprocessing number: the e5 of 1e5 is no name.
      while (i + length < in.size() && (in_word(in[i + length].c) || in[i + length].c == '.')) ++length;
    }
    const std::string name = word_at(in, i);
    const auto found = name.empty() ? macros_.end() : macros_.find(name);
    std::size_t open = i + name.size();
    if (found != macros_.end() && found->second.takes_arguments)
      while (open < in.size() && blank(in[open].c)) ++open;
    const bool invoked = found != macros_.end() && !found->second.busy &&
                         (!found->second.takes_arguments || (open < in.size() && in[open].c == '('));
    if (name == "__LINE__") {
      for (const char digit : std::to_string(in[i].place.line)) out.push_back({digit, in[i].place});
      i += name.size();
      continue;
    }
    if (!invoked) {
      length = std::max(length, name.size());
      out.insert(out.end(), in.begin() + static_cast<long>(i), in.begin() + static_cast<long>(i + length));
      i += length;
      continue;
    }
    const Place at = in[i].place;
    if (depth >= kMaxDepth) fail(at, "macros nested deeper than 64", "a simpler '" + name + "'");
    Macro& macro = found->second;
    std::vector<MarkedText> arguments;
    std::size_t after = i + name.size();
    if (macro.takes_arguments) {
      std::vector<MarkedText> raw;
      after = read_arguments(in, open, raw);
      if (macro.parameters.empty() && raw.size() == 1 && raw[0].empty()) raw.clear();
      if (raw.size() != macro.parameters.size())
        fail(at, "'" + name + "' with " + std::to_string(raw.size()) + (raw.size() == 1 ? " argument" : " arguments"),
             std::to_string(macro.parameters.size()));
      for (const MarkedText& argument : raw) expand_into(argument, arguments.emplace_back(), depth + 1);
    }
    MarkedText body;
    for (std::size_t k = 0; k < macro.body.size();) {
      const std::string word = word_at(macro.body, k);
      const auto parameter = std::find(macro.parameters.begin(), macro.parameters.end(), word);
      if (!word.empty() && parameter != macro.parameters.end()) {
        const MarkedText& argument = arguments[static_cast<std::size_t>(parameter - macro.parameters.begin())];
        spend(argument.size() + 1, at);
        body.insert(body.end(), argument.begin(), argument.end());
        k += word.size();
        continue;
      }
      const std::size_t count = std::max<std::size_t>(word.size(), 1);
      for (std::size_t n = 0; n < count; ++n) body.push_back({macro.body[k + n].c, at});
      k += count;
    }
    macro.busy = true;
    expand_into(body, out, depth + 1);
    macro.busy = false;
    i = after;
  }
}

}  // namespace cambium
