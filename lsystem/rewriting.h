// One parallel rewriting pass over a string of modules.
#pragma once

#include "blobtree/run_options.h"
#include "lsystem/bytecode.h"
#include "lsystem/lsystem.h"
#include "lsystem/program.h"

#include <cstdint>
#include <vector>

namespace cambium {

enum class Stage : std::uint64_t { kBlocks, kAxiom, kDerivation, kDecomposition, kHomomorphism };

/// Applies rule sets of one program. Holds its variables and scratch; not shared by threads.
class Rewriter {
 public:
  Rewriter(const LSystemProgram& program, std::uint64_t seed, std::size_t max_modules, const RunOptions& run);
  Rewriter(const Rewriter&) = delete;
  Rewriter& operator=(const Rewriter&) = delete;

  enum class Pass { kNothingMatched, kRewritten, kCancelled };

  /// `out` is overwritten. Errors: InputError, see derive().
  Pass pass(const ModuleString& in, ModuleString& out, const RuleSet& rules, Stage stage, std::uint64_t step);
  /// Passes of a decomposition or homomorphism over `string`, until nothing matches or the depth is reached; false if cancelled.
  bool expand(ModuleString& string, const RuleSet& rules, Stage stage, std::uint64_t step);
  void run_block(const Code& code, std::uint64_t step, std::uint64_t which);
  ModuleString axiom();

  std::vector<double>& variables() { return machine_.globals; }

 private:
  const Production* choose(const ModuleString& in, std::size_t index, const RuleSet& rules);
  bool matches(const Production& production, const ModuleString& in, std::size_t index);
  bool match_left(const Production& production, const ModuleString& in, std::size_t index);
  bool match_right(const Production& production, const ModuleString& in, std::size_t index);
  bool take(const ContextModule& wanted, const ModuleString& in, std::size_t index);
  void bind(const ContextModule& module, const ModuleString& in, std::size_t index);
  void link_brackets(const ModuleString& in);
  void append(ModuleString& out, const Successor& successor, const Place& place);
  void copy(const ModuleString& in, std::size_t index, ModuleString& out, const Place& place) const;
  void check_size(const ModuleString& out, std::size_t more, std::size_t parameters, const Place& place) const;
  bool cancelled();

  const LSystemProgram& program_;
  std::size_t max_modules_;
  const RunOptions& run_;
  CounterRandom random_;
  Machine machine_;
  std::uint64_t polled_at_ = 0;
  std::vector<double> locals_;
  struct Candidate {
    const Production* production;
    double weight;
    std::size_t first_local;
  };
  std::vector<Candidate> candidates_;
  std::vector<double> candidate_locals_;
  std::vector<std::size_t> partner_;  // index of the matching bracket; the string's size if there is none
};

}  // namespace cambium
