#include "blobtree/active_atoms.h"

#include <algorithm>
#include <array>

namespace cambium {
namespace {

/// Beyond this normalised distance a chain's segment is 0, with a hair to spare: rounding here never drops a value that rounding
/// elsewhere finds.
constexpr double kFar = kSupportPerRadius * (1 + 1e-9);

/// Where more segments of one chain are active, the box is too large for one to hide another.
constexpr std::size_t kMostCompared = 32;

}  // namespace

void append_active(const CompiledTree& tree, std::span<const std::uint32_t> candidates, const Box& box,
                   std::vector<std::uint32_t>& active) {
  const FloatBox reach(box);
  const Ball ball = circumscribed_ball(box);
  const bool bounded = ball.radius < kInfinity;
  const double hair = bounded ? 1e-9 * ball.radius + 1e-14 * glm::length(ball.center) : 0.0;
  std::uint32_t chain = kNone;       // the chain whose segments are being listed,
  std::size_t chain_begin = 0;       // where they begin in `active`,
  double nearest = kInfinity;        // the distance that its nearest segment stays below everywhere in the box,
  std::array<double, kMostCompared> least;   // and what each segment's distance stays above
  const auto drop_hidden = [&] {
    const std::size_t count = active.size() - chain_begin;
    if (chain == kNone || count < 2 || count > kMostCompared) return;
    std::size_t kept = chain_begin;
    for (std::size_t i = 0; i < count; ++i) {
      active[kept] = active[chain_begin + i];
      kept += least[i] <= nearest;
    }
    active.resize(kept);
  };
  for (const std::uint32_t atom : candidates) {
    const Atom& a = tree.atoms[atom];
    if (a.node != chain) {
      drop_hidden();
      chain = kNone;
    }
    if (!tree.bounds_of_atoms[atom].intersects(reach)) continue;
    const CompiledNode& node = tree.nodes[a.node];
    if (!bounded || node.warp != kNone) {
      active.push_back(atom);
      continue;
    }
    const Ball wide{ball.center, ball.radius + hair};
    if (node.op != Op::kChain) {
      const Interval f = node.op == Op::kHalfSpace ? half_space_interval(tree.half_spaces[node.payload], wide)
                                                   : primitive_interval(tree.primitive_of(node), wide);
      if (f.lo != 0 || f.hi != 0) active.push_back(atom);
      continue;
    }
    const Interval x = swept_ratio_interval(tree.segment_of(atom), wide);
    if (!(x.lo < kFar)) continue;
    if (chain == kNone) {
      chain = a.node;
      chain_begin = active.size();
      nearest = kInfinity;
    }
    nearest = std::min(nearest, x.hi * (1 + 1e-9) + 1e-9);
    if (active.size() - chain_begin < kMostCompared) least[active.size() - chain_begin] = x.lo;
    active.push_back(atom);
  }
  drop_hidden();
}

}  // namespace cambium
