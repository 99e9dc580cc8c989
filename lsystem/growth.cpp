#include "lsystem/growth.h"

#include <algorithm>
#include <numeric>
#include <utility>
#include <vector>

#include "lsystem/derivation.h"
#include "lsystem/drawn_form.h"
#include "lsystem/turtle_actions.h"

namespace cambium {
namespace {

/// No module before the step.
constexpr std::uint32_t kNothing = 0xffffffff;

bool same_kind(const Modules& a, std::size_t i, const Modules& b, std::size_t j) {
  return a.symbol[i] == b.symbol[j] && a.arity(i) == b.arity(j);
}

/// Which of the modules [begin, end), made of `parent`, continues it; `end` if none does. `heirs`: those of others.
std::size_t continuing(const Modules& before, std::size_t parent, const Modules& after, std::size_t begin, std::size_t end,
                       const std::vector<std::uint32_t>& heirs, const LSystemProgram& program) {
  std::size_t first = end;
  int depth = 0;
  for (std::size_t i = begin; i < end; ++i) {
    if (after.symbol[i] == program.close) --depth;
    if (heirs[i] == kNothing && same_kind(before, parent, after, i)) {
      if (depth <= 0) return i;
      if (first == end) first = i;
    }
    if (after.symbol[i] == program.open) ++depth;
  }
  return first;
}

/// For each module of `after` the one of `before` that it continues, or kNothing.
std::vector<std::uint32_t> predecessors(const Modules& before, const Modules& after,
                                        const std::vector<Rewriter::Origin>& origins, const LSystemProgram& program) {
  std::vector<std::uint32_t> out(after.size(), kNothing);
  for (std::size_t begin = 0; begin < after.size();) {
    const std::uint32_t parent = origins[begin].parent;
    std::size_t end = begin + 1;
    while (end < after.size() && origins[end].parent == parent) ++end;
    const std::size_t parents = origins[begin].rule ? origins[begin].rule->predecessor.size() : 1;
    for (std::size_t p = parent; p < std::min(parent + parents, before.size()); ++p) {
      const std::size_t heir = continuing(before, p, after, begin, end, out, program);
      if (heir < end) out[heir] = static_cast<std::uint32_t>(p);
    }
    begin = end;
  }
  return out;
}

double mixed_value(double from, double to, double part) { return from + part * (to - from); }

bool is_drawn(TurtleAction action) {
  using enum TurtleAction;
  return action == kDraw || action == kDrawBetween || action == kSurface || action == kSphere || action == kDisc ||
         action == kAxisPoint || action == kAxisEnd || action == kBraceClose;
}

/// Which modules are new, and which of them carry old ones; `is_new` by module.
std::vector<GrowthParts::Stage> stages_of(const ModuleString& drawn, const std::vector<bool>& is_new) {
  using Stage = GrowthParts::Stage;
  std::vector<TurtleAction> actions;
  for (const std::string& name : drawn.names) actions.push_back(turtle_action(name));
  std::vector<Stage> stages(drawn.size(), Stage::kOld);
  std::vector<bool> outside;  // whether there is something old behind each branch around this place
  bool old_behind = false;
  for (std::size_t i = drawn.size(); i-- > 0;) {
    const TurtleAction action = actions[drawn.symbol[i]];
    if (action == TurtleAction::kClose) {
      outside.push_back(old_behind);
      old_behind = false;
    } else if (action == TurtleAction::kOpen && !outside.empty()) {
      old_behind = old_behind || outside.back();
      outside.pop_back();
    }
    if (is_new[i])
      stages[i] = old_behind ? Stage::kNewBelowOld : Stage::kNew;
    else if (is_drawn(action))
      old_behind = true;
  }
  return stages;
}

}  // namespace

/// A derivation, and the last step of it.
struct Growth::Step {
  explicit Step(const Growth& of) : derivation(of.system_, of.options_, of.run_) {}

  double time() const { return static_cast<double>(derivation.step()); }

  Derivation derivation;
  bool has_before = false;  // the three below are there
  Modules before;
  std::vector<double> variables_before;
  std::vector<std::uint32_t> predecessors;  // in `before`
};

Growth::Growth(const LSystem& system, const DeriveOptions& options, const RunOptions& run)
    : system_(system), options_(options), run_(run), steps_(Derivation(system, options, run).steps()) {}

Growth::~Growth() = default;

std::optional<GrownString> Growth::at(double time) {
  if (!advance_to(time)) return std::nullopt;
  const double part = time - (step_->time() - 1);
  if (part >= 1) return whole(step_->derivation.named(step_->derivation.modules()));
  if (part > 0) return between(part);
  ModuleString string = step_->derivation.named(step_->before);
  string.variables = step_->variables_before;
  return whole(std::move(string));
}

// To the step that ends at `time` or after it; with the step before if `time` is between them.
bool Growth::advance_to(double time) {
  if (step_ && time < step_->time() && !(step_->has_before && time >= step_->time() - 1)) step_.reset();
  if (!step_) {
    step_ = std::make_unique<Step>(*this);
    if (!step_->derivation.begin() || !step_->derivation.answer()) return false;
    if (steps_ == 0) step_->derivation.end();
  }
  while (step_->time() < time)
    if (!advance(time < step_->time() + 1)) return false;
  return true;
}

bool Growth::advance(bool with_origins) {
  Step& step = *step_;
  Derivation& derivation = step.derivation;
  step.has_before = with_origins;
  if (with_origins) {
    std::vector<Rewriter::Origin> origins;
    step.variables_before = derivation.variables();
    if (!derivation.advance(step.before, origins)) return false;
    step.predecessors = predecessors(step.before, derivation.modules(), origins, system_.program());
  } else if (!derivation.advance()) {
    return false;
  }
  if (!derivation.answer()) return false;
  if (derivation.step() == static_cast<std::uint64_t>(steps_)) derivation.end();
  return true;
}

std::optional<GrownString> Growth::whole(ModuleString string) const {
  const LSystemProgram& program = system_.program();
  if (is_its_drawn_form(program)) return GrownString{std::move(string), {}};
  auto drawn = drawn_form(string, program, options_.turtle, run_);
  if (!drawn) return std::nullopt;
  return GrownString{std::move(*drawn), {}};
}

std::optional<GrownString> Growth::between(double part) const {
  const Step& step = *step_;
  ModuleString string = step.derivation.named(step.derivation.modules());
  for (std::size_t i = 0; i < string.variables.size(); ++i)
    string.variables[i] = mixed_value(step.variables_before[i], string.variables[i], part);
  for (std::size_t i = 0; i < string.size(); ++i) {
    if (step.predecessors[i] == kNothing) continue;
    const double* const from = step.before.parameters.data() + step.before.first[step.predecessors[i]];
    double* const to = string.parameters.data() + string.first[i];
    for (std::size_t p = 0; p < string.arity(i); ++p) to[p] = mixed_value(from[p], to[p], part);
  }
  if (run_.cancelled()) return std::nullopt;
  std::vector<std::uint32_t> origins;
  auto drawn = drawn_form(string, system_.program(), options_.turtle, run_, &origins);
  if (!drawn || run_.cancelled()) return std::nullopt;
  std::vector<bool> is_new(drawn->size());
  for (std::size_t i = 0; i < drawn->size(); ++i) is_new[i] = step.predecessors[origins[i]] == kNothing;
  GrowthParts parts{stages_of(*drawn, is_new), part};
  return GrownString{std::move(*drawn), std::move(parts)};
}

}  // namespace cambium
