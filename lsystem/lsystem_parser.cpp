// The sections of an L-system file.
#include <algorithm>
#include <cmath>
#include <cstdio>
#include <cstdlib>
#include <utility>

#include "lsystem/array_definitions.h"
#include "lsystem/dialect_translation.h"
#include "lsystem/lsystem.h"
#include "lsystem/module_parser.h"
#include "lsystem/preprocessor.h"
#include "lsystem/program.h"

namespace cambium {
namespace {

bool same_modules(const std::vector<ContextModule>& a, const std::vector<ContextModule>& b) {
  return std::equal(a.begin(), a.end(), b.begin(), b.end(), [](const ContextModule& x, const ContextModule& y) {
    return x.symbol == y.symbol && x.arity == y.arity;
  });
}

constexpr int kMaxDepth = 100'000;

class Parser {
 public:
  Parser(const SourceText& source, const std::filesystem::path& file) : source_(source), cursor_(source) {
    program_->tables.files = source.files;
    // Reading them costs, and a model without functions must not fail on a curve that nothing asks for.
    if (!source.marks_names && source.text.find("func") != std::string::npos) program_->tables.curves = curves_beside(file);
    SymbolTable& symbols = program_->symbols;
    program_->open = symbols.number("[");
    program_->close = symbols.number("]");
    program_->cut = symbols.number("%");
    program_->call = symbols.number("?");
    program_->end_call = symbols.number("$");
    program_->rest = symbols.number("=");
  }

  std::shared_ptr<LSystemProgram> read() {
    for (cursor_.skip_blank_lines(); !cursor_.at_end(); cursor_.skip_blank_lines()) read_system();
    if (program_->systems.empty()) cursor_.fail("'lsystem:'");
    program_->initial_globals.resize(slots_, 0.0);
    for (std::size_t i = 0; i < program_->systems.size(); ++i) {
      System& system = program_->systems[i];
      system.ignored = ignored(context_lists_[i]);
      for (RuleSet* rules : {&system.productions, &system.decomposition, &system.homomorphism}) index(*rules);
    }
    return std::move(program_);
  }

 private:
  void read_system() {
    const std::size_t begin = cursor_.position();
    program_->systems.emplace_back();
    system_ = &program_->systems.back();
    system_->place = cursor_.place();
    names_.push_back(std::make_unique<SystemNames>(SystemNames{{}, {}, program_->tables, slots_}));
    scope_ = Scope{};
    scope_.system = names_.back().get();
    axiom_seen_ = false;
    context_lists_.emplace_back();
    rules_ = &system_->productions;
    if (lower_case(cursor_.word()) != "lsystem") cursor_.fail_at(begin, cursor_.describe(begin), "'lsystem:'");
    cursor_.expect(':', "after 'lsystem'");
    system_->label = rest_of_line();
    while (section(begin)) {
    }
    if (!axiom_seen_) cursor_.fail_at(begin, "an L-system without an axiom", "'axiom:'");
  }

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
      rules_ = keyword == "decomposition" ? &system_->decomposition : &system_->homomorphism;
      rules_section();
      return true;
    }
    if (keyword == "derivation" || keyword == "maximum" || keyword == "ring" || keyword == "start" || keyword == "end")
      keyword += second_word(keyword);
    cursor_.skip_space();
    if (keyword == "ring lsystem" && cursor_.at_line_end()) {
      system_->ring = true;
      return true;
    }
    if ((keyword == "derivation length" || keyword == "maximum depth") && cursor_.peek() != ':')
      cursor_.fail("':' after '" + keyword + "'");
    if (is_keyword(keyword.substr(0, keyword.find(' '))) && cursor_.peek() == ':' && keyed(keyword, begin)) return true;
    cursor_.seek(begin);
    add(ModuleParser(cursor_, *program_, scope_).production());
    return true;
  }

  // The rest of a keyword of two words, in one spelling; nothing if `first` stands alone.
  std::string second_word(const std::string& first) {
    cursor_.skip_space();
    const std::size_t before = cursor_.position();
    const std::string second = lower_case(cursor_.word());
    if (first == "derivation" && second == "length") return " length";
    if (first == "maximum" && second == "depth") return " depth";
    if (first == "ring" && second == "lsystem") return " lsystem";
    if (first == "ring" && second == "l" && cursor_.looking_at("-")) {
      cursor_.advance();
      if (lower_case(cursor_.word()) == "system") return " lsystem";
    }
    if ((first == "start" || first == "end") && second == "each") return "each";
    cursor_.seek(before);
    return {};
  }

  // Behind `decomposition` or `homomorphism`: a colon and cpfg's `warnings` or `no warnings` may stand there.
  void rules_section() {
    cursor_.accept(':');
    cursor_.skip_space();
    const std::size_t at = cursor_.position();
    std::string word = lower_case(cursor_.word());
    cursor_.skip_space();
    if (word == "no") word = lower_case(cursor_.word());
    if (!word.empty() && word != "warnings")
      cursor_.fail_at(at, cursor_.describe(at), "'warnings', 'no warnings' or the end of the line");
    end_line();
  }

  // The section of `keyword`, at its colon; false if it is no keyword that takes one.
  bool keyed(const std::string& keyword, std::size_t begin) {
    if (keyword == "production" || keyword == "productions") {
      cursor_.advance();
      rules_ = &system_->productions;
      end_line();
    } else if (keyword == "seed") {
      const auto seed = static_cast<std::uint64_t>(whole_number("a seed", 9e15));
      if (rules_ == &system_->homomorphism)
        system_->homomorphism_seed = seed;
      else
        system_->seed = seed;
    } else if (keyword == "derivation length") {
      system_->derivation_length = static_cast<int>(whole_number("a number of steps", 1e9));
    } else if (keyword == "maximum depth") {
      const int depth = static_cast<int>(whole_number("a depth up to 100000", kMaxDepth));
      // Before any section it holds for both.
      if (rules_ == &system_->productions) system_->decomposition.max_depth = system_->homomorphism.max_depth = depth;
      rules_->max_depth = depth;
    } else if (keyword == "ring lsystem") {
      system_->ring = whole_number("0 or 1", 1) != 0;
    } else if (keyword == "consider" || keyword == "ignore") {
      cursor_.advance();
      context_symbols(keyword == "consider", begin);
    } else if (keyword == "define") {
      cursor_.advance();
      std::vector<const SystemNames*> earlier;
      for (std::size_t i = 0; i + 1 < names_.size(); ++i) earlier.push_back(names_[i].get());
      ArrayDefinitions(cursor_, *scope_.system, earlier, program_->initial_globals).read();
    } else if (keyword == "axiom") {
      if (axiom_seen_) cursor_.fail_at(begin, "a second axiom", "one");
      axiom_seen_ = true;
      cursor_.advance();
      Scope scope = scope_;
      system_->axiom = ModuleParser(cursor_, *program_, scope_).successor(scope);
      end_line();
    } else if (keyword == "start" || keyword == "starteach" || keyword == "endeach" || keyword == "end") {
      cursor_.advance();
      statements(keyword == "start"       ? system_->start
                 : keyword == "starteach" ? system_->start_each
                 : keyword == "endeach"   ? system_->end_each
                                          : system_->end);
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
    const double value = constant_value(code, program_->tables);
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

  // Single characters, as cpfg has them: `~` and `@` stand for all symbols that begin with them. Commas are symbols, too.
  void context_symbols(bool consider, std::size_t begin) {
    ContextList& list = context_lists_.back();
    if (list.seen) cursor_.fail_at(begin, "a second list of context symbols", "one");
    list.seen = true;
    list.considers = consider;
    for (cursor_.skip_space(); !cursor_.at_line_end(); cursor_.skip_space()) {
      if (cursor_.at_marked_name()) {
        list.names.push_back(cursor_.marked_name());
        continue;
      }
      const char c = cursor_.peek();
      if (static_cast<unsigned char>(c) <= ' ' || static_cast<unsigned char>(c) >= 0x7f) cursor_.fail("a symbol");
      list.symbols.push_back(c);
      cursor_.advance();
    }
  }

  struct ContextList {
    bool seen = false;
    bool considers = false;
    std::string symbols;             // that names begin with
    std::vector<std::string> names;  // whole
    bool has(const std::string& name) const {
      return symbols.find(name[0]) != std::string::npos || std::find(names.begin(), names.end(), name) != names.end();
    }
  };

  std::vector<bool> ignored(const ContextList& list) const {
    std::vector<bool> out;
    for (const std::string& name : program_->symbols.names())
      out.push_back(list.seen && list.has(name) != list.considers);
    return out;
  }

  void add(Production production) {
    const bool multiple = production.predecessor.size() > 1;
    bool effects = false;
    for (const Code* code : {&production.before, &production.condition, &production.after, &production.weight,
                             &production.successor.parameters})
      effects = effects || code->has_effects;
    rules_->has_context = rules_->has_context || !production.left.empty() || !production.right.empty();
    rules_->in_order = rules_->in_order || multiple || effects;
    rules_->productions.push_back(std::move(production));
  }

  void index(RuleSet& rules) {
    rules.of_symbol.resize(program_->symbols.names().size());
    for (std::uint32_t i = 0; i < rules.productions.size(); ++i) {
      Production& production = rules.productions[i];
      auto& siblings = rules.of_symbol[production.predecessor[0].symbol];
      production.group = i;
      // Only a few productions share a predecessor; a hostile file with many is cut off to keep this linear.
      const std::size_t first = siblings.size() > 256 ? siblings.size() - 256 : 0;
      for (std::size_t k = first; k < siblings.size(); ++k) {
        if (!same_modules(rules.productions[siblings[k]].predecessor, production.predecessor)) continue;
        production.group = rules.productions[siblings[k]].group;
        break;
      }
      siblings.push_back(i);
    }
  }

  const SourceText& source_;
  Cursor cursor_;
  std::shared_ptr<LSystemProgram> program_ = std::make_shared<LSystemProgram>();
  System* system_ = nullptr;                         // the one being read
  std::vector<std::unique_ptr<SystemNames>> names_;  // of each L-system
  std::uint32_t slots_ = 0;
  Scope scope_;
  bool axiom_seen_ = false;
  RuleSet* rules_ = nullptr;
  std::vector<ContextList> context_lists_;  // of each L-system
};

}  // namespace

const System* LSystemProgram::numbered(double label) const {
  for (const System& system : systems) {
    char* end = nullptr;
    const double number = std::strtod(system.label.c_str(), &end);
    if (end != system.label.c_str() && *end == '\0' && number == std::trunc(label)) return &system;
  }
  return nullptr;
}

LSystem LSystem::parse(std::string_view text, const std::filesystem::path& file, const std::optional<std::string>& label,
                       Dialect dialect) {
  HoudiniValues houdini;
  const SourceText source = dialect == Dialect::kLpy       ? cpfg_from_lpy(text, file)
                            : dialect == Dialect::kHoudini ? cpfg_from_houdini(text, file, houdini)
                                                           : preprocess(text, file);
  auto program = Parser(source, file).read();
  program->dialect = dialect;
  program->houdini = houdini;
  if (dialect == Dialect::kCpfg) program->view = view_beside(file, program->symbols.names());
  if (label) {
    const auto named =
        std::find_if(program->systems.begin(), program->systems.end(), [&](const System& s) { return s.label == *label; });
    if (named == program->systems.end())
      throw InputError({file.string(), 0, 0}, "no L-system '" + *label + "'", "one of the file's labels");
    program->main_index = static_cast<std::size_t>(named - program->systems.begin());
  }
  LSystem system;
  system.program_ = std::move(program);
  return system;
}

LSystem LSystem::load(const std::filesystem::path& file, const std::optional<std::string>& label,
                      std::optional<Dialect> dialect) {
  return parse(read_source(file, {file.string(), 0, 0}), file, label, dialect.value_or(dialect_of(file)));
}

}  // namespace cambium
