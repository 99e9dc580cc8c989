// What an Evaluator keeps between calls. Private to blobtree/.
#pragma once

#include "blobtree/field.h"
#include "blobtree/interpreter.h"
#include "blobtree/surface_traits.h"

namespace cambium {

struct Evaluator::Scratch {
  std::vector<Vec3> points;                 ///< the query point in each frame, frame 0 first
  std::vector<UnwarpedBall> balls;
  TapeScratch<double> numbers;
  TapeScratch<float> floats;
  TapeScratch<Dual<double>> duals;
  TapeScratch<Dual<float>> float_duals;
  TapeScratch<Interval> intervals;
  TapeScratch<TraitedValue> traits;

  static TapeView view(const PrunedField& field) { return {*field.tree_, field.tape_, field.slots_, field.frames_, field.stack_size_}; }
  static const Warp& warp_of_frame(const PrunedField& field, std::size_t frame) {  // frame >= 1
    const CompiledTree& tree = *field.tree_;
    return tree.warps[tree.nodes[field.frames_[2 * (frame - 1)]].payload];
  }

  /// The point in the space of every frame.
  void place(const PrunedField& field, const Vec3& p) {
    points.resize(1 + field.frames_.size() / 2);
    points[0] = p;
    for (std::size_t k = 1; k < points.size(); ++k)
      points[k] = unwarp(warp_of_frame(field, k), points[field.frames_[2 * (k - 1) + 1]]);
  }
  /// The point outside of the warp whose inner space is `frame`.
  const Vec3& outside_of(const PrunedField& field, std::size_t frame) const {
    return points[field.frames_[2 * (frame - 1) + 1]];
  }
};

/// A point in double.
template <class N>
class PointPolicy {
 public:
  PointPolicy(const CompiledTree& tree, const PrunedField& field, const Evaluator::Scratch& at, const std::vector<std::uint32_t>& slots)
      : tree_(tree), field_(field), at_(at), slots_(slots) {}

  N primitive(const PrunedField::Instruction& in) const {
    const CompiledPrimitive& p = tree_.primitives[tree_.nodes[in.node].payload];
    const Distance<double> d = std::visit([&](const auto& shape) { return distance(shape, at_.points[in.frame]); }, p.shape);
    return falloff_of<N>(d, p.inverse_support, p.strength);
  }
  N half_space(const PrunedField::Instruction& in) const {
    const CompiledHalfSpace& h = tree_.half_spaces[tree_.nodes[in.node].payload];
    return half_space_of<N>(glm::dot(at_.points[in.frame] - h.point, h.normal), h.normal, h.width);
  }
  N chain(const PrunedField::Instruction& in) const {
    const Vec3& p = at_.points[in.frame];
    double best = kInfinity;
    std::uint32_t winner = 0;
    for (std::uint32_t i = in.first; i < in.first + in.count; ++i) {
      const std::uint32_t segment = tree_.atoms[slots_[i]].segment;
      const double x = swept_ratio(tree_.segments[segment], p);
      if (x < best) {
        best = x;
        winner = segment;
      }
    }
    Distance<double> d{best, Vec3(0.0)};
    if constexpr (!std::is_floating_point_v<N>) d = swept_ratio_gradient(tree_.segments[winner], p);
    return falloff_of<N>(d, kRadiusPerSupport, tree_.chain_strengths[tree_.nodes[in.node].payload]);
  }
  N lateral_weight(const Lateral& lateral, const PrunedField::Instruction& in) const {
    return lateral_contact_weight<N>(lateral, at_.points[in.frame] - lateral.point);
  }
  N warp(const PrunedField::Instruction& in, const N& f) const {
    if constexpr (std::is_floating_point_v<N>) {
      return f;
    } else {
      return N(f.f, pull_back(Evaluator::Scratch::warp_of_frame(field_, in.frame), at_.outside_of(field_, in.frame), f.g));
    }
  }

 private:
  const CompiledTree& tree_;
  const PrunedField& field_;
  const Evaluator::Scratch& at_;
  const std::vector<std::uint32_t>& slots_;
};

}  // namespace cambium
