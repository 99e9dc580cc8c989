#include "blobtree/choices.h"

#include "blobtree/choice_rules.h"
#include "blobtree/evaluator_scratch.h"

#include <algorithm>

namespace cambium {

struct ChoiceEvaluator::Scratch {
  Evaluator::Scratch at;
  std::vector<std::uint8_t> matters;
  std::vector<WatchedChild> seen;
};

namespace {

/// Forgets what is chosen below children that are not taken. From the root down, so that a child's operators come after the
/// operator that takes it or does not; `matters` is a stack of values, the next instruction's on top.
void forget_the_rest(const Tape& tape, std::vector<std::uint32_t>& winners, std::vector<std::uint8_t>& matters) {
  matters.assign(1, 1);
  std::size_t entry = winners.size();
  for (std::size_t i = tape.instructions().size(); i-- > 0;) {
    const Instruction& in = tape.instructions()[i];
    const ChoiceEntries entries = choice_entries(tape, in);
    entry -= entries.count;
    const bool mattered = matters.back() != 0;
    matters.pop_back();
    if (in.op == Op::kPrimitive || in.op == Op::kHalfSpace || is_swept(in.op)) continue;
    std::uint32_t* const own = winners.data() + entry;
    if (!mattered) std::fill_n(own, entries.count, Choices::kDoesNotMatter);
    for (std::uint32_t k = 0; k < in.count; ++k) {
      bool taken = true;
      if (in.op == Op::kUnion || in.op == Op::kIntersection) taken = own[0] == k;
      if (in.op == Op::kDifference) taken = own[0] == k + (tape.slots()[in.first] == 0 ? 0 : 1);
      if (in.op == Op::kContact && in.count >= 3) taken = (own[0] & ~Choices::kBothInside) == k || own[1] == k;
      matters.push_back(mattered && taken ? 1 : 0);
    }
  }
}

}  // namespace

ChoiceEvaluator::ChoiceEvaluator() : scratch_(std::make_unique<Scratch>()) {}
ChoiceEvaluator::~ChoiceEvaluator() = default;

bool ChoiceEvaluator::smooth(const PrunedField& field) {
  if (field.empty()) return true;
  const Tape& tape = Evaluator::Scratch::view(field).tape;
  return std::all_of(tape.instructions().begin(), tape.instructions().end(),
                     [&](const Instruction& in) { return choice_entries(tape, in).count == 0; });
}

double ChoiceEvaluator::choose(const PrunedField& field, const Vec3& p, Choices& out) {
  out.winners.clear();
  if (field.empty()) return 0;
  Evaluator::Scratch& at = scratch_->at;
  const TapeView view = at.place(field, p);
  PointPolicy<double> policy(view, at);
  NotingRules rules(out.winners);
  const double value = run_tape(view, policy, at.numbers, rules);
  if (rules.selects() && out.winners.size() > 1) forget_the_rest(view.tape, out.winners, scratch_->matters);
  return value;
}

Sample ChoiceEvaluator::sample_as(const PrunedField& field, const Choices& choices, const Vec3& p) {
  if (field.empty()) return {};
  Evaluator::Scratch& at = scratch_->at;
  const TapeView view = at.place(field, p);
  PointPolicy<Dual<double>> policy(view, at);
  GivenRules rules(choices);
  const Dual<double> d = run_tape(view, policy, at.duals, rules);
  rules.finish();
  return {d.f, d.g};
}

ChoiceEvaluator::Touching ChoiceEvaluator::touching(const PrunedField& field, std::span<const Choices> sides) {
  Touching touching;
  if (field.empty()) return touching;
  const Tape& tape = Evaluator::Scratch::view(field).tape;
  std::size_t total = 0;
  for (const Instruction& in : tape.instructions()) total += choice_entries(tape, in).count;
  for (const Choices& side : sides) GivenRules::check_size(side, total);
  std::vector<std::uint8_t> apart(sides.size(), 1);
  std::uint32_t entry = 0;
  // Names the children of one contact of n children, if sides differ in it.
  const auto look_at = [&](std::uint32_t first, std::uint32_t count, std::uint32_t n) {
    const std::uint32_t* known = nullptr;
    bool differ = false;
    const auto of = [&](const Choices& side) {
      return side.winners[first] == Choices::kDoesNotMatter ? nullptr : &side.winners[first];
    };
    for (const Choices& side : sides) {
      const std::uint32_t* const own = of(side);
      if (!own) continue;
      if (!known) known = own;
      differ = differ || !std::equal(own, own + count, known);
    }
    if (!differ) return false;
    const auto name = [&](std::uint32_t child) {
      const Touching::Child named{first, child};
      if (child < n && std::find(touching.children.begin(), touching.children.end(), named) == touching.children.end())
        touching.children.push_back(named);
    };
    for (std::size_t s = 0; s < sides.size(); ++s) {
      const std::uint32_t* const own = of(sides[s]);
      if (!own) continue;
      apart[s] = 0;
      const std::uint32_t leader = own[0] & ~Choices::kBothInside;
      name(leader);
      if (n == 2 && leader < 2) name(1 - leader);
      if (count > 1) name(own[1]);
    }
    return true;
  };
  for (const Instruction& in : tape.instructions()) {
    const ChoiceEntries entries = choice_entries(tape, in);
    const bool laterals_differ = entries.contact > 0 && look_at(entry, entries.contact, entries.children);
    // What the laterals join to is then named by its own children.
    if (entries.has_axis && look_at(entry + entries.contact, 1, 2) && laterals_differ) {
      std::erase(touching.children, Touching::Child{entry + entries.contact, 1});
    }
    entry += entries.count;
  }
  for (std::size_t s = 0; s < sides.size(); ++s) {
    if (apart[s]) {
      touching.apart.push_back(s);
    } else if (touching.choices.winners.empty()) {
      touching.choices = sides[s];
    }
  }
  return touching;
}

double ChoiceEvaluator::sample_children(const PrunedField& field, const Touching& touching, const Vec3& p,
                                        std::vector<Sample>& children) {
  children.clear();
  if (touching.children.empty()) return 0;
  Evaluator::Scratch& at = scratch_->at;
  const TapeView view = at.place(field, p);
  PointPolicy<Dual<double>> policy(view, at);
  GivenRules rules(touching, scratch_->seen);
  const Dual<double> together = run_tape(view, policy, at.duals, rules);
  rules.finish();
  for (const WatchedChild& child : scratch_->seen) {
    Vec3 gradient = child.value.g;
    for (std::size_t frame = child.frame; frame != 0; frame = view.outside_of(frame)) {
      gradient = pull_back(view.warp_of(frame), at.points[view.outside_of(frame)], gradient);
    }
    children.push_back({child.value.f, gradient});
  }
  return together.f;
}

}  // namespace cambium
