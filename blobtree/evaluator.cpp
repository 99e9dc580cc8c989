// Point queries: value, gradient, interval, contributions and traits. Batches are in batch.cpp.
#include "blobtree/evaluator_scratch.h"
#include "blobtree/tape_interval.h"

#include <cmath>
#include <numbers>

namespace cambium {
namespace {

/// A ball: bounds of everything over it.
class BallPolicy {
 public:
  BallPolicy(const TapeView& view, const std::vector<UnwarpedBall>& balls, const GatheredShapes& shapes)
      : view_(view), balls_(balls), shapes_(shapes) {}

  Interval primitive(const Instruction& in) const {
    return primitive_interval(shapes_.primitive(static_cast<std::size_t>(&in - view_.tape.instructions().data())), balls_[in.frame].ball);
  }
  Interval half_space(const Instruction& in) const {
    return half_space_interval(view_.tree.half_spaces[view_.tree.nodes[in.node].payload], balls_[in.frame].ball);
  }
  Interval chain(const Instruction& in) const {
    return chain_interval(ratio(in), view_.tree.chain_strength_of(view_.tree.nodes[in.node]));
  }
  Interval flare(const Instruction& in) const {
    const CompiledNode& node = view_.tree.nodes[in.node];
    const Interval factor = flare_factor_interval(view_.tree.flare_of(node), balls_[in.frame].ball);
    return flare_interval(ratio(in), factor, view_.tree.chain_strength_of(node));
  }
  Interval lateral_weight(const Lateral& lateral, const Instruction& in) const {
    return lateral_contact_weight_interval(lateral, balls_[in.frame].ball);
  }
  Interval warp(const Instruction& in, const Interval& f) const {
    if (balls_[in.frame].certain) return f;
    const Interval& anywhere = view_.tree.warps[view_.tree.nodes[in.node].payload].range;
    return {std::min(0.0, anywhere.lo), std::max(0.0, anywhere.hi)};
  }

 private:
  /// Of the nearest of a chain's segments.
  Interval ratio(const Instruction& in) const {
    Interval x{kInfinity, kInfinity};
    for (std::uint32_t i = in.first; i < in.first + in.count; ++i) {
      const Interval s = swept_ratio_interval(shapes_.segments()[i], balls_[in.frame].ball);
      x = {std::min(x.lo, s.lo), std::min(x.hi, s.hi)};
    }
    return x;
  }

  const TapeView& view_;
  const std::vector<UnwarpedBall>& balls_;
  const GatheredShapes& shapes_;
};

/// A point, with how its surface came about.
class TraitsPolicy {
 public:
  explicit TraitsPolicy(const PointPolicy<double>& point) : point_(point) {}
  TraitedValue primitive(const Instruction& in) const { return {point_.primitive(in), {}}; }
  TraitedValue half_space(const Instruction& in) const { return {point_.half_space(in), {1, 0, 0}}; }
  TraitedValue chain(const Instruction& in) const { return {point_.chain(in), {}}; }
  TraitedValue flare(const Instruction& in) const { return {point_.flare(in), {}}; }
  TraitedValue lateral_weight(const Lateral& l, const Instruction& in) const { return {point_.lateral_weight(l, in), {}}; }
  TraitedValue warp(const Instruction&, const TraitedValue& f) const { return f; }

 private:
  const PointPolicy<double>& point_;
};

/// An angle in turns, [0, 1).
double turns(double angle) {
  const double t = angle / (2 * std::numbers::pi);
  return std::min(t - std::floor(t), std::nextafter(1.0, 0.0));
}

/// Where a point lies between the ends of a chain's segment. They are planes that halve the angle with its neighbours, so metres
/// along the chain neither skip nor stand still where it turns, as the nearest parameter does; past the ends of the chain its
/// segments go straight on, so they do not stand still on a rounded tip.
struct BetweenEnds {
  double since = 0, until = 0;     ///< metres past the begin and before the end, along the segment's axis; negative outside
  bool straight = false;           ///< nothing follows there: `since` is all there is to know
  double metres(double length) const {
    if (straight) return since;
    if (since <= 0) return 0;
    return until <= 0 ? length : length * since / (since + until);
  }
  /// Metres along the chain per metre along the segment.
  double stretch(double length) const { return straight || since <= 0 || until <= 0 ? 1 : length / (since + until); }
};

/// q is counted from the segment's begin.
BetweenEnds between_ends(const CompiledTree& tree, std::uint32_t atom, const SweptSegment<double>& segment, const Vec3& q) {
  const double h = glm::dot(q, segment.axis);
  const CompiledNode& chain = tree.node_of(atom);
  const std::uint32_t last = chain.first_atom + tree.chains[chain.payload].node_count - 2;
  if (!(segment.end > 0) || (atom == chain.first_atom && h <= 0) || (atom == last && h >= segment.end)) return {h, 0, true};
  const auto passed = [&](std::uint32_t neighbour, const Vec3& from) {
    const SweptSegment<double> next = tree.segment_of(neighbour);
    const double cosine = glm::dot(next.axis, segment.axis);
    if (!(next.end > 0) || !(cosine > 0)) return glm::dot(from, segment.axis);
    return (glm::dot(from, segment.axis) + glm::dot(from, next.axis)) / (1 + cosine);
  };
  const Vec3 to_end = q - segment.end * segment.axis;
  return {atom == chain.first_atom ? h : passed(atom - 1, q),
          -(atom == last ? glm::dot(to_end, segment.axis) : passed(atom + 1, to_end))};
}

}  // namespace

Evaluator::Evaluator() : scratch_(std::make_unique<Scratch>()) {}
Evaluator::~Evaluator() = default;

double Evaluator::value(const PrunedField& field, const Vec3& p) {
  if (field.empty()) return 0;
  const TapeView view = scratch_->place(field, p);
  PointPolicy<double> policy(view, *scratch_);
  return run_tape(view, policy, scratch_->numbers);
}

Sample Evaluator::sample(const PrunedField& field, const Vec3& p) {
  if (field.empty()) return {};
  const TapeView view = scratch_->place(field, p);
  PointPolicy<Dual<double>> policy(view, *scratch_);
  const Dual<double> d = run_tape(view, policy, scratch_->duals);
  return {d.f, d.g};
}

Interval Evaluator::interval(const PrunedField& field, const Ball& ball) {
  if (field.empty()) return {0, 0};
  if (ball.radius < kInfinity) return scratch_->interval(*field.tree_, *field.tape_, ball);
  const Box& bounds = field.tree_->bounds;   // outside of it the field is 0
  if (bounds.empty()) return {0, 0};
  const Interval inside = scratch_->interval(*field.tree_, *field.tape_, circumscribed_ball(bounds));
  return {std::min(inside.lo, 0.0), std::max(inside.hi, 0.0)};
}

Interval Evaluator::interval(const PrunedField& field, const Box& box) {
  return interval(field, box.bounded() ? circumscribed_ball(box) : Ball{Vec3(0.0), kInfinity});
}

Interval Evaluator::Scratch::interval(const CompiledTree& tree, const Tape& tape, const Ball& ball) {
  const TapeView tape_view{tree, tape};
  shapes.gather(tree, tape);
  balls.resize(tape_view.frame_count());
  // Bounds and values round differently: a hair wider.
  balls[0] = {{ball.center, ball.radius * (1 + 1e-12) + 1e-15 * glm::length(ball.center)}, true};
  for (std::size_t k = 1; k < balls.size(); ++k) {
    const Warp& warp = tape_view.warp_of(k);
    const Ball& outside = balls[tape_view.outside_of(k)].ball;
    balls[k] = misses_child(warp, outside) ? UnwarpedBall{{unwarp(warp, outside.center), 0}, true} : unwarp(warp, outside);
  }
  BallPolicy policy(tape_view, balls, shapes);
  return a_hair_wider(run_tape(tape_view, policy, intervals));
}

void Evaluator::contributions(const PrunedField& field, const Vec3& p, std::vector<Contribution>& out) {
  out.clear();
  if (field.empty()) return;
  const Scratch& s = *scratch_;
  const TapeView view = scratch_->place(field, p);
  const CompiledTree& tree = view.tree;
  const PointPolicy<Dual<double>> policy(view, s);
  for (const Instruction& in : view.tape.instructions()) {
    const CompiledNode& node = tree.nodes[in.node];
    const Op op = in.op;
    if (node.subtracted || (op != Op::kPrimitive && !is_swept(op))) continue;
    const Dual<double> weight = op == Op::kPrimitive ? policy.primitive(in) : op == Op::kChain ? policy.chain(in) : policy.flare(in);
    if (!(weight.f > 0)) continue;
    Contribution c;
    c.weight = weight.f;
    c.weight_gradient = weight.g;
    c.primitive = in.node;
    c.branch = tree.leaf_of(node).branch;
    c.order = tree.leaf_of(node).order;
    const Vec3& q = s.points[in.frame];
    const auto place = [&](const CarriedCoordinates& at, const Vec3& origin, double along, double stretch) {
      const Vec3 from = q - origin, across = from - glm::dot(from, at.axis) * at.axis, to_side = glm::cross(at.axis, at.u);
      c.v = at.v + along;
      c.v_gradient = stretch * at.axis;
      c.from_axis = glm::length(across);
      c.u = turns(std::atan2(glm::dot(from, to_side), glm::dot(from, at.u)));
      if (c.from_axis > 0) c.u_gradient = glm::cross(at.axis, across) / (2 * std::numbers::pi * c.from_axis * c.from_axis);
    };
    if (is_swept(op)) {
      double best = kInfinity;
      std::uint32_t winner = in.first;
      for (std::uint32_t i = in.first; i < in.first + in.count; ++i) {
        const double x = swept_ratio(s.shapes.segments()[i], q);
        if (x < best) {
          best = x;
          winner = i;
        }
      }
      const SweptSegment<double>& segment = s.shapes.segments()[winner];
      c.radius = segment.radius_at(closest_parameter(segment, q - segment.a));
      if (op == Op::kFlare) c.radius *= flare_widening(tree.flare_of(node), q);
      const auto slots = view.tape.slots();
      const auto between = [&] {
        const SweptSegment<double>& at = s.shapes.segments()[winner];
        return between_ends(tree, slots[winner], at, q - at.a);
      };
      // Outside of a bend a node is the nearest to points on both sides of its plane.
      BetweenEnds ends = between();
      if (!ends.straight && ends.until < 0 && winner + 1 < in.first + in.count && slots[winner + 1] == slots[winner] + 1) {
        ++winner;
        ends = between();
      } else if (!ends.straight && ends.since < 0 && winner > in.first && slots[winner - 1] + 1 == slots[winner]) {
        --winner;
        ends = between();
      }
      const SweptSegment<double>& at = s.shapes.segments()[winner];
      place(scratch_->shapes.coordinates(view, winner), at.a, ends.metres(at.end), ends.stretch(at.end));
    } else {
      const CompiledPrimitive& primitive = s.shapes.primitive(static_cast<std::size_t>(&in - view.tape.instructions().data()));
      const NativeAxis native = native_axis(primitive);
      c.radius = tree.radius_of(in.first);
      place(tree.coordinates_of(in.first), native.origin, glm::dot(q - native.origin, native.axis), 1);
    }
    for (auto frame = in.frame; frame != 0; frame = view.outside_of(frame)) {
      for (Vec3* gradient : {&c.weight_gradient, &c.u_gradient, &c.v_gradient})
        *gradient = pull_back(view.warp_of(frame), s.points[view.outside_of(frame)], *gradient);
    }
    out.push_back(c);
  }
}

SurfaceTraits Evaluator::surface_traits(const PrunedField& field, const Vec3& p) {
  if (field.empty()) return {};
  const TapeView view = scratch_->place(field, p);
  const PointPolicy<double> point(view, *scratch_);
  TraitsPolicy policy(point);
  return run_tape(view, policy, scratch_->traits).traits;
}

}  // namespace cambium
