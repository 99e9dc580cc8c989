// The whole of a derivation, and one of its steps explained.
#include <unordered_map>
#include <utility>

#include "lsystem/derivation.h"
#include "lsystem/lsystem.h"
#include "lsystem/program.h"

namespace cambium {
namespace {

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
  if (!derivation.answer()) return std::nullopt;
  derivation.end();
  return derivation.take();
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
  if (!derivation.answer()) return std::nullopt;
  derivation.end();
  out.after = derivation.take();
  RuleNumbers numbers(system.program());
  for (const Rewriter::Origin& origin : origins) out.origins.push_back({origin.parent, numbers.number(origin.rule)});
  out.rules = std::move(numbers).places();
  return out;
}

}  // namespace cambium
