// The sections of an L-system file.
#include "lsystem/lsystem.h"
#include "lsystem/module_parser.h"
#include "lsystem/preprocessor.h"
#include "lsystem/program.h"

#include <algorithm>
#include <cmath>
#include <cstdio>
#include <utility>

namespace cambium {
namespace {

constexpr std::size_t kMaxElements = 1'000'000;

bool same_modules(const std::vector<ContextModule>& a, const std::vector<ContextModule>& b) {
  return std::equal(a.begin(), a.end(), b.begin(), b.end(), [](const ContextModule& x, const ContextModule& y) {
    return x.symbol == y.symbol && x.arity == y.arity;
  });
}

class Parser {
 public:
  explicit Parser(const SourceText& source) : source_(source), cursor_(source) {}

  /// The next L-system of the file, or nullptr at its end.
  std::shared_ptr<LSystemProgram> next() {
    cursor_.skip_blank_lines();
    if (cursor_.at_end()) return nullptr;
    const std::size_t begin = cursor_.position();
    program_ = std::make_shared<LSystemProgram>();
    program_->files = source_.files;
    program_->place = cursor_.place();
    program_->open = program_->symbols.number("[");
    program_->close = program_->symbols.number("]");
    program_->cut = program_->symbols.number("%");
    scope_ = Scope{};
    names_.clear();
    global_slots_ = 0;
    axiom_seen_ = false;
    rules_ = &program_->productions;
    scope_.globals = &names_;
    scope_.global_slots = &global_slots_;
    scope_.arrays = &program_->arrays;
    if (lower_case(cursor_.word()) != "lsystem") cursor_.fail_at(begin, cursor_.describe(begin), "'lsystem:'");
    cursor_.expect(':', "after 'lsystem'");
    program_->label = rest_of_line();
    while (section(begin)) {
    }
    if (!axiom_seen_) cursor_.fail_at(begin, "an L-system without an axiom", "'axiom:'");
    program_->initial_globals.resize(global_slots_, 0.0);
    set_context_symbols();
    for (RuleSet* rules : {&program_->productions, &program_->decomposition, &program_->homomorphism}) index(*rules);
    return std::move(program_);
  }

 private:
  std::string rest_of_line() {
    const std::size_t begin = cursor_.position();
    while (!cursor_.at_line_end()) cursor_.advance();
    std::string text = source_.text.substr(begin, cursor_.position() - begin);
    const auto blank = [](char c) { return c == ' ' || c == '\t'; };
    while (!text.empty() && blank(text.back())) text.pop_back();
    text.erase(text.begin(), std::find_if_not(text.begin(), text.end(), blank));
    return text;
  }

  void end_line() {
    cursor_.skip_space();
    if (!cursor_.at_line_end()) cursor_.fail("the end of the line");
  }

  // One keyword's section or one production; false at endlsystem.
  bool section(std::size_t begin_of_system) {
    cursor_.skip_blank_lines();
    const std::size_t begin = cursor_.position();
    if (cursor_.at_end()) cursor_.fail_at(begin_of_system, "'lsystem:' without an end", "'endlsystem'");
    std::string keyword = lower_case(cursor_.word());
    if (keyword == "endlsystem") {
      end_line();
      return false;
    }
    if (keyword == "homomorphism" || keyword == "interpretation" || keyword == "decomposition") {
      rules_ = keyword == "decomposition" ? &program_->decomposition : &program_->homomorphism;
      cursor_.accept(':');
      rest_of_line();
      return true;
    }
    if (keyword == "derivation" || keyword == "maximum" || keyword == "ring") {
      cursor_.skip_space();
      const std::string second = lower_case(cursor_.word());
      const char* wanted = keyword == "derivation" ? "length" : keyword == "maximum" ? "depth" : "lsystem";
      if (second == wanted) keyword += " " + second;
    }
    cursor_.skip_space();
    if (is_keyword(keyword.substr(0, keyword.find(' '))) && cursor_.peek() == ':' && keyed(keyword, begin)) return true;
    cursor_.seek(begin);
    add(ModuleParser(cursor_, *program_, scope_).production(), begin);
    return true;
  }

  // The section of `keyword`, at its colon; false if it is no keyword that takes one.
  bool keyed(const std::string& keyword, std::size_t begin) {
    if (keyword == "production" || keyword == "productions") {
      cursor_.advance();
      rules_ = &program_->productions;
      end_line();
    } else if (keyword == "seed") {
      program_->seed = static_cast<std::uint64_t>(whole_number("a seed", 9e15));
    } else if (keyword == "derivation length") {
      program_->derivation_length = static_cast<int>(whole_number("a number of steps", 1e9));
    } else if (keyword == "maximum depth") {
      rules_->max_depth = static_cast<int>(whole_number("a depth up to 1000", 1000));
    } else if (keyword == "ring lsystem") {
      if (whole_number("0 or 1", 1) != 0) cursor_.fail_at(begin, "'ring lsystem', which is not supported yet", "no ring");
    } else if (keyword == "consider" || keyword == "ignore") {
      cursor_.advance();
      context_symbols(keyword == "consider", begin);
    } else if (keyword == "define") {
      cursor_.advance();
      define_arrays();
    } else if (keyword == "axiom") {
      if (axiom_seen_) cursor_.fail_at(begin, "a second axiom", "one");
      axiom_seen_ = true;
      cursor_.advance();
      Scope scope = scope_;
      program_->axiom = ModuleParser(cursor_, *program_, scope_).successor(scope);
      end_line();
    } else if (keyword == "start" || keyword == "starteach" || keyword == "endeach" || keyword == "end") {
      cursor_.advance();
      statements(keyword == "start"       ? program_->start
                 : keyword == "starteach" ? program_->start_each
                 : keyword == "endeach"   ? program_->end_each
                                          : program_->end);
    } else {
      return false;
    }
    return true;
  }

  double whole_number(const char* what, double most) {
    cursor_.advance();
    cursor_.skip_space();
    const std::size_t at = cursor_.position();
    Code code;
    Scope none;
    ExpressionCompiler(cursor_, none, code).expression();
    CounterRandom random(0);
    const std::vector<ArrayInfo> no_arrays;
    const double value = Machine(source_.files, no_arrays, random).value(code, nullptr);
    if (value < 0 || value > most || value != std::floor(value)) {
      char number[40];
      std::snprintf(number, sizeof number, "%.9g", value);
      cursor_.fail_at(at, number, std::string(what) + ", a whole number from 0");
    }
    end_line();
    return value;
  }

  void statements(Code& code) {
    Scope scope = scope_;
    scope.assigns_globals = true;
    cursor_.skip_blank_lines();
    ExpressionCompiler(cursor_, scope, code).block();
    program_->block_locals = std::max(program_->block_locals, static_cast<std::uint32_t>(scope.locals.size()));
  }

  void context_symbols(bool consider, std::size_t begin) {
    if (context_list_seen_ == program_.get()) cursor_.fail_at(begin, "a second list of context symbols", "one");
    context_list_seen_ = program_.get();
    considers_ = consider;
    listed_.clear();
    while (true) {
      cursor_.skip_space();
      if (cursor_.at_line_end()) break;
      const auto name = ModuleParser(cursor_, *program_, scope_).symbol();
      if (!name) cursor_.fail("a symbol");
      listed_.push_back(program_->symbols.number(*name));
    }
  }

  void set_context_symbols() {
    const bool listed = context_list_seen_ == program_.get();
    program_->ignored.assign(program_->symbols.names().size(), listed && considers_);
    if (listed)
      for (const std::uint16_t symbol : listed_) program_->ignored[symbol] = !considers_;
    context_list_seen_ = nullptr;
  }

  // define: { array a[2,3] = {1,2,3, 4,5,6}; }
  void define_arrays() {
    const Cursor::LineEnds inside(cursor_, true);
    cursor_.expect('{', "after 'define:'");
    while (!cursor_.accept('}')) {
      cursor_.skip_space();
      const std::size_t at = cursor_.position();
      if (cursor_.word() != "array") cursor_.fail_at(at, cursor_.describe(at), "'array' or '}'");
      do {
        define_array();
      } while (cursor_.accept(','));
      cursor_.expect(';', "after the array");
    }
  }

  void define_array() {
    cursor_.skip_space();
    const std::size_t at = cursor_.position();
    ArrayInfo array;
    array.name = cursor_.word();
    if (array.name.empty()) cursor_.fail("the name of an array");
    array.first = global_slots_;
    std::size_t count = 1;
    cursor_.expect('[', "and the array's size");
    while (true) {
      cursor_.skip_space();
      const std::size_t size_at = cursor_.position();
      const double size = read_number(cursor_);
      if (size < 1 || size != std::floor(size) || size * static_cast<double>(count) > kMaxElements)
        cursor_.fail_at(size_at, cursor_.describe(size_at), "a size of 1 to 1000000 elements in all");
      array.sizes.push_back(static_cast<std::uint32_t>(size));
      count *= array.sizes.back();
      if (cursor_.accept(',')) continue;
      cursor_.expect(']', "after the array's size");
      if (!cursor_.accept('[')) break;
    }
    if (names_.count(array.name) ||
        std::any_of(program_->arrays.begin(), program_->arrays.end(),
                    [&](const ArrayInfo& other) { return other.name == array.name; }))
      cursor_.fail_at(at, "'" + array.name + "' twice", "different names");
    global_slots_ += static_cast<std::uint32_t>(count);
    if (global_slots_ > kMaxElements) cursor_.fail_at(at, "more than 1000000 array elements", "smaller arrays");
    program_->initial_globals.resize(global_slots_, 0.0);
    if (cursor_.accept('=')) {
      // Inner braces only group; values fill the array in row-major order and the rest stays 0.
      cursor_.expect('{', "before the array's values");
      std::size_t given = 0;
      int depth = 1;
      while (depth > 0) {
        cursor_.skip_space();
        if (cursor_.accept('{')) {
          ++depth;
        } else if (cursor_.accept('}')) {
          --depth;
        } else if (!(given > 0 && cursor_.accept(','))) {
          const std::size_t value_at = cursor_.position();
          const bool negative = cursor_.accept('-');
          cursor_.skip_space();
          const double value = read_number(cursor_);
          if (given == count) cursor_.fail_at(value_at, "more values than the array holds", std::to_string(count));
          program_->initial_globals[array.first + given++] = negative ? -value : value;
        }
      }
    }
    program_->arrays.push_back(std::move(array));
  }

  void add(Production production, std::size_t begin) {
    const bool has_context = !production.left.empty() || !production.right.empty();
    if (has_context && rules_ != &program_->productions)
      cursor_.fail_at(begin, "a production with a context", "a context-free one in this section");
    rules_->has_context = rules_->has_context || has_context;
    rules_->productions.push_back(std::move(production));
  }

  void index(RuleSet& rules) {
    rules.of_symbol.resize(program_->symbols.names().size());
    for (std::uint32_t i = 0; i < rules.productions.size(); ++i) {
      Production& production = rules.productions[i];
      auto& siblings = rules.of_symbol[production.predecessor.symbol];
      production.group = i;
      // Only a few productions share a predecessor; a hostile file with many is cut off to keep this linear.
      const std::size_t first = siblings.size() > 256 ? siblings.size() - 256 : 0;
      for (std::size_t k = first; k < siblings.size(); ++k) {
        const Production& other = rules.productions[siblings[k]];
        if (other.predecessor.arity == production.predecessor.arity && same_modules(other.left, production.left) &&
            same_modules(other.right, production.right)) {
          production.group = other.group;
          break;
        }
      }
      siblings.push_back(i);
    }
  }

  const SourceText& source_;
  Cursor cursor_;
  std::shared_ptr<LSystemProgram> program_;
  Scope scope_;
  std::unordered_map<std::string, std::uint32_t> names_;
  std::uint32_t global_slots_ = 0;
  bool axiom_seen_ = false;
  RuleSet* rules_ = nullptr;
  const LSystemProgram* context_list_seen_ = nullptr;
  bool considers_ = false;
  std::vector<std::uint16_t> listed_;
};

}  // namespace

LSystem LSystem::parse(std::string_view text, const std::filesystem::path& file, const std::optional<std::string>& label) {
  const SourceText source = preprocess(text, file);
  Parser parser(source);
  LSystem system;
  bool any = false;
  while (auto program = parser.next()) {
    any = true;
    if (!system.program_ && (!label || program->label == *label)) system.program_ = std::move(program);
  }
  if (!any) Cursor(source).fail_at(source.text.size(), "the end of the file", "'lsystem:'");
  if (!system.program_) throw InputError({file.string(), 0, 0}, "no L-system '" + *label + "'", "one of the file's labels");
  return system;
}

LSystem LSystem::load(const std::filesystem::path& file, const std::optional<std::string>& label) {
  return parse(read_source(file, {file.string(), 0, 0}), file, label);
}

}  // namespace cambium
