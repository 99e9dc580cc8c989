// Rewriting of one stretch of a string by one thread.
#pragma once

#include <cstdint>
#include <vector>

#include "blobtree/run_options.h"
#include "lsystem/bytecode.h"
#include "lsystem/context.h"
#include "lsystem/lsystem.h"
#include "lsystem/program.h"

namespace cambium {

/// What a pass applies: productions and the decomposition of what they make; the decomposition alone, to the axiom; or the
/// homomorphism alone.
enum class Stage : std::uint64_t { kBlocks, kAxiom, kDerivation, kDecomposition, kHomomorphism };

/// What the threads of a pass share.
struct PassInput {
  const LSystemProgram& program;
  const Modules& string;
  const BracketPairs& brackets;
  Stage stage = Stage::kDerivation;
  std::uint64_t seed = 0;
};

void clear(Modules& modules);

/// How many parameters a string may have in all: 8 for each module that it may have, and no more than `first` can number.
std::size_t most_parameters(std::size_t max_modules);

/// Appends to a string what becomes of modules of another. Not shared by threads; several may share `variables` where no
/// rule has effects.
class Rewriter {
 public:
  /// `max_modules` is what errors name, and what limits parameters; modules are limited by each call.
  Rewriter(const LSystemProgram& program, std::vector<double>& variables, const RunOptions& run, std::size_t max_modules,
           const Printer* printer = nullptr)
      : program_(program),
        run_(run),
        max_modules_(max_modules),
        random_(0),
        machine_(program.tables, random_, variables, printer),
        locals_(1, 0.0) {}
  Rewriter(const Rewriter&) = delete;
  Rewriter& operator=(const Rewriter&) = delete;

  /// Modules [begin, end) of input.string. False if cancelled; `out` is then unfinished.
  /// Errors: InputError, see derive(); also if `out` would get more than `limit` modules, or than most_parameters().
  bool rewrite(const PassInput& input, std::size_t begin, std::size_t end, std::size_t limit, Modules& out);

  /// As successor of no module, or as a block of statements: `which` tells its draws from others'.
  void append_axiom(const System& system, std::uint64_t seed, std::size_t limit, Modules& out);
  void run_block(const Code& code, std::uint64_t seed, std::uint64_t which);
  std::uint64_t seed() const { return random_.seed(); }  ///< the last one given, or srand's

  /// If set, rewrite() also notes where modules come from; rules are then productions.
  struct Origin {
    std::uint32_t parent;
    const Production* rule;  ///< null: it stayed
  };
  std::vector<Origin>* origins = nullptr;

 private:
  class Rewriting;
  /// Where predecessors are looked for, and where in the pass's string the contexts around it begin.
  struct Site {
    const Modules& string;
    std::size_t at;
    const System& system;
    std::size_t left_end;
    std::size_t right_begin;  ///< 0: behind the predecessor
  };
  struct Candidate {
    const Production* production;
    double weight;       // with those before it
    std::uint64_t rule;  // its number among those tried
    std::size_t first_local;
  };
  struct Level {  // of a decomposition in progress
    Modules modules;
    std::size_t next = 0;
    const Production* rule = nullptr;
  };

  const Production* choose(const RuleSet& rules, const Site& site, Stage stage, ContextMatcher& contexts);
  const Production* draw();
  bool matches(const Production& production, const Site& site, ContextMatcher& contexts);
  void append(const Production& production, std::uint64_t key, Modules& out);
  void append_successor(const Successor& successor, std::uint64_t key, const Place& place, Modules& out);
  void copy(const Modules& in, std::size_t begin, std::size_t end, Modules& out);
  [[noreturn]] void fail_too_many(const Place& place) const;
  void check_size(const Modules& out, std::size_t modules, std::size_t parameters, const Place& place) const;

  const LSystemProgram& program_;
  const RunOptions& run_;
  const std::size_t max_modules_;
  CounterRandom random_;
  Machine machine_;
  std::vector<double> locals_;
  std::vector<Candidate> candidates_;
  std::vector<double> candidate_locals_;
  std::vector<Level> levels_;
  std::size_t limit_ = 0;
  Place last_place_;  // of the production applied last: where an error of a copied module points to
};

}  // namespace cambium
