// L-Py (Boudon, Pradal, Cokelaer, Prusinkiewicz, Godin 2012): Python with L-system rules in it. What is read here is the rules, and
// of Python numbers that have names, and bodies of rules that do no more than choose what to produce.
#include <algorithm>
#include <string>
#include <utility>
#include <vector>

#include "lsystem/dialect.h"
#include "lsystem/dialect_text.h"
#include "lsystem/lpy_symbols.h"
#include "lsystem/module_parser.h"
#include "lsystem/python_expression.h"

namespace cambium {
namespace {

constexpr int kMaxBlocks = 100;  // inside of each other

/// The file up to `endlsystem`, without comments and texts that stand by themselves.
SourceText without_comments(std::string_view text, const std::filesystem::path& file) {
  const SourceText all = as_it_stands(text, file);
  SourceText out;
  out.files = all.files;
  out.end = all.end;
  const std::string& from = all.text;
  const auto copy = [&](std::size_t i) { out.append(from[i], all.places[i]); };
  for (std::size_t i = 0; i < from.size();) {
    const std::string_view three = std::string_view(from).substr(i, 3);
    if (from[i] == '#') {
      while (i < from.size() && from[i] != '\n') ++i;
    } else if (three == "\"\"\"" || three == "'''") {
      const std::size_t end = from.find(three, i + 3);
      if (end == from.npos) throw InputError(located(all.files, all.places[i]), "a text without an end", std::string(three));
      for (; i < end + 3; ++i)
        if (from[i] == '\n') copy(i);
    } else if (from[i] == '"') {
      do copy(i++);
      while (i < from.size() && from[i] != '"' && from[i] != '\n');
      if (i < from.size() && from[i] == '"') copy(i++);
    } else {
      copy(i++);
    }
  }
  return out;
}

class LpyReader {
 public:
  explicit LpyReader(const SourceText& source) : source_(source), in_(source) {}

  SourceText read() {
    append(out_, "lsystem: lpy\n", Place{1, 1, 0});
    while (next_line()) {
      if (line_indent() > 0) in_.fail("a rule, a section or an assignment at the beginning of the line");
      if (!section()) break;
    }
    if (!axiom_seen_) in_.fail("'Axiom:'");
    if (!length_seen_) append(out_, "derivation length: 1\n", in_.place());
    append(out_, "endlsystem\n", in_.place());
    return marked_source(out_, source_);
  }

 private:
  // ---- lines -----------------------------------------------------------------------------------------------------
  bool next_line() {
    in_.skip_blank_lines();
    return !in_.at_end();
  }

  /// Columns of white space before the first character of the line at the head; a tab leads to the next multiple of 8.
  int line_indent() const {
    const std::string& text = source_.text;
    const std::size_t before = in_.position() == 0 ? text.npos : text.rfind('\n', in_.position() - 1);
    int indent = 0;
    for (std::size_t i = before == text.npos ? 0 : before + 1; i < in_.position(); ++i)
      indent = text[i] == '\t' ? (indent / 8 + 1) * 8 : indent + 1;
    return indent;
  }

  /// Whether the next line that is not blank is indented deeper; then the head moves to it.
  bool enter_deeper_line(int indent) {
    const std::size_t before = in_.position();
    if (next_line() && line_indent() > indent) return true;
    in_.seek(before);
    return false;
  }

  /// Whether the next line that is not blank has this indentation, and this word; then the head moves behind it.
  bool enter_word(int indent, std::string_view word) {
    const std::size_t before = in_.position();
    if (next_line() && line_indent() == indent && in_.word() == word) return true;
    in_.seek(before);
    return false;
  }

  void end_line() {
    in_.skip_space();
    if (!in_.at_line_end()) in_.fail("the end of the line");
  }

  [[noreturn]] void fail_python(std::size_t at, const std::string& what) {
    in_.fail_at(at, "'" + what + "', which is embedded Python", "what docs/lsystems.md lists of L-Py");
  }

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
    if (is_python_keyword(word)) fail_python(begin, word);
    if (word == "derivation" || word == "maximum") return number_of(word, begin);
    if (in_.peek() == ':' && keyed(word, begin)) return true;
    if (in_.peek() == '=' && in_.peek(1) != '=' && !word.empty()) return assign(word, begin);
    in_.seek(begin);
    if (in_.peek() == '@' && starts_word(in_.peek(1)) && in_.looking_at("@static")) fail_python(begin, "@static");
    rule();
    return true;
  }

  // `module A, B(x)`: what stands in the parentheses is for the reader.
  bool declare() {
    do {
      in_.skip_space();
      const std::string name = in_.word();
      if (name.empty()) in_.fail("the name of a module");
      symbols_.declare(name);
      in_.skip_space();
      if (in_.peek() == '(') skip_parentheses();
      in_.accept(',');
      in_.skip_space();
    } while (!in_.at_line_end() && starts_word(in_.peek()));
    end_line();
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
    if (module != "math" || in_.word() != "import") fail_python(begin, "from " + module);
    while (!in_.at_line_end()) in_.advance();
    names_.math = true;
    return true;
  }

  bool number_of(const std::string& word, std::size_t begin) {
    const bool length = word == "derivation";
    const std::size_t at = in_.position();
    if (in_.word() != (length ? "length" : "depth")) in_.fail_at(at, in_.describe(at), length ? "'length'" : "'depth'");
    in_.expect(':', length ? "after 'derivation length'" : "after 'maximum depth'");
    in_.skip_space();
    const MarkedText value = python_expression(in_, names_);
    end_line();
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
      append(out_, modules(0));
      end_statement();
    } else if (word == "production" || word == "decomposition" || word == "homomorphism" || word == "interpretation") {
      in_.advance();
      end_line();
      append(out_, word + ":\n", in_.place_of(begin));
      in_rules_ = true;
    } else if (word == "consider" || word == "ignore") {
      in_.advance();
      append(out_, word + ": ", in_.place_of(begin));
      for (in_.skip_space(); !in_.at_line_end(); in_.skip_space()) {
        const Place place = in_.place();
        const std::string name = symbols_.read(in_);
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
    if (in_rules_) fail_python(begin, name + " =");
    in_.advance();
    in_.skip_space();
    names_.constants[name] = constant_of(python_expression(in_, names_), source_);
    end_line();
    return true;
  }

  void end_statement() { append(out_, "\n", in_.place()); }

  // ---- modules ---------------------------------------------------------------------------------------------------
  /// A successor up to the end of its line, and over further ones that are indented deeper than `indent`. `*`, or nothing: none.
  MarkedText modules(int indent) {
    MarkedText out;
    const std::size_t begin = in_.position();
    in_.skip_space();
    if (in_.accept('*')) {
      end_line();
    } else {
      refuse_statement();
      while (true) {
        in_.skip_space();
        if (in_.at_line_end()) {
          if (!enter_deeper_line(indent)) break;
          refuse_statement();
        }
        append(out, module_here());
      }
    }
    if (out.empty()) append(out, "*", in_.place_of(begin));
    return out;
  }

  // Python that stands where modules could: its words would be read as modules of one letter each.
  void refuse_statement() {
    const std::size_t at = in_.position();
    const std::string word = in_.word();
    if (is_python_keyword(word)) fail_python(at, word);
    in_.seek(at);
  }

  MarkedText module_here() {
    const std::size_t at = in_.position();
    const std::string name = symbols_.read(in_);
    if (name.empty()) in_.fail_at(at, in_.describe(at), "a module, or the end of the line");
    MarkedText out;
    append_symbol(out, name, in_.place_of(at));
    in_.skip_space();
    if (in_.peek() != '(') return out;
    const std::size_t open = in_.position();
    in_.advance();
    const Cursor::LineEnds inside(in_, true);
    if (in_.accept(')')) return out;
    char before = '(';
    do {
      out.push_back({before, in_.place_of(open)});
      append(out, argument());
      before = ',';
    } while (in_.accept(','));
    out.push_back({')', in_.place()});
    in_.expect_close(open, "or ','");
    return out;
  }

  // A number, or the text of a label, which is not drawn.
  MarkedText argument() {
    in_.skip_space();
    if (in_.peek() != '"') return python_expression(in_, names_);
    const std::size_t begin = in_.position();
    do in_.advance();
    while (in_.peek() != '"' && !in_.at_line_end());
    if (in_.at_line_end()) in_.fail_at(begin, "a text without an end", "'\"'");
    in_.advance();
    MarkedText out;
    append_number(out, 0, in_.place_of(begin));
    return out;
  }

  // ---- rules -----------------------------------------------------------------------------------------------------
  void rule() {
    if (!in_rules_) in_.fail("'production:' before the first rule");
    names_.parameters.clear();
    pattern_ = predecessors();
    if (in_.looking_at("-->")) {
      in_.advance(3);
      return produce(0);
    }
    if (in_.looking_at("-static->")) fail_python(in_.position(), "-static->");
    in_.expect(':', "or '-->'");
    in_.skip_space();
    if (rest_of_line().find("-->") != std::string_view::npos) {
      guards_ = {python_expression(in_, names_)};
      in_.skip_space();
      if (!in_.looking_at("-->")) in_.fail("'-->'");
      in_.advance(3);
      produce(0);
    } else {
      suite(0);
    }
    guards_.clear();
  }

  std::string_view rest_of_line() const {
    const std::string_view text = source_.text;
    return text.substr(in_.position(), text.find('\n', in_.position()) - in_.position());
  }

  /// `left < strict > right` as cpfg writes it.
  MarkedText predecessors() {
    MarkedText out;
    while (true) {
      in_.skip_space();
      const std::size_t at = in_.position();
      const char c = in_.peek();
      if (in_.looking_at("-->") || in_.looking_at("-static->") || c == ':' || in_.at_line_end()) break;
      if (in_.looking_at("<<") || in_.looking_at(">>"))
        in_.fail_at(at, std::string("'") + c + c + "', a context in the string that is being made", "'<' or '>'");
      if (c == '<' || c == '>') {
        in_.advance();
        out.push_back({c, in_.place_of(at)});
      } else {
        append(out, formal_module());
      }
    }
    if (out.empty()) in_.fail("a rule, a section or an assignment");
    return out;
  }

  MarkedText formal_module() {
    const std::size_t at = in_.position();
    if (in_.looking_at("=]") || in_.peek() == '*' || in_.looking_at("x("))
      in_.fail_at(at, in_.describe(at), "a module: patterns of L-Py are out of reach");
    const std::string name = symbols_.read(in_);
    if (name.empty()) in_.fail_at(at, in_.describe(at), "a module, ':' or '-->'");
    MarkedText out;
    append_symbol(out, name, in_.place_of(at));
    in_.skip_space();
    if (in_.peek() != '(') return out;
    const std::size_t open = in_.position();
    in_.advance();
    if (in_.accept(')')) return out;
    char before = '(';
    do {
      in_.skip_space();
      const std::size_t here = in_.position();
      const std::string parameter = in_.word();
      if (parameter.empty() || is_python_keyword(parameter)) in_.fail_at(here, in_.describe(here), "the name of a parameter");
      names_.parameters.push_back(parameter);
      out.push_back({before, in_.place_of(here)});
      append(out, parameter, in_.place_of(here));
      before = ',';
    } while (in_.accept(','));
    out.push_back({')', in_.place()});
    in_.expect_close(open, "or ','");
    return out;
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
    append(out_, modules(indent));
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
      if (!enter_deeper_line(indent)) in_.fail_at(line_end, in_.describe(line_end), "an indented body");
      const int inner = line_indent();
      std::size_t before = in_.position();
      do {
        if (line_indent() != inner) in_.fail("a line that is indented as the one before it");
        statement(inner);
        before = in_.position();
      } while (next_line() && line_indent() > indent);
      in_.seek(before);
    }
    --blocks_;
  }

  void statement(int indent) {
    const std::size_t at = in_.position();
    const std::string word = in_.word();
    if (word == "produce") return produce(indent);
    if (word == "if") return choose(indent);
    if (word == "pass") return end_line();
    if (!is_python_keyword(word) || word == "elif" || word == "else")
      in_.fail_at(at, in_.describe(at) + ", which is embedded Python", "'produce', 'if' or 'pass'");
    fail_python(at, word);
  }

  // Every branch holds under its condition, and where none before it does.
  void choose(int indent) {
    const std::size_t outside = guards_.size();
    branch(indent);
    while (enter_word(indent, "elif")) {
      negate_last_guard();
      branch(indent);
    }
    if (enter_word(indent, "else")) {
      negate_last_guard();
      in_.expect(':', "after 'else'");
      suite(indent);
    }
    guards_.resize(outside);
  }

  void branch(int indent) {
    guards_.push_back(python_expression(in_, names_));
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
  Cursor in_;
  MarkedText out_;
  LpySymbols symbols_;
  PythonNames names_;
  bool axiom_seen_ = false, length_seen_ = false;
  bool in_rules_ = false;            // behind `production:` or the like
  MarkedText pattern_;               // of the rule being read
  std::vector<MarkedText> guards_;   // conditions around what is being read
  int blocks_ = 0;
};

}  // namespace

SourceText cpfg_from_lpy(std::string_view text, const std::filesystem::path& file) {
  const SourceText source = without_comments(text, file);
  return LpyReader(source).read();
}

}  // namespace cambium
