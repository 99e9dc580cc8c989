// L-Py (Boudon, Pradal, Cokelaer, Prusinkiewicz, Godin 2012): Python with L-system rules in it. What is read here is the
// rules, and of Python numbers that have names, and bodies of rules that do no more than choose what to produce.
#include <string>
#include <utility>
#include <vector>

#include "lsystem/dialect_text.h"
#include "lsystem/dialect_translation.h"
#include "lsystem/lpy_cursor.h"
#include "lsystem/lpy_strings.h"
#include "lsystem/python_expression.h"

namespace cambium {
namespace {

constexpr int kMaxBlocks = 100;  // inside of each other

class LpyReader {
 public:
  explicit LpyReader(const SourceText& source) : source_(source), in_(source), strings_(in_) {}

  SourceText read() {
    append(out_, "lsystem: lpy\n", Place{1, 1, 0});
    while (in_.next_line()) {
      if (in_.line_indent() > 0) in_.fail("a rule, a section or an assignment at the beginning of the line");
      if (!section()) break;
    }
    if (!axiom_seen_) in_.fail("'Axiom:'");
    if (!length_seen_) append(out_, "derivation length: 1\n", in_.place());
    append(out_, "endlsystem\n", in_.place());
    return marked_source(out_, source_);
  }

 private:
  // ---- sections --------------------------------------------------------------------------------------------------
  /// One line at the margin and all that belongs to it; false at `endlsystem`.
  bool section() {
    const std::size_t begin = in_.position();
    const std::string word = in_.word();
    in_.skip_space();
    if (word == "endlsystem") return false;
    if (word == "module") return declare();
    if (word == "from") return import_math(begin);
    if (word == "group" || word == "endgroup")
      in_.fail_at(begin, "'" + word + "', which needs useGroup() of Python", "rules without groups");
    if (is_python_keyword(word)) in_.fail_python(begin, word);
    if (word == "derivation" || word == "maximum") return number_of(word, begin);
    if (in_.peek() == ':' && keyed(word, begin)) return true;
    if (in_.peek() == '=' && in_.peek(1) != '=' && !word.empty()) return assign(word, begin);
    in_.seek(begin);
    if (in_.looking_at("@static")) in_.fail_python(begin, "@static");
    rule();
    return true;
  }

  // `module A, B(x)`: what stands in the parentheses is for the reader.
  bool declare() {
    do {
      in_.skip_space();
      const std::string name = in_.word();
      if (name.empty()) in_.fail("the name of a module");
      strings_.symbols.declare(name);
      in_.skip_space();
      if (in_.peek() == '(') skip_parentheses();
      in_.accept(',');
      in_.skip_space();
    } while (!in_.at_line_end() && starts_word(in_.peek()));
    in_.end_line();
    return true;
  }

  void skip_parentheses() {
    const std::size_t open = in_.position();
    while (in_.peek() != ')') {
      if (in_.at_line_end()) in_.fail_at(open, "'(' without an end", "')' on the same line");
      in_.advance();
    }
    in_.advance();
  }

  bool import_math(std::size_t begin) {
    const std::string module = in_.word();
    in_.skip_space();
    if (module != "math" || in_.word() != "import") in_.fail_python(begin, "from " + module);
    while (!in_.at_line_end()) in_.advance();
    strings_.names.math = true;
    return true;
  }

  bool number_of(const std::string& word, std::size_t begin) {
    const bool length = word == "derivation";
    const std::size_t at = in_.position();
    if (in_.word() != (length ? "length" : "depth")) in_.fail_at(at, in_.describe(at), length ? "'length'" : "'depth'");
    in_.expect(':', length ? "after 'derivation length'" : "after 'maximum depth'");
    in_.skip_space();
    const MarkedText value = python_expression(in_, strings_.names);
    in_.end_line();
    append(out_, length ? "derivation length: " : "maximum depth: ", in_.place_of(begin));
    append(out_, value);
    end_statement();
    length_seen_ = length_seen_ || length;
    return true;
  }

  /// A section that begins with one word and a colon; false if the word is none of these.
  bool keyed(const std::string& word, std::size_t begin) {
    if (word == "Axiom" || word == "axiom") {
      if (axiom_seen_) in_.fail_at(begin, "a second axiom", "one");
      axiom_seen_ = true;
      in_.advance();
      append(out_, "axiom: ", in_.place_of(begin));
      append(out_, strings_.successor(0));
      end_statement();
    } else if (word == "production" || word == "decomposition" || word == "homomorphism" || word == "interpretation") {
      in_.advance();
      in_.end_line();
      append(out_, word + ":\n", in_.place_of(begin));
      in_rules_ = true;
    } else if (word == "consider" || word == "ignore") {
      in_.advance();
      append(out_, word + ": ", in_.place_of(begin));
      for (in_.skip_space(); !in_.at_line_end(); in_.skip_space()) {
        const Place place = in_.place();
        const std::string name = strings_.symbols.read(in_);
        if (name.empty()) in_.fail("a module's name");
        append_symbol(out_, name, place);
      }
      end_statement();
    } else {
      return false;
    }
    return true;
  }

  bool assign(const std::string& name, std::size_t begin) {
    if (in_rules_) in_.fail_python(begin, name + " =");
    in_.advance();
    in_.skip_space();
    strings_.names.constants[name] = constant_of(python_expression(in_, strings_.names), source_);
    in_.end_line();
    return true;
  }

  void end_statement() { append(out_, "\n", in_.place()); }

  // ---- rules -----------------------------------------------------------------------------------------------------
  void rule() {
    if (!in_rules_) in_.fail("'production:' before the first rule");
    strings_.names.parameters.clear();
    pattern_ = strings_.predecessors();
    if (in_.looking_at("-->")) {
      in_.advance(3);
      return produce(0);
    }
    if (in_.looking_at("-static->")) in_.fail_python(in_.position(), "-static->");
    in_.expect(':', "or '-->'");
    in_.skip_space();
    if (in_.rest_of_line().find("-->") != std::string_view::npos) {
      guards_ = {python_expression(in_, strings_.names)};
      in_.skip_space();
      if (!in_.looking_at("-->")) in_.fail("'-->'");
      in_.advance(3);
      produce(0);
    } else {
      suite(0);
    }
    guards_.clear();
  }

  /// The successor at the head, under all conditions around it.
  void produce(int indent) {
    append(out_, pattern_);
    const Place place = in_.place();
    for (std::size_t i = 0; i < guards_.size(); ++i) {
      append(out_, i == 0 ? " : " : " && ", place);
      append(out_, guards_[i]);
    }
    append(out_, " --> ", place);
    append(out_, strings_.successor(indent));
    end_statement();
    if (out_.size() > kMostText) in_.fail("simpler rules before here");
  }

  /// What follows the colon of a rule or of an `if` in a line of this indentation.
  void suite(int indent) {
    if (++blocks_ > kMaxBlocks) in_.fail_at(in_.position(), "blocks deeper than 100", "a simpler rule");
    in_.skip_space();
    if (!in_.at_line_end()) {
      statement(indent);
    } else {
      const std::size_t line_end = in_.position();
      if (!in_.enter_deeper_line(indent)) in_.fail_at(line_end, in_.describe(line_end), "an indented body");
      const int inner = in_.line_indent();
      std::size_t before = in_.position();
      do {
        if (in_.line_indent() != inner) in_.fail("a line that is indented as the one before it");
        statement(inner);
        before = in_.position();
      } while (in_.next_line() && in_.line_indent() > indent);
      in_.seek(before);
    }
    --blocks_;
  }

  void statement(int indent) {
    const std::size_t at = in_.position();
    const std::string word = in_.word();
    if (word == "produce") return produce(indent);
    if (word == "if") return choose(indent);
    if (word == "pass") return in_.end_line();
    if (!is_python_keyword(word) || word == "elif" || word == "else")
      in_.fail_at(at, in_.describe(at) + ", which is embedded Python", "'produce', 'if' or 'pass'");
    in_.fail_python(at, word);
  }

  // Every branch holds under its condition, and where none before it does.
  void choose(int indent) {
    const std::size_t outside = guards_.size();
    branch(indent);
    while (in_.enter_word(indent, "elif")) {
      negate_last_guard();
      branch(indent);
    }
    if (in_.enter_word(indent, "else")) {
      negate_last_guard();
      in_.expect(':', "after 'else'");
      suite(indent);
    }
    guards_.resize(outside);
  }

  void branch(int indent) {
    guards_.push_back(python_expression(in_, strings_.names));
    in_.expect(':', "after the condition");
    suite(indent);
  }

  void negate_last_guard() {
    MarkedText negated;
    append(negated, "(!", guards_.back().front().place);
    append(negated, guards_.back());
    append(negated, ")", guards_.back().front().place);
    guards_.back() = std::move(negated);
  }

  static constexpr std::size_t kMostText = 4'000'000;

  const SourceText& source_;
  LpyCursor in_;
  LpyStrings strings_;
  MarkedText out_;
  bool axiom_seen_ = false, length_seen_ = false;
  bool in_rules_ = false;           // behind `production:` or the like
  MarkedText pattern_;              // of the rule being read
  std::vector<MarkedText> guards_;  // conditions around what is being read
  int blocks_ = 0;
};

}  // namespace

SourceText cpfg_from_lpy(std::string_view text, const std::filesystem::path& file) {
  const SourceText source = lpy_source(text, file);
  return LpyReader(source).read();
}

}  // namespace cambium
