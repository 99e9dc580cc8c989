#include "lsystem/derivation.h"

#include <algorithm>
#include <utility>

namespace cambium {

Derivation::Derivation(const LSystem& system, const DeriveOptions& options, const RunOptions& run)
    : system_(system),
      options_(options),
      program_(system.program()),
      run_(run),
      pass_(program_, options.max_modules, run, &options.print) {
  steps_ = options.steps.value_or(program_.main().derivation_length);
  if (steps_ < 0)
    throw InputError(located(program_.tables.files, program_.main().place), "an L-system without a derivation length",
                     "'derivation length:', or a number of steps of 0 or more");
  pass_.seed = options.seed.value_or(program_.main().seed);
  const auto& names = program_.symbols.names();
  asks_ =
      std::any_of(names.begin(), names.end(), [](const std::string& name) { return name.size() == 2 && name[0] == '?'; });
}

bool Derivation::begin() {
  pass_.run_block(&System::start, 0);
  pass_.axiom(modules_);
  const auto has_decomposition = [](const System& system) { return !system.decomposition.empty(); };
  if (std::none_of(program_.systems.begin(), program_.systems.end(), has_decomposition)) return true;
  if (!pass_.rewrite(modules_, Stage::kDecomposition, next_)) return false;
  take_next();
  return true;
}

bool Derivation::advance() {
  if (!begin_step() || !pass_.rewrite(modules_, Stage::kDerivation, next_)) return false;
  take_next();
  return end_step();
}

bool Derivation::advance(Modules& before, std::vector<Rewriter::Origin>& origins) {
  if (!begin_step() || !pass_.rewrite(modules_, Stage::kDerivation, next_, origins)) return false;
  before = std::move(modules_);
  take_next();
  return end_step();
}

bool Derivation::answer() {
  if (!asks_ || answered_) return true;
  ModuleString string = named(std::move(modules_));
  answered_ = answer_queries(string, system_, options_.turtle, run_);
  modules_ = std::move(static_cast<Modules&>(string));
  return answered_;
}

ModuleString Derivation::named(Modules modules) const {
  ModuleString string;
  static_cast<Modules&>(string) = std::move(modules);
  string.names = program_.symbols.names();
  string.seed = pass_.seed;
  string.variables = pass_.variables;
  return string;
}

bool Derivation::begin_step() {
  if (!answer()) return false;
  pass_.run_block(&System::start_each, 2 + 2 * ++step_);
  return true;
}

bool Derivation::end_step() {
  pass_.run_block(&System::end_each, 3 + 2 * step_);
  if (run_.progress) run_.progress("derive", static_cast<double>(step_) / steps_);
  return !run_.cancelled();
}

void Derivation::take_next() {
  std::swap(modules_, next_);
  answered_ = false;
}

}  // namespace cambium
