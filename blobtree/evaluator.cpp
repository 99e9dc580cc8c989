// Point queries: value, gradient, interval, contributions and traits. Batches are in batch.cpp.
#include "blobtree/evaluator_scratch.h"

#include <cmath>
#include <numbers>

namespace cambium {
namespace {

using Instruction = PrunedField::Instruction;

/// A ball: bounds of everything over it.
class BallPolicy {
 public:
  BallPolicy(const CompiledTree& tree, const std::vector<UnwarpedBall>& balls, const std::vector<std::uint32_t>& slots)
      : tree_(tree), balls_(balls), slots_(slots) {}

  Interval primitive(const Instruction& in) const {
    return atom_interval(tree_, tree_.atoms[in.first], balls_[in.frame].ball);
  }
  Interval half_space(const Instruction& in) const { return primitive(in); }
  Interval chain(const Instruction& in) const {
    Interval x{kInfinity, kInfinity};
    for (std::uint32_t i = in.first; i < in.first + in.count; ++i) {
      const Interval s = swept_ratio_interval(tree_.segments[tree_.atoms[slots_[i]].segment], balls_[in.frame].ball);
      x = {std::min(x.lo, s.lo), std::min(x.hi, s.hi)};
    }
    // Closed forms above round; a value must never escape by a bit.
    return falloff_interval(x.lo * kRadiusPerSupport * (1 - 1e-13), x.hi * kRadiusPerSupport * (1 + 1e-13),
                            tree_.chain_strengths[tree_.nodes[in.node].payload]);
  }
  Interval lateral_weight(const Lateral& lateral, const Instruction& in) const {
    return lateral_contact_weight_interval(lateral, balls_[in.frame].ball);
  }
  Interval warp(const Instruction& in, const Interval& f) const {
    if (balls_[in.frame].certain) return f;
    const Interval& anywhere = tree_.nodes[in.node].range;
    return {std::min(0.0, anywhere.lo), std::max(0.0, anywhere.hi)};
  }

 private:
  const CompiledTree& tree_;
  const std::vector<UnwarpedBall>& balls_;
  const std::vector<std::uint32_t>& slots_;
};

/// A point, with how its surface came about.
class TraitsPolicy {
 public:
  explicit TraitsPolicy(const PointPolicy<double>& point) : point_(point) {}
  TraitedValue primitive(const Instruction& in) const { return {point_.primitive(in), {}}; }
  TraitedValue half_space(const Instruction& in) const { return {point_.half_space(in), {1, 0, 0}}; }
  TraitedValue chain(const Instruction& in) const { return {point_.chain(in), {}}; }
  TraitedValue lateral_weight(const Lateral& l, const Instruction& in) const { return {point_.lateral_weight(l, in), {}}; }
  TraitedValue warp(const Instruction&, const TraitedValue& f) const { return f; }

 private:
  const PointPolicy<double>& point_;
};

double turns(double y, double x) {
  const double t = std::atan2(y, x) / (2 * std::numbers::pi);
  return t < 0 ? std::min(t + 1, std::nextafter(1.0, 0.0)) : t;
}

/// Where the axis of native coordinates begins and points.
struct NativeAxis {
  Vec3 origin, axis;
};
NativeAxis native_axis(const PointSkeleton<double>& k) { return {k.center, {0, 0, 1}}; }
NativeAxis native_axis(const SegmentSkeleton<double>& k) { return {k.a, k.axis}; }
NativeAxis native_axis(const ConeSkeleton<double>& k) { return {k.base, k.axis}; }
NativeAxis native_axis(const DiscSkeleton<double>& k) { return {k.center, k.normal}; }
NativeAxis native_axis(const CircleSkeleton<double>& k) { return {k.center, k.normal}; }
NativeAxis native_axis(const BoxSkeleton<double>& k) { return {k.center, k.world_from_box[2]}; }

}  // namespace

Evaluator::Evaluator() : scratch_(std::make_unique<Scratch>()) {}
Evaluator::~Evaluator() = default;

double Evaluator::value(const PrunedField& field, const Vec3& p) {
  if (field.empty()) return 0;
  Scratch& s = *scratch_;
  s.place(field, p);
  PointPolicy<double> policy(*field.tree_, field, s, field.slots_);
  return run_tape(Scratch::view(field), policy, s.numbers);
}

Sample Evaluator::sample(const PrunedField& field, const Vec3& p) {
  if (field.empty()) return {};
  Scratch& s = *scratch_;
  s.place(field, p);
  PointPolicy<Dual<double>> policy(*field.tree_, field, s, field.slots_);
  const Dual<double> d = run_tape(Scratch::view(field), policy, s.duals);
  return {d.f, d.g};
}

Interval Evaluator::interval(const PrunedField& field, const Ball& ball) {
  if (field.empty()) return {0, 0};
  Scratch& s = *scratch_;
  s.balls.resize(1 + field.frames_.size() / 2);
  s.balls[0] = {{ball.center, ball.radius * (1 + 1e-12)}, true};
  for (std::size_t k = 1; k < s.balls.size(); ++k)
    s.balls[k] = unwarp(Scratch::warp_of_frame(field, k), s.balls[field.frames_[2 * (k - 1) + 1]].ball);
  BallPolicy policy(*field.tree_, s.balls, field.slots_);
  return run_tape(Scratch::view(field), policy, s.intervals);
}

void Evaluator::contributions(const PrunedField& field, const Vec3& p, std::vector<Contribution>& out) {
  out.clear();
  if (field.empty()) return;
  Scratch& s = *scratch_;
  s.place(field, p);
  const CompiledTree& tree = *field.tree_;
  const PointPolicy<double> policy(tree, field, s, field.slots_);
  for (const Instruction& in : field.tape_) {
    const CompiledNode& node = tree.nodes[in.node];
    const auto op = static_cast<Op>(in.op);
    if (node.subtracted || (op != Op::kPrimitive && op != Op::kChain)) continue;
    const double weight = op == Op::kChain ? policy.chain(in) : policy.primitive(in);
    if (!(weight > 0)) continue;
    Contribution c;
    c.weight = weight;
    c.branch = tree.branch[in.node];
    c.order = tree.order[in.node];
    const Vec3& q = s.points[in.frame];
    const auto place = [&](std::uint32_t atom, const NativeAxis& native, double along) {
      const AtomCoordinates& at = tree.coordinates[atom];
      const Vec3 from = q - native.origin;
      c.v = at.v + along;
      c.u = turns(glm::dot(from, glm::cross(native.axis, at.u_direction)), glm::dot(from, at.u_direction));
    };
    if (op == Op::kChain) {
      double best = kInfinity;
      std::uint32_t winner = field.slots_[in.first];
      for (std::uint32_t i = in.first; i < in.first + in.count; ++i) {
        const double x = swept_ratio(tree.segments[tree.atoms[field.slots_[i]].segment], q);
        if (x < best) {
          best = x;
          winner = field.slots_[i];
        }
      }
      const SweptSegment<double>& segment = tree.segments[tree.atoms[winner].segment];
      const double along = closest_parameter(segment, q - segment.a);
      c.radius = segment.radius_at(along);
      place(winner, {segment.a, segment.axis}, along);
    } else {
      const CompiledPrimitive& primitive = tree.primitives[node.payload];
      const NativeAxis native = std::visit([](const auto& shape) { return native_axis(shape); }, primitive.shape);
      c.radius = tree.atoms[in.first].radius;
      place(in.first, native, glm::dot(q - native.origin, native.axis));
    }
    out.push_back(c);
  }
}

SurfaceTraits Evaluator::surface_traits(const PrunedField& field, const Vec3& p) {
  if (field.empty()) return {};
  Scratch& s = *scratch_;
  s.place(field, p);
  const PointPolicy<double> point(*field.tree_, field, s, field.slots_);
  TraitsPolicy policy(point);
  return run_tape(Scratch::view(field), policy, s.traits).traits;
}

}  // namespace cambium
