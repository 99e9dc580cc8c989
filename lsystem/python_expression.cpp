#include "lsystem/python_expression.h"

#include <algorithm>
#include <iterator>
#include <numbers>
#include <string_view>
#include <utility>

#include "lsystem/expression_compiler.h"

namespace cambium {
namespace {

constexpr int kMaxNesting = 60;
constexpr std::size_t kMaxLength = 100'000;  // `%` and chained comparisons write their operands twice

constexpr std::string_view kDegree = "*57.295779513082321";        // radians to degrees
constexpr std::string_view kRadian = "*0.017453292519943295";

/// What cpfg writes around and behind the argument of a function.
struct PythonFunction {
  std::string_view name;
  bool of_math;                 // else Python's own
  int arity;
  std::string_view cpfg;        // empty: the argument itself
  std::string_view on_argument, on_result;
};

constexpr PythonFunction kFunctions[] = {
    {"abs", false, 1, "fabs", "", ""},      {"float", false, 1, "", "", ""},        {"int", false, 1, "trunc", "", ""},
    {"max", false, 2, "max", "", ""},       {"min", false, 2, "min", "", ""},       {"pow", false, 2, "pow", "", ""},
    {"sin", true, 1, "sin", kDegree, ""},   {"cos", true, 1, "cos", kDegree, ""},   {"tan", true, 1, "tan", kDegree, ""},
    {"asin", true, 1, "asin", "", kRadian}, {"acos", true, 1, "acos", "", kRadian}, {"atan", true, 1, "atan", "", kRadian},
    {"atan2", true, 2, "atan2", "", kRadian}, {"exp", true, 1, "exp", "", ""},      {"log", true, 1, "log", "", ""},
    {"sqrt", true, 1, "sqrt", "", ""},      {"floor", true, 1, "floor", "", ""},    {"ceil", true, 1, "ceil", "", ""},
    {"trunc", true, 1, "trunc", "", ""},    {"fabs", true, 1, "fabs", "", ""},
    {"radians", true, 1, "", "", kRadian},  {"degrees", true, 1, "", "", kDegree},
};

class Translator {
 public:
  Translator(Cursor& in, const PythonNames& names) : in_(in), names_(names) {}

  MarkedText expression() {
    const Nesting nesting(*this);
    MarkedText value = disjunction();
    const Place place = head();
    if (accept_word("if")) {
      MarkedText condition = disjunction();
      head();
      if (!accept_word("else")) in_.fail("'else' of the conditional expression");
      const MarkedText otherwise = expression();
      value = join(place, {"(", &condition, "?", &value, ":", &otherwise, ")"});
    }
    return value;
  }

 private:
  /// One level deeper into the text.
  class Nesting {
   public:
    explicit Nesting(Translator& of) : of_(of) {
      if (++of_.nesting_ > kMaxNesting)
        of_.in_.fail_at(of_.in_.position(), "nesting deeper than 60", "a simpler expression");
    }
    ~Nesting() { --of_.nesting_; }
    Nesting(const Nesting&) = delete;
    Nesting& operator=(const Nesting&) = delete;

   private:
    Translator& of_;
  };

  /// A piece of an expression: either text or an expression.
  struct Piece {
    Piece(const char* words) : text(words) {}
    Piece(std::string_view words) : text(words) {}
    Piece(const MarkedText* inner) : expression(inner) {}
    std::string_view text;
    const MarkedText* expression = nullptr;
  };

  MarkedText join(const Place& place, std::initializer_list<Piece> pieces) const {
    MarkedText out;
    for (const Piece& piece : pieces) {
      if (piece.expression)
        append(out, *piece.expression);
      else
        append(out, piece.text, place);
    }
    if (out.size() > kMaxLength) in_.fail("a shorter expression before it");
    return out;
  }

  Place head() {
    in_.skip_space();
    return in_.place();
  }

  bool accept_word(std::string_view word) {
    in_.skip_space();
    if (!in_.looking_at(word) || in_word(in_.peek(word.size()))) return false;
    in_.advance(word.size());
    return true;
  }

  bool at_arrow() const { return in_.looking_at("-->"); }

  // Operands between words such as `and`, in parentheses if there are several.
  MarkedText chain(MarkedText (Translator::*operand)(), std::string_view word, std::string_view cpfg) {
    MarkedText out = (this->*operand)();
    bool several = false;
    for (Place place = head(); accept_word(word); place = head()) {
      const MarkedText next = (this->*operand)();
      out = join(place, {&out, cpfg, &next});
      several = true;
    }
    return several ? join(out.front().place, {"(", &out, ")"}) : out;
  }

  MarkedText disjunction() { return chain(&Translator::conjunction, "or", "||"); }
  MarkedText conjunction() { return chain(&Translator::negation, "and", "&&"); }

  MarkedText negation() {
    const Place place = head();
    if (!accept_word("not")) return comparison();
    const Nesting nesting(*this);
    const MarkedText operand = negation();
    return join(place, {"(!", &operand, ")"});
  }

  std::string_view comparison_operator() {
    in_.skip_space();
    for (const std::string_view op : {"==", "!=", "<>", "<=", ">=", "<", ">"})
      if (in_.looking_at(op)) return op;
    return {};
  }

  // `a < b < c` is `a < b and b < c`.
  MarkedText comparison() {
    MarkedText left = sum();
    MarkedText out;
    for (std::string_view op = comparison_operator(); !op.empty(); op = comparison_operator()) {
      const Place place = in_.place();
      in_.advance(op.size());
      MarkedText right = sum();
      const MarkedText one = join(place, {"(", &left, op, &right, ")"});
      out = out.empty() ? one : join(place, {"(", &out, "&&", &one, ")"});
      left = std::move(right);
    }
    return out.empty() ? left : out;
  }

  MarkedText sum() {
    MarkedText out = product();
    bool several = false;
    for (Place place = head(); (in_.peek() == '+' || in_.peek() == '-') && !at_arrow(); place = head()) {
      const char op[] = {in_.peek(), '\0'};
      in_.advance();
      const MarkedText next = product();
      out = join(place, {&out, op, &next});
      several = true;
    }
    return several ? join(out.front().place, {"(", &out, ")"}) : out;
  }

  MarkedText product() {
    MarkedText out = signed_value();
    for (Place place = head();; place = head()) {
      const char c = in_.peek();
      const bool floors = c == '/' && in_.peek(1) == '/';
      if (c != '*' && c != '/' && c != '%') return out;
      in_.advance(floors ? 2 : 1);
      const MarkedText next = signed_value();
      if (floors)
        out = join(place, {"floor(", &out, "/", &next, ")"});
      else if (c == '%')
        out = join(place, {"(", &out, "-", &next, "*floor(", &out, "/", &next, "))"});
      else
        out = join(place, {"(", &out, c == '*' ? "*" : "/", &next, ")"});
    }
  }

  MarkedText signed_value() {
    const Place place = head();
    const char c = in_.peek();
    if ((c != '-' && c != '+') || at_arrow()) return power();
    in_.advance();
    const Nesting nesting(*this);
    const MarkedText operand = signed_value();
    return c == '-' ? join(place, {"(-", &operand, ")"}) : operand;
  }

  MarkedText power() {
    const MarkedText base = atom();
    const Place place = head();
    if (!in_.looking_at("**")) return base;
    in_.advance(2);
    const Nesting nesting(*this);
    const MarkedText exponent = signed_value();
    return join(place, {"(", &base, "^", &exponent, ")"});
  }

  MarkedText atom() {
    const Place place = head();
    const std::size_t begin = in_.position();
    if (in_.peek() == '(') {
      in_.advance();
      const Cursor::LineEnds inside(in_, true);
      MarkedText value = expression();
      in_.expect_close(begin, "or an operator");
      return value;
    }
    if (is_digit(in_.peek()) || (in_.peek() == '.' && is_digit(in_.peek(1)))) return number(begin, place);
    const std::string name = in_.word();
    if (name.empty()) {
      const std::string_view others = "[{'\"`";
      in_.fail_at(begin, in_.describe(begin),
                  others.find(in_.peek()) != others.npos && !in_.at_end() ? "a number: lists, texts and the like are Python"
                                                                          : "an expression");
    }
    if (in_.peek() == '.') in_.fail("an operator: attributes are Python");
    in_.skip_space();
    return in_.peek() == '(' ? call(name, begin) : named(name, begin);
  }

  MarkedText number(std::size_t begin, const Place& place) {
    const double value = read_number(in_);
    if (in_word(in_.peek())) in_.fail_at(begin, in_.describe(begin), "a decimal number");
    MarkedText out;
    append_number(out, value, place);
    return out;
  }

  MarkedText named(const std::string& name, std::size_t begin) {
    MarkedText out;
    const Place place = in_.place_of(begin);
    const auto constant = names_.constants.find(name);
    if (std::find(names_.parameters.begin(), names_.parameters.end(), name) != names_.parameters.end())
      append(out, name, place);
    else if (constant != names_.constants.end())
      append_number(out, constant->second, place);
    else if (name == "True" || name == "False")
      append_number(out, name == "True", place);
    else if (names_.math && (name == "pi" || name == "e"))
      append_number(out, name == "e" ? std::numbers::e : std::numbers::pi, place);
    else
      in_.fail_at(begin, "'" + name + "'",
                  is_python_keyword(name) ? "a number: this is Python"
                                          : "a parameter of the rule, or a number assigned before the axiom");
    return out;
  }

  MarkedText call(const std::string& name, std::size_t begin) {
    const auto function = std::find_if(std::begin(kFunctions), std::end(kFunctions), [&](const PythonFunction& f) {
      return f.name == name && (!f.of_math || names_.math);
    });
    if (function == std::end(kFunctions))
      in_.fail_at(begin, "'" + name + "(', a function of Python",
                  "abs, float, int, max, min or pow, or one of math's after 'from math import *'");
    const std::size_t open = in_.position();
    const Place place = in_.place_of(begin);
    in_.advance();
    const Cursor::LineEnds inside(in_, true);
    std::vector<MarkedText> arguments;
    do arguments.push_back(expression());
    while (in_.accept(','));
    in_.expect_close(open, "or ','");
    if (static_cast<int>(arguments.size()) != function->arity)
      in_.fail_at(begin, "'" + name + "' of " + std::to_string(arguments.size()), std::to_string(function->arity));
    if (function->arity == 1)
      return join(place, {"(", function->cpfg, "(", &arguments[0], function->on_argument, ")", function->on_result, ")"});
    return join(place, {"(", function->cpfg, "(", &arguments[0], ",", &arguments[1], ")", function->on_result, ")"});
  }

  Cursor& in_;
  const PythonNames& names_;
  int nesting_ = 0;
};

}  // namespace

MarkedText python_expression(Cursor& in, const PythonNames& names) { return Translator(in, names).expression(); }

bool is_python_keyword(const std::string& word) {
  static constexpr std::string_view kWords[] = {
      "and",    "as",     "assert", "async",    "await", "break", "class", "continue", "def",    "del",      "elif",
      "else",   "except", "exec",   "finally",  "for",   "from",  "global", "if",      "import", "in",       "is",
      "lambda", "nonlocal", "not",  "or",       "pass",  "print", "raise", "return",   "try",    "while",    "with",
      "yield",  "lpyimport", "nproduce", "sproduce", "nsproduce", "produce"};
  return std::find(std::begin(kWords), std::end(kWords), word) != std::end(kWords);
}

}  // namespace cambium
