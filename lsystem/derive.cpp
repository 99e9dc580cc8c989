// Derivation: the axiom, and what becomes of it step by step.
#include <algorithm>
#include <unordered_map>
#include <utility>

#include "lsystem/lsystem.h"
#include "lsystem/program.h"
#include "lsystem/rewriting_pass.h"

namespace cambium {
namespace {

/// A derivation under way.
class Derivation {
 public:
  Derivation(const LSystem& system, const DeriveOptions& options, const RunOptions& run)
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

  int steps() const { return steps_; }
  Modules& modules() { return modules_; }

  /// The Start blocks and the axiom. False if cancelled, as all below.
  bool begin() {
    pass_.run_block(&System::start, 0);
    pass_.axiom(modules_);
    const auto has_decomposition = [](const System& system) { return !system.decomposition.empty(); };
    if (std::none_of(program_.systems.begin(), program_.systems.end(), has_decomposition)) return true;
    return pass_.rewrite(modules_, Stage::kDecomposition, next_) && take_next();
  }

  bool advance() {
    return begin_step() && pass_.rewrite(modules_, Stage::kDerivation, next_) && take_next() && end_step();
  }

  /// The same, with the string before it and the origins of what is in it after.
  bool advance(Modules& before, std::vector<Rewriter::Origin>& origins) {
    if (!begin_step() || !pass_.rewrite(modules_, Stage::kDerivation, next_, origins)) return false;
    before = std::move(modules_);
    return take_next() && end_step();
  }

  ModuleString named(Modules modules) const {
    ModuleString string;
    static_cast<Modules&>(string) = std::move(modules);
    string.names = program_.symbols.names();
    string.seed = pass_.seed;
    string.variables = pass_.variables;
    return string;
  }

  /// nullopt if cancelled.
  std::optional<ModuleString> end() {
    if (!answer()) return std::nullopt;
    pass_.run_block(&System::end, 1);
    return named(std::move(modules_));
  }

 private:
  bool begin_step() {
    if (!answer()) return false;
    pass_.run_block(&System::start_each, 2 + 2 * ++step_);
    return true;
  }

  // As cpfg, which draws every string and so answers what it asks.
  bool answer() {
    if (!asks_) return true;
    ModuleString string = named(std::move(modules_));
    const bool answered = answer_queries(string, system_, options_.turtle, run_);
    modules_ = std::move(static_cast<Modules&>(string));
    return answered;
  }

  bool end_step() {
    pass_.run_block(&System::end_each, 3 + 2 * step_);
    if (run_.progress) run_.progress("derive", static_cast<double>(step_) / steps_);
    return !run_.cancelled();
  }

  bool take_next() {
    std::swap(modules_, next_);
    return true;
  }

  const LSystem& system_;
  const DeriveOptions& options_;
  const LSystemProgram& program_;
  const RunOptions& run_;
  RewritingPass pass_;
  bool asks_ = false;  // there may be queries
  int steps_ = 0;
  std::uint64_t step_ = 0;
  Modules modules_, next_;
};

// Rules as numbers into a list of places.
class RuleNumbers {
 public:
  explicit RuleNumbers(const LSystemProgram& program) : program_(program) {}

  std::uint32_t number(const Production* rule) {
    if (!rule) return ExplainedStep::kStayed;
    const auto [found, inserted] = numbers_.emplace(rule, static_cast<std::uint32_t>(places_.size()));
    if (inserted) places_.push_back(located(program_.tables.files, rule->place));
    return found->second;
  }
  std::vector<SourceLocation> places() && { return std::move(places_); }

 private:
  const LSystemProgram& program_;
  std::unordered_map<const Production*, std::uint32_t> numbers_;
  std::vector<SourceLocation> places_;
};

}  // namespace

std::optional<ModuleString> derive(const LSystem& system, const DeriveOptions& options, const RunOptions& run) {
  Derivation derivation(system, options, run);
  if (!derivation.begin()) return std::nullopt;
  for (int step = 0; step < derivation.steps(); ++step)
    if (!derivation.advance()) return std::nullopt;
  return derivation.end();
}

std::optional<ExplainedStep> explain_step(const LSystem& system, const DeriveOptions& options, const RunOptions& run) {
  Derivation derivation(system, options, run);
  if (derivation.steps() == 0)
    throw InputError({system.program().tables.files[0], 0, 0}, "no derivation step to explain", "1 step or more");
  if (!derivation.begin()) return std::nullopt;
  for (int step = 1; step < derivation.steps(); ++step)
    if (!derivation.advance()) return std::nullopt;
  Modules before;
  std::vector<Rewriter::Origin> origins;
  if (!derivation.advance(before, origins)) return std::nullopt;
  ExplainedStep out;
  out.before = derivation.named(std::move(before));
  auto after = derivation.end();
  if (!after) return std::nullopt;
  out.after = std::move(*after);
  RuleNumbers numbers(system.program());
  for (const Rewriter::Origin& origin : origins) out.origins.push_back({origin.parent, numbers.number(origin.rule)});
  out.rules = std::move(numbers).places();
  return out;
}

}  // namespace cambium
