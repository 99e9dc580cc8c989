#include "lsystem/module_parser.h"

#include <algorithm>
#include <string_view>
#include <utility>

namespace cambium {
namespace {

constexpr std::size_t kMaxParameters = 1000;
constexpr std::string_view kSymbolMarks = "+-&^\\/|$[]{}.!#;,'%_=?";

bool symbol_at(const Cursor& cursor) {
  const char c = cursor.peek();
  if (c == '\0' || cursor.looking_at("-->")) return false;
  return in_word(c) || c == '@' || c == '~' || kSymbolMarks.find(c) != std::string_view::npos;
}

}  // namespace

std::string lower_case(std::string word) {
  for (char& c : word)
    if (c >= 'A' && c <= 'Z') c = static_cast<char>(c - 'A' + 'a');
  return word;
}

bool is_keyword(const std::string& word) {
  static constexpr std::string_view kWords[] = {
      "lsystem", "endlsystem", "seed", "derivation", "define", "ring", "consider", "ignore", "start", "starteach", "endeach",
      "end", "axiom", "homomorphism", "interpretation", "decomposition", "maximum", "production", "productions"};
  return std::find(std::begin(kWords), std::end(kWords), lower_case(word)) != std::end(kWords);
}

std::optional<std::string> ModuleParser::symbol() {
  if (!symbol_at(cursor_)) return std::nullopt;
  const std::size_t at = cursor_.position();
  std::string name(1, cursor_.peek());
  cursor_.advance();
  if (name == "@" || name == "~" || (name == "?" && starts_word(cursor_.peek()))) {
    if (!in_word(cursor_.peek())) cursor_.fail_at(at, "'" + name + "' alone", "a letter after it");
    name += cursor_.peek();
    cursor_.advance();
    static constexpr std::string_view kSecond[] = {"@Gs", "@Gc", "@Ge", "@Gr", "@Gt", "@Ts", "@Td", "@Ti", "@Tp", "@Tf"};
    if (std::find(std::begin(kSecond), std::end(kSecond), name + cursor_.peek()) != std::end(kSecond)) {
      name += cursor_.peek();
      cursor_.advance();
    }
  }
  return name;
}

std::uint16_t ModuleParser::number(const std::string& name, std::size_t at) {
  const std::uint16_t number = program_.symbols.number(name);
  if (program_.symbols.names().size() >= SymbolTable::kMaxSymbols) cursor_.fail_at(at, "too many symbols", "fewer than 65535");
  return number;
}

// At a line end: whether the next line that is not blank goes on with the successor. It does if it is indented, or inside brackets, and
// nothing in it makes it a production or a keyword of its own. Leaves the cursor there if so.
bool ModuleParser::line_continues(bool inside_brackets) {
  const std::string& text = cursor_.source().text;
  const std::size_t before = cursor_.position();
  cursor_.skip_blank_lines();
  const std::size_t first = cursor_.position();
  const bool indented = first > 0 && (text[first - 1] == ' ' || text[first - 1] == '\t');
  std::size_t end = text.find('\n', first);
  if (end == std::string::npos) end = text.size();
  const std::string_view line(text.data() + first, end - first);
  const std::string word = cursor_.word();
  std::size_t next = end;
  while (next < text.size() && (text[next] == '\n' || text[next] == ' ' || text[next] == '\t')) ++next;
  const bool goes_on = (indented || inside_brackets) && first < text.size() && !is_keyword(word) && line.find("-->") == std::string_view::npos &&
                       line.find(':') == std::string_view::npos && text.compare(next, 3, "-->") != 0;
  cursor_.seek(goes_on ? first : before);
  return goes_on;
}

void ModuleParser::modules(Successor& out, Scope& scope) {
  std::vector<std::size_t> open;
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
    cursor_.skip_space();
    std::size_t arity = 0;
    if (cursor_.peek() == '(') {
      const std::size_t open_parameters = cursor_.position();
      cursor_.advance();
      const Cursor::LineEnds inside(cursor_, true);
      do {
        compiler.expression();
        if (++arity > kMaxParameters) cursor_.fail("fewer than 1000 parameters");
      } while (cursor_.accept(','));
      cursor_.expect_close(open_parameters, "or ','");
    }
    out.arities.push_back(static_cast<std::uint16_t>(arity));
    out.parameter_count += arity;
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
  std::uint16_t number = 0;
  std::uint16_t arity = 0;
  std::uint32_t first_local = 0;
};

ModuleParser::FormalModule ModuleParser::formal(Scope& scope) {
  FormalModule out;
  out.at = cursor_.position();
  const auto name = symbol();
  if (!name) cursor_.fail("a module or '-->'");
  out.name = *name;
  out.number = number(*name, out.at);
  out.first_local = static_cast<std::uint32_t>(scope.locals.size());
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
    if (++out.arity > kMaxParameters) cursor_.fail("fewer than 1000 parameters");
  } while (cursor_.accept(','));
  cursor_.expect(')', "or ','");
  return out;
}

ContextModule ModuleParser::context_module(const FormalModule& from) const {
  return {from.number, from.arity, from.first_local};
}

Production ModuleParser::production() {
  Production out;
  Scope scope = globals_;
  scope.assigns_globals = false;
  out.place = cursor_.place();
  const std::size_t begin = cursor_.position();
  std::vector<FormalModule> parts[3];  // left, predecessor, right
  int part = 1;
  bool left_seen = false;
  {
    const auto check_single = [&] {
      if (parts[1].size() > 1)
        cursor_.fail_at(parts[1][1].at, "'" + parts[1][1].name + "'", "one predecessor, then '<', '>', ':' or '-->'");
    };
    while (true) {
      cursor_.skip_space();
      if (cursor_.at_line_end()) {
        // The next line goes on with this production only by a mark that cannot begin one.
        const std::size_t line_end = cursor_.position();
        cursor_.skip_blank_lines();
        const char next = cursor_.peek();
        if (!cursor_.looking_at("-->") && next != ':' && next != '<' && next != '>') {
          check_single();
          cursor_.fail_at(line_end, cursor_.describe(line_end), "'-->'");
        }
      }
      if (cursor_.looking_at("-->") || cursor_.peek() == ':') break;
      if (cursor_.peek() == '<') {
        if (left_seen || part == 2) cursor_.fail("'>', ':' or '-->'");
        left_seen = true;
        if (parts[1].empty()) cursor_.fail("a left context before it");
        parts[0] = std::move(parts[1]);
        parts[1].clear();
        cursor_.advance();
      } else if (cursor_.peek() == '>') {
        if (part == 2) cursor_.fail("':' or '-->'");
        part = 2;
        cursor_.advance();
      } else {
        parts[part].push_back(formal(scope));
      }
    }
    if (parts[1].empty()) cursor_.fail("a predecessor");
    check_single();
    const Cursor::LineEnds inside(cursor_, true);
    if (part == 2 && parts[2].empty()) cursor_.fail("a right context");
    const FormalModule& predecessor = parts[1][0];
    if (predecessor.name == "[" || predecessor.name == "]")
      cursor_.fail_at(predecessor.at, "'" + predecessor.name + "'", "a predecessor that is no bracket");
    out.predecessor = context_module(predecessor);
    for (auto left = parts[0].rbegin(); left != parts[0].rend(); ++left) {
      if (left->name == "[" || left->name == "]")
        cursor_.fail_at(left->at, "'" + left->name + "' in a left context", "modules on the path to the root");
      out.left.push_back(context_module(*left));
    }
    int depth = 0;
    for (const FormalModule& right : parts[2]) {
      depth += right.name == "[" ? 1 : right.name == "]" ? -1 : 0;
      if (depth < 0) cursor_.fail_at(right.at, "']'", "a '[' before it");
      out.right.push_back(context_module(right));
    }
    if (depth > 0) cursor_.fail_at(parts[2].front().at, "a right context without ']'", "']' for each '['");

    if (cursor_.accept(':')) {
      cursor_.skip_space();
      if (cursor_.peek() == '{') ExpressionCompiler(cursor_, scope, out.before).block();
      cursor_.skip_space();
      const char next = cursor_.peek();
      if (next == '*') {
        cursor_.advance();
      } else if (!cursor_.looking_at("-->") && next != '{') {
        ExpressionCompiler(cursor_, scope, out.condition).expression();
      } else if (out.before.empty() && next != '{') {
        cursor_.fail("a condition");
      }
      cursor_.skip_space();
      if (cursor_.peek() == '{') ExpressionCompiler(cursor_, scope, out.after).block();
      cursor_.skip_space();
    }
    if (!cursor_.looking_at("-->")) cursor_.fail("'-->'");
    cursor_.advance(3);
  }
  out.successor = successor(scope);
  if (cursor_.accept(':')) {
    cursor_.skip_space();
    out.weight_place = cursor_.place();
    ExpressionCompiler(cursor_, scope, out.weight).expression();
  }
  cursor_.skip_space();
  if (!cursor_.at_line_end()) cursor_.fail("a module, ':' or the end of the line");
  out.local_count = static_cast<std::uint32_t>(scope.locals.size());
  if (cursor_.position() == begin) cursor_.fail("a production");
  return out;
}

}  // namespace cambium
