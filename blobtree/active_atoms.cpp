#include "blobtree/active_atoms.h"

#include <algorithm>
#include <bit>

namespace cambium {
namespace {

/// Beyond this normalised distance a chain's segment is 0, with a hair to spare: rounding here never drops a value that
/// rounding elsewhere finds.
constexpr double kFar = kSupportPerRadius * (1 + 1e-9);

/// The ball around a box, a hair wider.
Ball ball_around(const Box& box) {
  const Ball ball = circumscribed_ball(box);
  return {ball.center, ball.radius * (1 + 1e-9) + 1e-14 * glm::length(ball.center)};
}

Interval bounds_of(const CompiledTree& tree, const CompiledNode& node, const Ball& ball) {
  return node.op == Op::kHalfSpace ? half_space_interval(tree.half_spaces[node.payload], ball)
                                   : primitive_interval(tree.primitive_of(node), ball);
}

std::uint32_t run_of(const CompiledTree& tree, const CompiledNode& node, std::uint32_t atom) {
  return tree.leaf_of(node).first_run + (atom - node.first_atom) / kRunAtoms;
}

/// Writes one list, and forgets a chain's segments that others hide everywhere.
class Listing {
 public:
  Listing(ActiveAtoms& active, std::size_t most) : active_(active) {
    active.atoms.resize(most);
    active.bounds.resize(most);
    atoms_ = active.atoms.data();
    bounds_ = active.bounds.data();
  }
  ~Listing() {
    drop_hidden();
    active_.atoms.resize(count_);
    active_.bounds.resize(count_);
  }
  Listing(const Listing&) = delete;
  Listing& operator=(const Listing&) = delete;

  void add(std::uint32_t atom, const Interval& bounds) {
    drop_hidden();
    chain_ = kNone;
    append(atom, bounds);
  }
  void add_segment(std::uint32_t atom, std::uint32_t chain, double ratio_lo, double ratio_hi) {
    if (chain != chain_) {
      drop_hidden();
      chain_ = chain;
      begin_ = count_;
      nearest_ = kInfinity;
      farthest_ = 0;
    }
    nearest_ = std::min(nearest_, ratio_hi * (1 + 1e-9) + 1e-9);
    farthest_ = std::max(farthest_, ratio_lo);
    append(atom, {ratio_lo, ratio_hi});
  }

 private:
  void append(std::uint32_t atom, const Interval& bounds) {
    atoms_[count_] = atom;
    bounds_[count_++] = bounds;
  }
  void drop_hidden() {
    if (!(farthest_ > nearest_)) return;
    std::size_t kept = begin_;
    for (std::size_t i = begin_; i < count_; ++i) {
      atoms_[kept] = atoms_[i];
      bounds_[kept] = bounds_[i];
      kept += bounds_[i].lo <= nearest_;
    }
    count_ = kept;
    nearest_ = kInfinity;
  }

  ActiveAtoms& active_;
  std::uint32_t* atoms_;
  Interval* bounds_;
  std::size_t count_ = 0;
  std::uint32_t chain_ = kNone;   // whose segments are being listed,
  std::size_t begin_ = 0;         // where they begin,
  double nearest_ = kInfinity;    // what the nearest one's distance stays below everywhere in the box,
  double farthest_ = 0;           // and the most that one's distance stays above
};

/// The most that the flare at hand widens its chain in a box, found once for all its segments.
class Widening {
 public:
  /// ball: around the box; half_size: of the box. 1 of a chain.
  double most(const CompiledTree& tree, std::uint32_t id, const Ball& ball, const Vec3& half_size) {
    const CompiledNode& node = tree.nodes[id];
    if (node.op == Op::kChain) return 1;
    if (id != flare_) most_ = flare_factor_interval(tree.flare_of(node), ball, half_size).hi;
    flare_ = id;
    return most_;
  }

 private:
  std::uint32_t flare_ = kNone;
  double most_ = 1;
};

/// Which of a cube's children a box meets, as bits.
class TouchedChildren {
 public:
  explicit TouchedChildren(const Box& cube) : cube_(cube), middle_(cube.center()) {}
  std::uint8_t operator()(const Box& box) const {
    if (!box.intersects(cube_)) return 0;
    return static_cast<std::uint8_t>(sides(0, box, 0x55, 0xaa) & sides(1, box, 0x33, 0xcc) & sides(2, box, 0x0f, 0xf0));
  }

 private:
  int sides(int a, const Box& box, int low, int high) const {
    return (box.lo[a] <= middle_[a] ? low : 0) | (box.hi[a] >= middle_[a] ? high : 0);
  }
  const Box& cube_;
  Vec3 middle_;
};

}  // namespace

void find_active(const CompiledTree& tree, std::span<const std::uint32_t> candidates, const Box& box, ActiveAtoms& active) {
  Listing list(active, candidates.size());
  const FloatBox reach(box);
  const Ball ball = ball_around(box);
  const Vec3 half_size = 0.5 * box.size();
  Widening widening;
  const bool bounded = ball.radius < kInfinity;
  for (const std::uint32_t atom : candidates) {
    const std::uint32_t id = tree.node_of_atom[atom];
    const CompiledNode& node = tree.nodes[id];
    if (!tree.run_bounds[run_of(tree, node, atom)].intersects(reach)) continue;
    if (!bounded || node.warp != kNone) {
      list.add(atom, {});
    } else if (is_swept(node.op)) {
      if (!tree.segment_support(node, atom).intersects(box)) continue;
      const Interval x = swept_ratio_interval(tree.segment_of(atom), ball);
      if (x.lo < kFar * widening.most(tree, id, ball, half_size)) list.add_segment(atom, id, x.lo, x.hi);
    } else {
      const Interval f = bounds_of(tree, node, ball);
      if (f.lo != 0 || f.hi != 0) list.add(atom, f);
    }
  }
}

void find_active(const CompiledTree& tree, const Box& box, ActiveAtoms& active) {
  std::vector<std::uint32_t> near;
  for (const std::uint32_t run : tree.index.query(tree.run_bounds, FloatBox(box)))
    for (std::uint32_t a = tree.run_first_atom[run]; a < tree.end_atom_of_run(run); ++a) near.push_back(a);
  find_active(tree, near, box, active);
}

void ChildSplitter::split(const CompiledTree& tree, std::span<const std::uint32_t> candidates, const Box& cube,
                          std::array<ActiveAtoms, kChildren>& children) {
  // Children are halves; what they are centred at and how far they reach.
  const Vec3 middle = cube.center(), quarter = 0.25 * cube.size();
  BallCenters centers;
  std::array<Ball, kChildren> balls;
  for (std::size_t k = 0; k < kChildren; ++k) {
    for (int a = 0; a < 3; ++a) balls[k].center[a] = centers[a][k] = middle[a] + (k >> a & 1 ? quarter[a] : -quarter[a]);
  }
  const double radius = glm::length(quarter) * (1 + 1e-9) + 1e-14 * (glm::length(middle) + glm::length(quarter));
  for (Ball& ball : balls) ball.radius = radius;
  std::array<Widening, kChildren> widenings;
  const TouchedChildren touched_by(cube);
  std::uint32_t last_run = kNone;      // neighbours most often share one
  std::uint8_t touched_by_run = 0;

  const std::size_t n = candidates.size();
  std::array<Listing, kChildren> lists{Listing(children[0], n), Listing(children[1], n), Listing(children[2], n),
                                       Listing(children[3], n), Listing(children[4], n), Listing(children[5], n),
                                       Listing(children[6], n), Listing(children[7], n)};
  constexpr std::size_t kBlock = 64;   // of segments whose bounds are found in one go
  segments_.resize(kBlock);
  bounds_.resize(kBlock);
  std::array<std::uint8_t, kBlock> touched;
  for (std::size_t begin = 0; begin < candidates.size(); begin += kBlock) {
    const std::span<const std::uint32_t> block = candidates.subspan(begin, std::min(kBlock, candidates.size() - begin));
    std::size_t count = 0;
    for (std::size_t i = 0; i < block.size(); ++i) {
      const CompiledNode& node = tree.node_of(block[i]);
      if (const std::uint32_t run = run_of(tree, node, block[i]); run != last_run) {
        last_run = run;
        touched_by_run = touched_by(tree.run_bounds[run].box());
      }
      touched[i] = touched_by_run;
      if (touched[i] == 0 || !is_swept(node.op) || node.warp != kNone) continue;
      touched[i] &= touched_by(tree.segment_support(node, block[i]));
      if (touched[i] != 0) segments_[count++] = tree.segment_of(block[i]);
    }
    bound_swept_ratios(segments_.data(), count, centers, radius, bounds_.data());
    const BallBounds* ratio = bounds_.data();
    for (std::size_t i = 0; i < block.size(); ++i) {
      if (touched[i] == 0) continue;
      const std::uint32_t atom = block[i], id = tree.node_of_atom[atom];
      const CompiledNode& node = tree.nodes[id];
      const bool warped = node.warp != kNone, segment = !warped && is_swept(node.op);
      for (unsigned bits = touched[i]; bits != 0; bits &= bits - 1) {
        const auto k = static_cast<std::size_t>(std::countr_zero(bits));
        if (segment) {
          if (ratio->lo[k] < kFar * widenings[k].most(tree, id, balls[k], quarter)) lists[k].add_segment(atom, id, ratio->lo[k], ratio->hi[k]);
        } else if (warped) {
          lists[k].add(atom, {});
        } else {
          const Interval f = bounds_of(tree, node, balls[k]);
          if (f.lo != 0 || f.hi != 0) lists[k].add(atom, f);
        }
      }
      ratio += segment;
    }
  }
}

}  // namespace cambium
