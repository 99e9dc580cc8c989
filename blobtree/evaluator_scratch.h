// What an Evaluator keeps between calls. Private to blobtree/.
#pragma once

#include "blobtree/batch.h"
#include "blobtree/course.h"
#include "blobtree/field.h"
#include "blobtree/interpreter.h"
#include "blobtree/surface_traits.h"

#include <cstddef>
#include <optional>
#include <vector>

namespace cambium {

/// The shapes of one tape, gathered from the tree so that a query reads them in a row. Kept until another tape is asked for.
class GatheredShapes {
 public:
  void gather(const CompiledTree& tree, const Tape& tape) {
    if (gathered_.is(tree, tape)) return;
    gathered_.forget();   // should the following throw
    segments_.resize(tape.slots().size());
    coordinates_.assign(tape.slots().size(), std::nullopt);
    place_.resize(tape.instructions().size());
    primitives_.clear();
    for (std::size_t i = 0; i < place_.size(); ++i) {
      const Instruction& in = tape.instructions()[i];
      if (is_swept(in.op)) {
        for (std::uint32_t k = in.first; k < in.first + in.count; ++k) segments_[k] = tree.segment_of(tape.slots()[k]);
      } else if (in.op == Op::kPrimitive) {
        place_[i] = static_cast<std::uint32_t>(primitives_.size());
        primitives_.push_back(tree.primitive_of(tree.nodes[in.node]));
      }
    }
    gathered_.remember(tree, tape);
  }
  /// `at`: of the instruction in its tape.
  const CompiledPrimitive& primitive(std::size_t at) const { return primitives_[place_[at]]; }
  /// By slot.
  const SweptSegment<double>* segments() const { return segments_.data(); }
  /// Native coordinates of a chain's segment in a slot of the gathered tape, worked out when first asked for.
  const CarriedCoordinates& coordinates(const TapeView& view, std::size_t slot) {
    if (!coordinates_[slot]) coordinates_[slot] = view.tree.coordinates_of(view.tape.slots()[slot]);
    return *coordinates_[slot];
  }

 private:
  RememberedTape gathered_;
  std::vector<std::uint32_t> place_;
  std::vector<SweptSegment<double>> segments_;
  std::vector<std::optional<CarriedCoordinates>> coordinates_;
  std::vector<CompiledPrimitive> primitives_;
};

struct Evaluator::Scratch {
  GatheredShapes shapes;
  std::vector<Vec3> points;                 ///< the query point in each frame, frame 0 first
  std::vector<UnwarpedBall> balls;
  TapeScratch<double> numbers;
  TapeScratch<Dual<double>> duals;
  TapeScratch<Interval> intervals;
  TapeScratch<TraitedValue> traits;
  TapeScratch<Course> courses;
  std::vector<Way> ways;                    ///< the way in each frame
  std::vector<SeenSegment> seen;            ///< of one chain
  std::vector<SquaredRatio> ratios;         ///< of those of them that count
  BatchScratch batch;

  static TapeView view(const PrunedField& field) { return {*field.tree_, *field.tape_}; }

  Interval interval(const CompiledTree& tree, const Tape& tape, const Ball& ball);

  /// Gets ready for a point: the shapes, and the point in the space of every frame.
  TapeView place(const PrunedField& field, const Vec3& p) {
    const TapeView tape = view(field);
    shapes.gather(*field.tree_, *field.tape_);
    points.resize(tape.frame_count());
    points[0] = p;
    for (std::size_t k = 1; k < points.size(); ++k) points[k] = unwarp(tape.warp_of(k), points[tape.outside_of(k)]);
    return tape;
  }
};

/// A point in double.
template <class N>
class PointPolicy {
 public:
  PointPolicy(const TapeView& view, const Evaluator::Scratch& at) : view_(view), at_(at) {}

  N primitive(const Instruction& in) const {
    const CompiledPrimitive& p = at_.shapes.primitive(static_cast<std::size_t>(&in - view_.tape.instructions().data()));
    const Distance<double> d = std::visit([&](const auto& shape) { return distance(shape, at_.points[in.frame]); }, p.shape);
    return falloff_of<N>(d, p.inverse_support, p.strength);
  }
  N half_space(const Instruction& in) const {
    const CompiledHalfSpace& h = view_.tree.half_spaces[view_.tree.nodes[in.node].payload];
    return half_space_of<N>(glm::dot(at_.points[in.frame] - h.point, h.normal), h.normal, h.width);
  }
  N chain(const Instruction& in) const {
    return falloff_of<N>(swept(in), kRadiusPerSupport, view_.tree.chain_strength_of(view_.tree.nodes[in.node]));
  }
  N flare(const Instruction& in) const {
    const CompiledNode& node = view_.tree.nodes[in.node];
    const CompiledFlare& flare = view_.tree.flare_of(node);
    Distance<double> d = swept(in);
    if constexpr (std::is_floating_point_v<N>) {
      d.value /= flare_factor(flare, at_.points[in.frame]);
    } else {
      const FlareFactor m = flare_factor_gradient(flare, at_.points[in.frame]);
      d.value /= m.value;
      d.gradient = d.gradient / m.value - d.value * m.log_gradient;
    }
    return falloff_of<N>(d, kRadiusPerSupport, view_.tree.chain_strength_of(node));
  }
  N lateral_weight(const Lateral& lateral, const Instruction& in) const {
    return lateral_contact_weight<N>(lateral, at_.points[in.frame] - lateral.point);
  }
  N warp(const Instruction& in, const N& f) const {
    if constexpr (std::is_floating_point_v<N>) {
      return f;
    } else {
      return N(f.f, pull_back(view_.warp_of(in.frame), at_.points[view_.outside_of(in.frame)], f.g));
    }
  }

 private:
  /// The ratio of the nearest segment, and its gradient if one is asked for.
  Distance<double> swept(const Instruction& in) const {
    const Vec3& p = at_.points[in.frame];
    const SweptSegment<double>* const segments = at_.shapes.segments() + in.first;
    double best = kInfinity;
    std::uint32_t winner = 0;
    for (std::uint32_t i = 0; i < in.count; ++i) {
      const double x = swept_ratio(segments[i], p);
      if (x < best) {
        best = x;
        winner = i;
      }
    }
    if constexpr (std::is_floating_point_v<N>) return {best, Vec3(0.0)};
    return swept_ratio_gradient(segments[winner], p);
  }

  const TapeView& view_;
  const Evaluator::Scratch& at_;
};

}  // namespace cambium
