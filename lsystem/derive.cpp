// Derivation: the axiom, and what becomes of it step by step.
#include "lsystem/lsystem.h"
#include "lsystem/program.h"
#include "lsystem/rewriting.h"

#include <utility>

namespace cambium {

std::optional<ModuleString> derive(const LSystem& system, const DeriveOptions& options, const RunOptions& run) {
  const LSystemProgram& program = system.program();
  const int steps = options.steps.value_or(program.derivation_length);
  if (steps < 0)
    throw InputError(located(program.files, program.place), "an L-system without a derivation length",
                     "'derivation length:', or a number of steps of 0 or more");
  const std::uint64_t seed = options.seed.value_or(program.seed);
  Rewriter rewriter(program, seed, options.max_modules, run);
  rewriter.run_block(program.start, 0, 0);
  ModuleString string = rewriter.axiom();
  if (!rewriter.expand(string, program.decomposition, Stage::kDecomposition, 0)) return std::nullopt;
  ModuleString next;
  for (int step = 1; step <= steps; ++step) {
    const auto counter = static_cast<std::uint64_t>(step);
    if (run.cancelled()) return std::nullopt;
    rewriter.run_block(program.start_each, counter, 1);
    if (rewriter.pass(string, next, program.productions, Stage::kDerivation, counter) == Rewriter::Pass::kCancelled)
      return std::nullopt;
    std::swap(string, next);
    if (!rewriter.expand(string, program.decomposition, Stage::kDecomposition, counter)) return std::nullopt;
    rewriter.run_block(program.end_each, counter, 2);
    if (run.progress) run.progress("derive", static_cast<double>(step) / steps);
  }
  rewriter.run_block(program.end, static_cast<std::uint64_t>(steps), 3);
  string.names = program.symbols.names();
  string.seed = seed;
  string.variables = rewriter.variables();
  return string;
}

}  // namespace cambium
