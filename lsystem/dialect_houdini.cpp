// The L-System node of Houdini: a premise, rules of one line each, and the node's values. HScript in them is out of reach.
#include <algorithm>
#include <cctype>
#include <iterator>
#include <string>
#include <utility>
#include <vector>

#include "lsystem/dialect_text.h"
#include "lsystem/dialect_translation.h"
#include "lsystem/module_parser.h"

namespace cambium {
namespace {

struct NodeValue {
  std::string_view name;  // as the node's panel calls it, in small letters
  double HoudiniValues::*value;
};

constexpr NodeValue kNodeValues[] = {
    {"step size", &HoudiniValues::step},      {"step size scale", &HoudiniValues::step_scale},
    {"angle", &HoudiniValues::angle},         {"angle scale", &HoudiniValues::angle_scale},
    {"thickness", &HoudiniValues::thickness}, {"thickness scale", &HoudiniValues::thickness_scale},
    {"gravity", &HoudiniValues::gravity},
};

constexpr std::string_view kFunctions[] = {"sin",  "cos",   "tan",  "asin", "acos", "atan", "exp", "log",
                                           "sqrt", "floor", "ceil", "min",  "max",  "pow",  "abs"};

/// Of a comparison, which is no `=` of a rule.
bool comparison_at(const Cursor& in) {
  return in.peek(1) == '=' && std::string_view("=<>!").find(in.peek()) != std::string_view::npos;
}

class HoudiniReader {
 public:
  HoudiniReader(const SourceText& source, HoudiniValues& values) : source_(source), in_(source), values_(values) {}

  SourceText read() {
    append(out_, "lsystem: houdini\n", Place{1, 1, 0});
    for (in_.skip_blank_lines(); !in_.at_end(); in_.skip_blank_lines()) {
      if (in_.peek() == '#' || in_.looking_at("//"))
        skip_line();
      else
        line();
    }
    if (!premise_seen_) in_.fail("'Premise:'");
    append(out_, "Start: { t = 0; }\nEndEach: { t = t + 1; }\n", in_.place());
    append(out_, rules_);
    append(out_, "endlsystem\n", in_.place());
    return marked_source(out_, source_);
  }

 private:
  // ---- lines -----------------------------------------------------------------------------------------------------
  void line() {
    const std::size_t begin = in_.position();
    if (keyed(begin)) return;
    in_.seek(begin);
    rule();
  }

  /// The words up to the colon or `=`, in small letters and with single spaces; the head moves behind it.
  std::string key() {
    std::string key;
    for (; !in_.at_line_end() && in_.peek() != ':' && in_.peek() != '='; in_.advance()) {
      const char c = in_.peek() == '\t' ? ' ' : in_.peek();
      if (c != ' ' || (!key.empty() && key.back() != ' '))
        key += static_cast<char>(std::tolower(static_cast<unsigned char>(c)));
    }
    if (!key.empty() && key.back() == ' ') key.pop_back();
    in_.advance();
    return key;
  }

  static bool is_rule_label(std::string_view key) {
    return key.substr(0, 4) == "rule" &&
           std::all_of(key.begin() + 4, key.end(), [](char c) { return c == ' ' || is_digit(c); });
  }

  /// A line that is no bare rule; false, the head anywhere, if it is one.
  bool keyed(std::size_t begin) {
    if (in_.word() == "var" && in_.peek() == ' ') return variable(), true;
    in_.seek(begin);
    const std::string name = key();
    const auto value = std::find_if(std::begin(kNodeValues), std::end(kNodeValues),
                                    [&](const NodeValue& candidate) { return candidate.name == name; });
    if (name == "premise") {
      premise(begin);
    } else if (is_rule_label(name)) {
      in_.skip_space();
      rule();
    } else if (value != std::end(kNodeValues)) {
      values_.*value->value = number();
    } else if (name == "generations" || name == "random seed" || name == "seed") {
      append(out_, name == "generations" ? "derivation length: " : "seed: ", in_.place_of(begin));
      append(out_, value_expression());
      end_line();
    } else if (name == "context ignore") {
      context_ignore(begin);
    } else if (name.size() == 10 && name.substr(0, 9) == "variable ") {
      set_variable(begin, name.back());
    } else {
      return false;
    }
    return true;
  }

  double number() {
    in_.skip_space();
    return constant_of(value_expression(), source_);
  }

  /// Up to a comment or the end of the line, where the head then is.
  MarkedText value_expression() {
    MarkedText out = expression([this] { return in_.at_line_end() || in_.peek() == '#'; });
    skip_line();
    return out;
  }

  void skip_line() {
    while (!in_.at_line_end()) in_.advance();
  }

  // `var b 0.3`
  void variable() {
    in_.skip_space();
    const std::size_t at = in_.position();
    const char name = in_.peek();
    in_.advance();
    in_.accept('=');
    set_variable(at, name);
  }

  void set_variable(std::size_t at, char name) {
    if (name != 'b' && name != 'c' && name != 'd') in_.fail_at(at, in_.describe(at), "the variable b, c or d");
    constants_[static_cast<std::size_t>(name - 'b')] = number();
  }

  void premise(std::size_t begin) {
    if (premise_seen_) in_.fail_at(begin, "a second premise", "one");
    premise_seen_ = true;
    parameters_.clear();
    append(rules_, "axiom: ", in_.place_of(begin));
    append(rules_, replacement());
    if (!in_.at_line_end()) in_.fail("a symbol or the end of the line");
    append(rules_, "\n", in_.place());
  }

  void context_ignore(std::size_t begin) {
    append(out_, "ignore: ", in_.place_of(begin));
    for (in_.skip_space(); !in_.at_line_end(); in_.skip_space()) symbol(out_);
    end_line();
  }

  void end_line() { append(out_, "\n", in_.place()); }

  // ---- rules -----------------------------------------------------------------------------------------------------
  /// `left < symbol > right : condition = replacement : probability`
  void rule() {
    parameters_.clear();
    append(rules_, predecessors());
    if (in_.accept(':')) {
      append(rules_, " : ", in_.place());
      append(rules_, expression([this] { return in_.peek() == '=' && !comparison_at(in_); }));
    }
    in_.expect('=', "of a rule");
    append(rules_, " --> ", in_.place());
    append(rules_, replacement());
    if (in_.accept(':')) {
      append(rules_, " : ", in_.place());
      append(rules_, expression([this] { return in_.at_line_end(); }));
    }
    if (!in_.at_line_end()) in_.fail("a symbol, ':' or the end of the line");
    append(rules_, "\n", in_.place());
  }

  MarkedText predecessors() {
    MarkedText out;
    for (in_.skip_space(); !in_.at_line_end() && in_.peek() != ':' && in_.peek() != '='; in_.skip_space()) {
      const Place place = in_.place();
      if (in_.peek() == '<' || in_.peek() == '>') {
        out.push_back({in_.peek(), place});
        in_.advance();
        continue;
      }
      symbol(out);
      in_.skip_space();
      if (in_.peek() == '(') formal_parameters(out);
    }
    if (out.empty()) in_.fail("a rule");
    return out;
  }

  void formal_parameters(MarkedText& out) {
    const std::size_t open = in_.position();
    char before = in_.peek();
    in_.advance();
    do {
      in_.skip_space();
      const Place place = in_.place();
      const std::string name = in_.word();
      if (name.empty()) in_.fail("the name of a parameter");
      parameters_.push_back(name);
      out.push_back({before, place});
      append(out, name, place);
      before = ',';
    } while (in_.accept(','));
    out.push_back({')', in_.place()});
    in_.expect_close(open, "or ','");
  }

  /// Symbols with their parameters up to a colon or the end of the line; `*` of cpfg if there are none.
  MarkedText replacement() {
    MarkedText out;
    const Place begin = in_.place();
    for (in_.skip_space(); !in_.at_line_end() && in_.peek() != ':'; in_.skip_space()) {
      symbol(out);
      in_.skip_space();
      if (in_.peek() == '(') parameters(out);
    }
    if (out.empty()) append(out, "*", begin);
    return out;
  }

  void parameters(MarkedText& out) {
    const std::size_t open = in_.position();
    char before = in_.peek();
    in_.advance();
    do {
      out.push_back({before, in_.place()});
      append(out, expression([this] { return in_.peek() == ',' || in_.peek() == ')'; }));
      before = ',';
    } while (in_.accept(','));
    out.push_back({')', in_.place()});
    in_.expect_close(open, "or ','");
  }

  void symbol(MarkedText& out) {
    const char c = in_.peek();
    if (c <= ' ' || c >= 0x7f || is_digit(c) || std::string_view("(),:=<>`").find(c) != std::string_view::npos)
      in_.fail("a symbol");
    append_symbol(out, std::string_view(&c, 1), in_.place());
    in_.advance();
  }

  // ---- expressions -----------------------------------------------------------------------------------------------
  /// HScript's are cpfg's, but for the names in them: they are copied up to where `ends` says, outside of parentheses.
  template <class Ends>
  MarkedText expression(Ends ends) {
    MarkedText out;
    in_.skip_space();
    std::vector<std::size_t> open;
    while (!in_.at_line_end() && (!open.empty() || !ends())) {
      const std::size_t at = in_.position();
      if (starts_word(in_.peek())) {
        name(out);
        continue;
      }
      const char c = in_.peek();
      if (c == '(') open.push_back(at);
      if (c == ')' && open.empty()) in_.fail("an operator");
      if (c == ')') open.pop_back();
      if (std::string_view("\"`$@'{}[]").find(c) != std::string_view::npos) in_.fail("a number: HScript is out of reach");
      const std::size_t length = is_digit(c) ? number_length() : comparison_at(in_) ? 2 : 1;
      for (std::size_t i = 0; i < length; ++i, in_.advance()) out.push_back({in_.peek(), in_.place()});
    }
    if (!open.empty()) in_.fail_at(open.back(), "'(' without an end", "')' on the same line");
    if (out.empty()) in_.fail("an expression");
    return out;
  }

  /// Of the digits at the head and what belongs to them: the `e` of an exponent is no name.
  std::size_t number_length() const {
    std::size_t length = 0;
    const auto digits = [&] {
      while (is_digit(in_.peek(length)) || in_.peek(length) == '.') ++length;
    };
    digits();
    if (length == 0 || (in_.peek(length) != 'e' && in_.peek(length) != 'E')) return length;
    const bool sign = in_.peek(length + 1) == '-' || in_.peek(length + 1) == '+';
    if (!is_digit(in_.peek(length + (sign ? 2 : 1)))) return length;
    length += sign ? 2 : 1;
    digits();
    return length;
  }

  void name(MarkedText& out) {
    const std::size_t at = in_.position();
    const Place place = in_.place();
    const std::string word = in_.word();
    in_.skip_space();
    const bool called = in_.peek() == '(';
    if (called && std::find(std::begin(kFunctions), std::end(kFunctions), word) != std::end(kFunctions))
      return append(out, word == "abs" ? "fabs" : word, place);
    if (called)
      in_.fail_at(at, "'" + word + "(', a function of HScript", "a function of numbers: sin, max, pow and their like");
    if (word == "t" || std::find(parameters_.begin(), parameters_.end(), word) != parameters_.end())
      return append(out, word, place);
    if (word == "b" || word == "c" || word == "d")
      return append_number(out, constants_[static_cast<std::size_t>(word[0] - 'b')], place);
    in_.fail_at(at, "'" + word + "'", "a parameter of the rule, or b, c, d or t: what the turtle knows is out of reach");
  }

  const SourceText& source_;
  Cursor in_;
  HoudiniValues& values_;
  MarkedText out_, rules_;               // rules stand behind the values
  std::vector<std::string> parameters_;  // of the rule being read
  double constants_[3] = {0, 0, 0};      // b, c and d
  bool premise_seen_ = false;
};

}  // namespace

SourceText cpfg_from_houdini(std::string_view text, const std::filesystem::path& file, HoudiniValues& values) {
  const SourceText source = as_it_stands(text, file);
  return HoudiniReader(source, values).read();
}

}  // namespace cambium
