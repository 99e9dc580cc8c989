#include "lsystem/module_parser.h"

#include <algorithm>
#include <string_view>
#include <unordered_map>
#include <utility>

#include "lsystem/lineage.h"

namespace cambium {
namespace {

constexpr std::size_t kMaxParameters = 1000;
constexpr std::string_view kSymbolMarks = "+-&^\\/|$[]{}.!#;,'%_=?";
constexpr std::string_view kMarksAfterAt = "#!;,";

bool symbol_at(const Cursor& cursor) {
  if (cursor.at_marked_name()) return true;
  const char c = cursor.peek();
  if (c == '\0' || cursor.looking_at("-->")) return false;
  return in_word(c) || c == '@' || c == '~' || kSymbolMarks.find(c) != std::string_view::npos;
}

// `: {`, `: *` and `:` alone begin a production's condition; a weight looks otherwise.
bool begins_condition(std::string_view line) {
  const std::size_t colon = line.find(':');
  if (colon == std::string_view::npos) return false;
  const std::size_t next = line.find_first_not_of(" \t", colon + 1);
  return next == std::string_view::npos || line[next] == '{' || line[next] == '*';
}

}  // namespace

std::string lower_case(std::string word) {
  for (char& c : word)
    if (c >= 'A' && c <= 'Z') c = static_cast<char>(c - 'A' + 'a');
  return word;
}

bool is_keyword(const std::string& word) {
  static constexpr std::string_view kWords[] = {
      "lsystem",        "endlsystem",    "seed",      "derivation", "define",     "ring",  "consider",
      "ignore",         "start",         "starteach", "endeach",    "end",        "axiom", "homomorphism",
      "interpretation", "decomposition", "maximum",   "production", "productions"};
  return std::find(std::begin(kWords), std::end(kWords), lower_case(word)) != std::end(kWords);
}

std::optional<std::string> ModuleParser::symbol() {
  if (!symbol_at(cursor_)) return std::nullopt;
  if (cursor_.at_marked_name()) return cursor_.marked_name();
  const std::size_t at = cursor_.position();
  std::string name(1, cursor_.peek());
  cursor_.advance();
  if (name == "@" || name == "~" || (name == "?" && starts_word(cursor_.peek()))) {
    const bool mark = name == "@" && kMarksAfterAt.find(cursor_.peek()) != std::string_view::npos && !cursor_.at_end();
    if (!in_word(cursor_.peek()) && !mark) cursor_.fail_at(at, "'" + name + "' alone", "a letter after it");
    name += cursor_.peek();
    cursor_.advance();
    static constexpr std::string_view kSecond[] = {"@Gs", "@Gc", "@Ge", "@Gr", "@Gt", "@Ts", "@Td", "@Ti", "@Tp", "@Tf",
                                                   "@Tx", "@Di", "@Dd", "@mo", "@mc", "@bo", "@bc", "@PS", "@PC", "@PD"};
    if (std::find(std::begin(kSecond), std::end(kSecond), name + cursor_.peek()) != std::end(kSecond)) {
      name += cursor_.peek();
      cursor_.advance();
    }
    refuse_environment(name, at);
  }
  return name;
}

// A model that waits for answers would grow into something else without a word.
void ModuleParser::refuse_environment(const std::string& name, std::size_t at) const {
  if (name == "?E") cursor_.fail_at(at, "'?E', a question to an environment program", "an L-system that is not open");
}

std::uint16_t ModuleParser::number(const std::string& name, std::size_t at) {
  const std::uint16_t number = program_.symbols.number(name);
  if (program_.symbols.names().size() >= SymbolTable::kMaxSymbols)
    cursor_.fail_at(at, "too many symbols", "fewer than 65535");
  return number;
}

// At a line end: whether the next line that is not blank goes on with the successor. It does if it is indented (cpfg asks
// for a tab), or inside brackets, and nothing in it makes it a production or a keyword of its own. Leaves the cursor there
// if so.
bool ModuleParser::line_continues(bool inside_brackets) {
  const std::string& text = cursor_.source().text;
  const std::size_t before = cursor_.position();
  cursor_.skip_blank_lines();
  const std::size_t first = cursor_.position();
  const bool indented = first > 0 && (text[first - 1] == ' ' || text[first - 1] == '\t');
  const std::size_t end = std::min(text.find('\n', first), text.size());
  const std::string_view line(text.data() + first, end - first);
  const std::string word = cursor_.word();
  const std::size_t next = std::min(text.find_first_not_of(" \t\n", end), text.size());
  const bool goes_on = (indented || inside_brackets) && first < text.size() && !is_keyword(word) &&
                       line.find("-->") == std::string_view::npos && text.compare(next, 3, "-->") != 0 &&
                       !begins_condition(line);
  cursor_.seek(goes_on ? first : before);
  return goes_on;
}

// The '(' to ')' behind a symbol, if there is one.
std::uint16_t ModuleParser::module_arity(ExpressionCompiler& compiler) {
  cursor_.skip_space();
  if (cursor_.peek() != '(') return 0;
  const std::size_t open = cursor_.position();
  cursor_.advance();
  const Cursor::LineEnds inside(cursor_, true);
  std::size_t arity = 0;
  do {
    compiler.expression();
    if (++arity > kMaxParameters) cursor_.fail("fewer than 1000 parameters");
  } while (cursor_.accept(','));
  cursor_.expect_close(open, "or ','");
  return static_cast<std::uint16_t>(arity);
}

void ModuleParser::modules(Successor& out, Scope& scope) {
  std::vector<std::size_t> open;
  std::unordered_map<std::string, std::uint64_t> occurrences;
  ExpressionCompiler compiler(cursor_, scope, out.parameters);
  while (true) {
    cursor_.skip_space();
    if (cursor_.at_end()) break;
    if (cursor_.peek() == '\n') {
      if (!line_continues(!open.empty())) break;
      continue;
    }
    const std::size_t at = cursor_.position();
    const auto name = symbol();
    if (!name) break;
    if (*name == "[") open.push_back(at);
    if (*name == "]") {
      if (open.empty()) cursor_.fail_at(at, "']'", "a '[' before it");
      open.pop_back();
    }
    out.symbols.push_back(number(*name, at));
    out.slots.push_back(slot_of(*name, occurrences[*name]++));
    out.arities.push_back(module_arity(compiler));
    out.parameter_count += out.arities.back();
  }
  if (!open.empty()) cursor_.fail_at(open.back(), "'[' without an end", "']' in the same successor");
}

Successor ModuleParser::successor(Scope& scope) {
  Successor out;
  cursor_.skip_space();
  if (cursor_.peek() == '\n') line_continues(false);
  if (cursor_.peek() == '*') {
    cursor_.advance();
    return out;
  }
  const std::size_t begin = cursor_.position();
  modules(out, scope);
  if (out.symbols.empty()) cursor_.fail_at(begin, cursor_.describe(begin), "a successor, or '*' for none");
  return out;
}

struct ModuleParser::FormalModule {
  std::string name;
  std::size_t at = 0;
  ContextModule module;
};

struct ModuleParser::Predecessors {
  std::vector<FormalModule> left, strict, right;
  bool left_seen = false, right_seen = false;
};

ModuleParser::FormalModule ModuleParser::formal(Scope& scope) {
  FormalModule out;
  out.at = cursor_.position();
  const auto name = symbol();
  if (!name) cursor_.fail("a module or '-->'");
  out.name = *name;
  out.module = {number(*name, out.at), 0, static_cast<std::uint32_t>(scope.locals.size())};
  cursor_.skip_space();
  if (cursor_.peek() != '(') return out;
  cursor_.advance();
  do {
    cursor_.skip_space();
    const std::size_t at = cursor_.position();
    const std::string parameter = cursor_.word();
    if (parameter.empty()) cursor_.fail("the name of a parameter");
    if (!scope.locals.emplace(parameter, static_cast<std::uint32_t>(scope.locals.size())).second)
      cursor_.fail_at(at, "parameter '" + parameter + "' twice", "different names");
    if (++out.module.arity > kMaxParameters) cursor_.fail("fewer than 1000 parameters");
  } while (cursor_.accept(','));
  cursor_.expect(')', "or ','");
  return out;
}

void ModuleParser::refuse_object_production() const {
  if (cursor_.looking_at("-o>"))
    cursor_.fail_at(cursor_.position(), "'-o>', an object production", "'-->': objects of Rayshade are not made here");
}

// At a line end: the next line goes on with this production only by a mark that cannot begin one.
void ModuleParser::go_to_arrow_line() {
  const std::size_t line_end = cursor_.position();
  cursor_.skip_blank_lines();
  const char next = cursor_.peek();
  if (!at_arrow() && next != ':' && next != '<' && next != '>')
    cursor_.fail_at(line_end, cursor_.describe(line_end), "'-->'");
}

// At a '<': what stood before it is the left context.
void ModuleParser::left_part(Predecessors& parts) {
  if (parts.left_seen || parts.right_seen) cursor_.fail("'>', ':' or '-->'");
  if (parts.strict.empty()) cursor_.fail("a left context before it");
  parts.left_seen = true;
  parts.left = std::move(parts.strict);
  parts.strict.clear();
  cursor_.advance();
}

// At a '>': what follows it is the right context.
void ModuleParser::right_part(Predecessors& parts) {
  if (parts.right_seen) cursor_.fail("':' or '-->'");
  if (parts.strict.empty()) cursor_.fail("a predecessor before it");
  parts.right_seen = true;
  cursor_.advance();
  cursor_.skip_space();
  if (at_arrow() || cursor_.peek() == ':') cursor_.fail("a right context");
}

// `left < strict > right`, up to the ':' or the arrow. `*` in place of a context is none.
ModuleParser::Predecessors ModuleParser::predecessors(Scope& scope) {
  Predecessors parts;
  const auto nothing = [&] {
    cursor_.skip_space();
    if (cursor_.peek() != '*') return false;
    cursor_.advance();
    return true;
  };
  if (nothing()) {
    cursor_.skip_space();
    if (cursor_.peek() != '<') cursor_.fail("'<' after '*'");
    parts.left_seen = true;
    cursor_.advance();
  }
  while (true) {
    cursor_.skip_space();
    if (cursor_.at_line_end()) go_to_arrow_line();
    if (at_arrow() || cursor_.peek() == ':') break;
    if (cursor_.looking_at("->")) cursor_.fail_at(cursor_.position(), "'->'", "'-->'");
    refuse_object_production();
    if (cursor_.peek() == '<') {
      left_part(parts);
    } else if (cursor_.peek() == '>') {
      right_part(parts);
      if (nothing()) continue;
    } else {
      (parts.right_seen ? parts.right : parts.strict).push_back(formal(scope));
    }
  }
  if (parts.strict.empty()) cursor_.fail("a predecessor");
  check(parts);
  return parts;
}

// A right context may hold brackets, balanced or not: it can lead into a branch, or out of the one that the predecessor is
// in.
void ModuleParser::check(const Predecessors& parts) const {
  const auto bracket = [](const FormalModule& module) { return module.name == "[" || module.name == "]"; };
  for (const FormalModule& module : parts.strict)
    if (bracket(module)) cursor_.fail_at(module.at, "'" + module.name + "'", "a predecessor that is no bracket");
  for (const FormalModule& module : parts.left)
    if (bracket(module))
      cursor_.fail_at(module.at, "'" + module.name + "' in a left context", "modules on the path to the root");
}

// Behind the ':': `{statements} condition {statements}`, each of which may be missing, but not all.
void ModuleParser::condition(Production& out, Scope& scope) {
  cursor_.skip_space();
  if (cursor_.peek() == '{') ExpressionCompiler(cursor_, scope, out.before).block();
  cursor_.skip_space();
  const char next = cursor_.peek();
  if (next == '*')
    cursor_.advance();
  else if (!at_arrow() && next != '{')
    ExpressionCompiler(cursor_, scope, out.condition).expression();
  else if (out.before.empty() && next != '{')
    cursor_.fail("a condition");
  cursor_.skip_space();
  if (cursor_.peek() == '{') ExpressionCompiler(cursor_, scope, out.after).block();
  cursor_.skip_space();
}

void ModuleParser::weight(Production& out, Scope& scope) {
  if (!cursor_.accept(':')) return;
  cursor_.skip_space();
  out.weight_place = cursor_.place();
  ExpressionCompiler(cursor_, scope, out.weight).expression();
}

Production ModuleParser::production() {
  Production out;
  Scope scope = globals_;
  scope.assigns_globals = false;
  out.place = cursor_.place();
  const std::size_t begin = cursor_.position();
  const Predecessors parts = predecessors(scope);
  for (const FormalModule& module : parts.strict) out.predecessor.push_back(module.module);
  for (auto left = parts.left.rbegin(); left != parts.left.rend(); ++left) out.left.push_back(left->module);
  for (const FormalModule& module : parts.right) out.right.push_back(module.module);
  {
    const Cursor::LineEnds inside(cursor_, true);
    if (cursor_.accept(':')) condition(out, scope);
    refuse_object_production();
    if (!at_arrow()) cursor_.fail(cursor_.peek() == '=' ? "'==' or '-->'" : "'-->'");
    cursor_.advance(3);
  }
  out.successor = successor(scope);
  weight(out, scope);
  cursor_.skip_space();
  if (!cursor_.at_line_end()) cursor_.fail("a module, ':' or the end of the line");
  out.local_count = static_cast<std::uint32_t>(scope.locals.size());
  if (cursor_.position() == begin) cursor_.fail("a production");
  return out;
}

}  // namespace cambium
