#include "blobtree/tape_interval.h"

#include <algorithm>

namespace cambium {
namespace {

/// Tapes list their atoms in ascending order, as `active` does: they are taken one after another.
class ListedPolicy {
 public:
  ListedPolicy(const CompiledTree& tree, const ActiveAtoms& active, const Ball& ball)
      : tree_(tree), next_(active.bounds.data()), ball_(ball) {}

  Interval primitive(const Instruction&) { return *next_++; }
  Interval half_space(const Instruction&) { return *next_++; }
  Interval chain(const Instruction& in) { return chain_interval(ratio(in), tree_.chain_strength_of(tree_.nodes[in.node])); }
  Interval flare(const Instruction& in) {
    const CompiledNode& node = tree_.nodes[in.node];
    return flare_interval(ratio(in), flare_factor_interval(tree_.flare_of(node), ball_), tree_.chain_strength_of(node));
  }
  Interval lateral_weight(const Lateral& lateral, const Instruction&) const { return lateral_contact_weight_interval(lateral, ball_); }
  Interval warp(const Instruction&, const Interval& f) const { return f; }

 private:
  /// Of the nearest of a chain's segments.
  Interval ratio(const Instruction& in) {
    Interval ratio = *next_++;
    for (std::uint32_t i = 1; i < in.count; ++i, ++next_) ratio = {std::min(ratio.lo, next_->lo), std::min(ratio.hi, next_->hi)};
    return ratio;
  }

  const CompiledTree& tree_;
  const Interval* next_;
  const Ball& ball_;
};

}  // namespace

Interval tape_interval(const CompiledTree& tree, const Tape& tape, const ActiveAtoms& active, const Ball& ball,
                       TapeScratch<Interval>& scratch) {
  ListedPolicy policy(tree, active, ball);
  return a_hair_wider(run_tape(TapeView{tree, tape}, policy, scratch));
}

}  // namespace cambium
