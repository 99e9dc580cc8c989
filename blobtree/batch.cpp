// Batches of points given as floats relative to the origin of the pruned box. Shapes are first placed relative to that origin in
// double and then rounded, so that a 1 mm twig 30 m up loses nothing. Where floats could not keep 1e-4 (a box much larger than
// the thinnest primitive in it) the same batch runs in double.
#include "blobtree/evaluator_scratch.h"

#include <stdexcept>

namespace cambium {
namespace {

template <class T>
PointSkeleton<T> localised(const PointSkeleton<double>& k, const Vec3& origin) {
  return {Vec<T>(k.center - origin)};
}
template <class T>
SegmentSkeleton<T> localised(const SegmentSkeleton<double>& k, const Vec3& origin) {
  const double s = std::clamp(glm::dot(origin - k.a, k.axis), k.begin, k.end);  // anchor at the point nearest to the box
  return {Vec<T>(k.a + s * k.axis - origin), Vec<T>(k.axis), T(k.begin - s), T(k.end - s)};
}
template <class T>
ConeSkeleton<T> localised(const ConeSkeleton<double>& k, const Vec3& origin) {
  return {Vec<T>(k.base - origin), Vec<T>(k.axis), T(k.height), T(k.disc_radius)};
}
template <class T>
DiscSkeleton<T> localised(const DiscSkeleton<double>& k, const Vec3& origin) {
  return {Vec<T>(k.center - origin), Vec<T>(k.normal), T(k.disc_radius)};
}
template <class T>
CircleSkeleton<T> localised(const CircleSkeleton<double>& k, const Vec3& origin) {
  return {Vec<T>(k.center - origin), Vec<T>(k.normal), T(k.ring_radius)};
}
template <class T>
BoxSkeleton<T> localised(const BoxSkeleton<double>& k, const Vec3& origin) {
  return {Vec<T>(k.center - origin), Vec<T>(k.half_size), glm::mat<3, 3, T>(k.world_from_box)};
}
template <class T>
SweptSegment<T> localised(const SweptSegment<double>& k, const Vec3& origin) {
  const double s = std::clamp(glm::dot(origin - k.a, k.axis), k.begin, k.end);
  return {Vec<T>(k.a + s * k.axis - origin), Vec<T>(k.axis), T(k.begin - s), T(k.end - s), T(k.radius_at(s)), T(k.slope)};
}

/// How long a shape is that cannot be anchored near the box.
double extent(const PointSkeleton<double>&) { return 0; }
double extent(const SegmentSkeleton<double>&) { return 0; }
double extent(const ConeSkeleton<double>& k) { return k.height + k.disc_radius; }
double extent(const DiscSkeleton<double>& k) { return k.disc_radius; }
double extent(const CircleSkeleton<double>& k) { return k.ring_radius; }
double extent(const BoxSkeleton<double>& k) { return glm::length(k.half_size); }

/// One primitive per instruction that pushes one, or the segments of a chain.
template <class T>
struct LocalShapes {
  struct Primitive {
    SkeletonShape<T> shape;
    T inverse_support, strength;
  };
  struct HalfSpaceAt {
    Vec<T> point, normal;
    T width;
  };
  std::vector<Primitive> primitives;
  std::vector<SweptSegment<T>> segments;
  std::vector<HalfSpaceAt> half_spaces;
  std::vector<Vec<T>> lateral_points;
};

/// Shapes are consumed in the order of the tape, so a counter per kind finds them.
template <class N, class T>
class LanePolicy {
 public:
  LanePolicy(const TapeView& view, const LocalShapes<T>& shapes) : tree_(view.tree), view_(view), shapes_(shapes) {}

  void place(const std::vector<Vec<T>>& points, const std::vector<Vec3>& warped_from) {
    points_ = points.data();
    warped_from_ = warped_from.data();
    primitive_ = segment_ = half_space_ = lateral_ = 0;
  }

  N primitive(const Instruction& in) {
    const auto& p = shapes_.primitives[primitive_++];
    const Distance<T> d = std::visit([&](const auto& shape) { return distance(shape, points_[in.frame]); }, p.shape);
    return falloff_of<N>(d, p.inverse_support, p.strength);
  }
  N half_space(const Instruction& in) {
    const auto& h = shapes_.half_spaces[half_space_++];
    return half_space_of<N>(glm::dot(points_[in.frame] - h.point, h.normal), h.normal, h.width);
  }
  N chain(const Instruction& in) {
    const SweptSegment<T>* const segments = shapes_.segments.data() + segment_;
    segment_ += in.count;
    T best = swept_ratio(segments[0], points_[in.frame]);
    std::uint32_t winner = 0;
    for (std::uint32_t i = 1; i < in.count; ++i) {
      const T x = swept_ratio(segments[i], points_[in.frame]);
      if (x < best) {
        best = x;
        winner = i;
      }
    }
    Distance<T> d{best, Vec<T>(T(0))};
    if constexpr (!std::is_floating_point_v<N>) d = swept_ratio_gradient(segments[winner], points_[in.frame]);
    return falloff_of<N>(d, T(kRadiusPerSupport), T(tree_.chain_strengths[tree_.nodes[in.node].payload]));
  }
  N lateral_weight(const Lateral& lateral, const Instruction& in) {
    return lateral_contact_weight<N>(lateral, points_[in.frame] - shapes_.lateral_points[lateral_++]);
  }
  N warp(const Instruction& in, const N& f) {
    if constexpr (std::is_floating_point_v<N>) {
      return f;
    } else {
      const Warp& w = view_.warp_of(in.frame);
      return N(f.f, Vec<T>(pull_back(w, warped_from_[in.frame], Vec3(f.g))));
    }
  }

 private:
  const CompiledTree& tree_;
  const TapeView& view_;
  const LocalShapes<T>& shapes_;
  const Vec<T>* points_ = nullptr;
  const Vec3* warped_from_ = nullptr;
  std::size_t primitive_ = 0, segment_ = 0, half_space_ = 0, lateral_ = 0;
};

/// Whether floats relative to the box keep the promised 1e-4: |error of f| is about 4 ulp * 1.7 * size / R.
/// Under a warp sizes change from place to place: double.
bool fits_in_float(const TapeView& view, const Box& box, bool warped) {
  if (warped || !box.bounded()) return false;
  constexpr double kLargestRatio = 64;
  const double half = 0.5 * glm::length(box.size());
  for (const Instruction& in : view.tape) {
    const CompiledNode& n = view.tree.nodes[in.node];
    if (n.op == Op::kPrimitive && static_cast<Op>(in.op) == Op::kPrimitive) {
      const CompiledPrimitive p = view.tree.primitive_of(n);
      const double size = half + std::visit([](const auto& shape) { return extent(shape); }, p.shape);
      if (size * p.inverse_support > kLargestRatio) return false;
    } else if (n.op == Op::kHalfSpace) {
      if (half > kLargestRatio * n.range.hi * view.tree.half_spaces[n.payload].width) return false;
    } else if (n.op == Op::kChain) {
      for (std::uint32_t i = in.first; i < in.first + in.count; ++i)
        if (half > kLargestRatio * kSupportPerRadius * view.tree.atoms[view.slots[i]].radius) return false;
    } else if (n.op == Op::kFork) {
      for (const Lateral& l : view.tree.blends[n.payload].laterals)
        if (half > kLargestRatio * l.softness) return false;
    }
  }
  return true;
}

template <class N, class T>
void run_batch(const TapeView& view, const Vec3& origin_of_box, TapeScratch<N>& scratch,
               std::span<const float> x, std::span<const float> y, std::span<const float> z, const auto& store) {
  const CompiledTree& tree = view.tree;
  const std::size_t frame_count = view.frame_count();
  std::vector<Vec3> origins(frame_count), warped_from(frame_count), placed(frame_count);
  std::vector<Vec<T>> points(frame_count);
  origins[0] = origin_of_box;
  for (std::size_t k = 1; k < frame_count; ++k)
    origins[k] = unwarp(view.warp_of(k), origins[view.outside_of(k)]);

  LocalShapes<T> shapes;
  for (const Instruction& in : view.tape) {
    const CompiledNode& n = tree.nodes[in.node];
    const Vec3& origin = origins[in.frame];
    switch (static_cast<Op>(in.op)) {
      case Op::kPrimitive: {
        const CompiledPrimitive p = tree.primitive_of(n);
        shapes.primitives.push_back({std::visit([&](const auto& s) -> SkeletonShape<T> { return localised<T>(s, origin); }, p.shape),
                                     T(p.inverse_support), T(p.strength)});
        break;
      }
      case Op::kHalfSpace: {
        const CompiledHalfSpace& h = tree.half_spaces[n.payload];
        const Vec3 nearest = origin - glm::dot(origin - h.point, h.normal) * h.normal;
        shapes.half_spaces.push_back({Vec<T>(nearest - origin), Vec<T>(h.normal), T(h.width)});
        break;
      }
      case Op::kChain:
        for (std::uint32_t i = in.first; i < in.first + in.count; ++i)
          shapes.segments.push_back(localised<T>(tree.segment_of(view.slots[i]), origin));
        break;
      case Op::kFork:
        for (std::uint32_t i = in.first; i < in.first + in.count; ++i)
          if (view.slots[i] > 0)
            shapes.lateral_points.push_back(Vec<T>(tree.blends[n.payload].laterals[view.slots[i] - 1].point - origin));
        break;
      default: break;
    }
  }

  LanePolicy<N, T> policy(view, shapes);
  for (std::size_t i = 0; i < x.size(); ++i) {
    points[0] = Vec<T>(T(x[i]), T(y[i]), T(z[i]));
    if (frame_count > 1) {
      placed[0] = origins[0] + Vec3(x[i], y[i], z[i]);
      for (std::size_t k = 1; k < frame_count; ++k) {
        warped_from[k] = placed[view.outside_of(k)];
        placed[k] = unwarp(view.warp_of(k), warped_from[k]);
        points[k] = Vec<T>(placed[k] - origins[k]);
      }
    }
    policy.place(points, warped_from);
    store(i, run_tape(view, policy, scratch));
  }
}

void check_lengths(std::size_t n, std::initializer_list<std::size_t> others) {
  for (const std::size_t other : others)
    if (other != n) throw std::invalid_argument("batch arrays differ in length");
}

}  // namespace

void Evaluator::values(const PrunedField& field, std::span<const float> x, std::span<const float> y, std::span<const float> z,
                       std::span<float> f) {
  check_lengths(x.size(), {y.size(), z.size(), f.size()});
  if (field.empty()) {
    std::fill(f.begin(), f.end(), 0.0f);
    return;
  }
  const TapeView view = Scratch::view(field);
  const auto store = [&](std::size_t i, auto value) { f[i] = static_cast<float>(value); };
  if (fits_in_float(view, field.box(), !view.frames.empty()))
    run_batch<float, float>(view, field.origin(), scratch_->floats, x, y, z, store);
  else
    run_batch<double, double>(view, field.origin(), scratch_->numbers, x, y, z, store);
}

void Evaluator::samples(const PrunedField& field, std::span<const float> x, std::span<const float> y, std::span<const float> z,
                        std::span<float> f, std::span<float> gx, std::span<float> gy, std::span<float> gz) {
  check_lengths(x.size(), {y.size(), z.size(), f.size(), gx.size(), gy.size(), gz.size()});
  const auto store = [&](std::size_t i, const auto& value) {
    f[i] = static_cast<float>(value.f);
    gx[i] = static_cast<float>(value.g.x);
    gy[i] = static_cast<float>(value.g.y);
    gz[i] = static_cast<float>(value.g.z);
  };
  if (field.empty()) {
    for (std::size_t i = 0; i < x.size(); ++i) store(i, Dual<float>());
    return;
  }
  const TapeView view = Scratch::view(field);
  if (fits_in_float(view, field.box(), !view.frames.empty()))
    run_batch<Dual<float>, float>(view, field.origin(), scratch_->float_duals, x, y, z, store);
  else
    run_batch<Dual<double>, double>(view, field.origin(), scratch_->duals, x, y, z, store);
}

}  // namespace cambium
