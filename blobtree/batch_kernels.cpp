// Compiled once for each set of vector instructions and chosen from at run time (Highway). Left out: SSSE3, which no
// machine of note has without SSE4; the later AVX-512 sets, of which nothing here is used; SVE and RVV, whose vectors have
// no size and so can not be members of Lanes.
#ifndef HWY_DISABLED_TARGETS
#define HWY_DISABLED_TARGETS (HWY_SSSE3 | HWY_AVX3_DL | HWY_SVE | HWY_SVE2 | HWY_SVE_256 | HWY_SVE2_128 | HWY_RVV)
#endif
#undef HWY_TARGET_INCLUDE
#define HWY_TARGET_INCLUDE "blobtree/batch_kernels.cpp"
#include <hwy/foreach_target.h>
// After foreach_target.h:
#include "blobtree/lane_flare-inl.h"
#include "blobtree/lane_power-inl.h"
#include "blobtree/lane_shapes-inl.h"
#include "blobtree/lane_warps-inl.h"

#include "blobtree/batch_kernels.h"

#include <algorithm>
#include <cstring>

// A lambda that is part of the loop it is given to: else what it returns goes through memory.
#undef CAMBIUM_INLINED
#if HWY_COMPILER_MSVC
#define CAMBIUM_INLINED
#else
#define CAMBIUM_INLINED HWY_ATTR __attribute__((always_inline))
#endif

HWY_BEFORE_NAMESPACE();
namespace cambium {
namespace HWY_NAMESPACE {

/// The weights of a fork's laterals, each worked out as it is asked for.
template <class N>
struct Weights {
  using T = typename NumberOf<N>::type;
  const LocalLateral<T>* laterals;
  LaneVector<T> p;
  HWY_INLINE N operator[](std::size_t k) const;
};

/// The points of a chunk in one frame.
template <class T>
struct Points {
  T *x, *y, *z;
  HWY_INLINE LaneVector<T> get(std::size_t i) const { return {load(x + i), load(y + i), load(z + i)}; }
};

#define CAMBIUM_RULE HWY_INLINE   // vectors handed over in registers, not in memory
#define CAMBIUM_RULE_LAMBDA HWY_ATTR
#include "blobtree/operator_rules-inl.h"
#undef CAMBIUM_RULE_LAMBDA
#undef CAMBIUM_RULE

template <class N>
HWY_INLINE N Weights<N>::operator[](std::size_t k) const {
  const LocalLateral<T>& lateral = laterals[k];
  const LaneVector<T> m = broadcast(lateral.direction), q = p - broadcast(lateral.point);
  return contact_weight<N>(q, m, dot(q, m), dot(q, q), lateral.half_per_softness, lateral.reach, lateral.per_reach);
}

/// Vectors of double, whatever they are in memory.
template <class T> HWY_INLINE DoubleVector load_doubles(const T* x, const T* y, const T* z) {
  if constexpr (std::is_same_v<T, double>) {
    return {load(x), load(y), load(z)};
  } else {
    return {load_floats<double>(x), load_floats<double>(y), load_floats<double>(z)};
  }
}
template <class T> HWY_INLINE void store_doubles(const DoubleVector& v, T* x, T* y, T* z) {
  if constexpr (std::is_same_v<T, double>) {
    store(v.x, x), store(v.y, y), store(v.z, z);
  } else {
    store_floats(v.x, x), store_floats(v.y, y), store_floats(v.z, z);
  }
}

/// One program over one batch. N: Lanes<T> for values, LaneDual<T> for values and gradients.
template <class N>
class BatchRun {
 public:
  using T = typename NumberOf<N>::type;

  BatchRun(const BatchProgram<T>& program, ChunkMemory& memory, const BatchArrays& batch)
      : program_(program), batch_(batch) {
    const bool bent = std::ranges::any_of(program.frames, [](const LocalFrame<T>& frame) { return !frame.linear; });
    frame_arrays_ = kGradient && bent ? 6 : 3;
    const std::size_t arrays = frame_arrays_ * program.frames.size() + Slot<N>::kArrays * program.slot_count;
    const std::size_t fitting = kCacheBytes / (sizeof(T) * arrays) / kPadding * kPadding;
    capacity_ = std::clamp(fitting, kPadding, kLargestChunk);
    capacity_ = std::min(capacity_, (batch.n + kPadding - 1) / kPadding * kPadding);
    stride_ = capacity_ + capacity_ / 4 / kPadding * kPadding;
    points_ = memory.at_least<T>(arrays * stride_);
    slots_ = points_ + frame_arrays_ * program.frames.size() * stride_;
  }

  void run() {
    for (std::size_t begin = 0; begin < batch_.n; begin += capacity_) {
      const std::size_t count = std::min(capacity_, batch_.n - begin);
      n_ = (count + lane_count<T>() - 1) / lane_count<T>() * lane_count<T>();
      take(begin, count);
      for (std::size_t k = 1; k < program_.frames.size(); ++k) enter_frame(k);
      for (const Step& step : program_.steps) run_step(step);
      give(begin, count);
    }
  }

 private:
  static constexpr bool kGradient = std::is_same_v<N, LaneDual<T>>;
  static constexpr std::size_t kPadding = 16;          // lanes of the widest vectors
  static constexpr std::size_t kLargestChunk = 768;    // a mesh block, 9^3, in one; with 256 a lone cone takes 15 % longer
  static constexpr std::size_t kCacheBytes = 16 * 1024;

  /// The points of a chunk; a last vector that they do not fill repeats the last one.
  void take(std::size_t begin, std::size_t count) const {
    const float* const from[3] = {batch_.x + begin, batch_.y + begin, batch_.z + begin};
    std::size_t i = 0;
    for (; i + lane_count<T>() <= count; i += lane_count<T>())
      for (std::size_t k = 0; k < 3; ++k) store(load_floats<T>(from[k] + i), axis(0, k) + i);
    for (; i < n_; ++i)
      for (std::size_t k = 0; k < 3; ++k) axis(0, k)[i] = static_cast<T>(from[k][std::min(i, count - 1)]);
  }
  void give(std::size_t begin, std::size_t count) const {
    float* const to[4] = {batch_.f + begin, batch_.gx + begin, batch_.gy + begin, batch_.gz + begin};
    constexpr int kArrays = static_cast<int>(Slot<N>::kArrays);
    std::size_t i = 0;
    for (; i + lane_count<T>() <= count; i += lane_count<T>())
      for (int k = 0; k < kArrays; ++k) store_floats(load(slots_ + k * stride_ + i), to[k] + i);
    for (; i < count; ++i)
      for (int k = 0; k < kArrays; ++k) to[k][i] = static_cast<float>(slots_[k * stride_ + i]);
  }

  T* axis(std::size_t frame, std::size_t k) const { return points_ + (frame_arrays_ * frame + k) * stride_; }
  Points<T> points(std::size_t frame) const { return {axis(frame, 0), axis(frame, 1), axis(frame, 2)}; }
  /// Three numbers of the Jacobian of the frame's warp (lane_warps-inl.h); only for gradients.
  Points<T> slopes_of(std::size_t frame) const { return {axis(frame, 3), axis(frame, 4), axis(frame, 5)}; }
  HWY_INLINE Slot<N> slot(std::size_t k) const { return {slots_ + k * Slot<N>::kArrays * stride_, stride_}; }

  void enter_frame(std::size_t k) {
    const LocalFrame<T>& frame = program_.frames[k];
    if (frame.linear) {
      const LaneVector<T> x = broadcast(frame.matrix[0]), y = broadcast(frame.matrix[1]), z = broadcast(frame.matrix[2]);
      const Points<T> outside = points(frame.outside), inside = points(k);
      const std::size_t n = n_;
      for (std::size_t i = 0; i < n; i += lane_count<T>()) {
        const LaneVector<T> p = outside.get(i);
        store(dot(x, p), inside.x + i);
        store(dot(y, p), inside.y + i);
        store(dot(z, p), inside.z + i);
      }
      return;
    }
    if (const auto* const bend = std::get_if<BendWarp>(&frame.warp)) unwarp_frame<BendLanes>(*bend, k);
    if (const auto* const twist = std::get_if<TwistWarp>(&frame.warp)) unwarp_frame<TwistLanes>(*twist, k);
    if (const auto* const taper = std::get_if<TaperWarp>(&frame.warp)) unwarp_frame<TaperLanes>(*taper, k);
  }

  template <class WarpLanes, class Warp>
  HWY_NOINLINE void unwarp_frame(const Warp& warp, std::size_t k) const {
    const LocalFrame<T>& frame = program_.frames[k];
    const WarpLanes lanes(warp, program_.frames[frame.outside].origin, frame.origin);
    const Points<T> outside = points(frame.outside), inside = points(k), slopes = slopes_of(k);
    const std::size_t n = n_;
    for (std::size_t i = 0; i < n; i += lane_count<double>()) {
      DoubleVector jacobian;
      const DoubleVector q = lanes.unwarp(load_doubles(outside.x + i, outside.y + i, outside.z + i), jacobian);
      store_doubles(q, inside.x + i, inside.y + i, inside.z + i);
      if constexpr (kGradient) store_doubles(jacobian, slopes.x + i, slopes.y + i, slopes.z + i);
    }
  }

  /// Gradients inside a warp, seen from outside.
  void leave_frame(const Step& step) {
    if constexpr (kGradient) {
      const LocalFrame<T>& frame = program_.frames[step.frame];
      const Slot<N> to = slot(step.slot);
      if (frame.linear) {
        const LaneVector<T> x = broadcast(frame.matrix[0]), y = broadcast(frame.matrix[1]), z = broadcast(frame.matrix[2]);
        const std::size_t n = n_;
        for (std::size_t i = 0; i < n; i += lane_count<T>()) {
          const N in = to.get(i);
          to.put(i, with_gradient<N>(in.f, in.x * x + in.y * y + in.z * z));
        }
        return;
      }
      if (const auto* const bend = std::get_if<BendWarp>(&frame.warp)) pull_back_frame<BendSlopes<T>>(*bend, step);
      if (const auto* const twist = std::get_if<TwistWarp>(&frame.warp)) pull_back_frame<TwistSlopes<T>>(*twist, step);
      if (const auto* const taper = std::get_if<TaperWarp>(&frame.warp)) pull_back_frame<TaperSlopes<T>>(*taper, step);
    }
  }

  template <class Slopes, class Warp>
  HWY_NOINLINE void pull_back_frame(const Warp& warp, const Step& step) const {
    const LocalFrame<T>& frame = program_.frames[step.frame];
    const Slopes lanes(warp, program_.frames[frame.outside].origin);
    const Points<T> outside = points(frame.outside), slopes = slopes_of(step.frame);
    const Slot<N> to = slot(step.slot);
    const std::size_t n = n_;
    for (std::size_t i = 0; i < n; i += lane_count<T>()) {
      const N in = to.get(i);
      to.put(i, with_gradient<N>(in.f, lanes.pull_back(outside.get(i), slopes.get(i), LaneVector<T>{in.x, in.y, in.z})));
    }
  }

  // Loops keep what they need in locals: a store to a slot could be one to a member, for all the compiler knows.

  /// slot = end(measure(begin(i))), or slot += that, for all lanes: three steps, each for another vector of points.
  template <class Begin, class Measure, class End>
  HWY_INLINE void set(const Step& step, const Begin& begin, const Measure& measure, const End& end) const {
    const Slot<N> to = slot(step.slot);
    constexpr std::size_t kLanes = lane_count<T>();
    const std::size_t n = n_, last = n_ - kLanes;
    auto measured = measure(begin(std::size_t{0}));
    auto begun = begin(std::min(kLanes, last));
    const auto next = [&](std::size_t i) HWY_ATTR {
      const auto to_end = measured;
      const auto to_measure = begun;
      begun = begin(std::min(i + 2 * kLanes, last));
      measured = measure(to_measure);
      return end(to_end);
    };
    if (step.adds)
      for (std::size_t i = 0; i < n; i += kLanes) to.put(i, to.get(i) + next(i));
    else
      for (std::size_t i = 0; i < n; i += kLanes) to.put(i, next(i));
  }

  template <class Shape, class Local>
  HWY_NOINLINE void primitive(const Step& step, const Local& local) const {
    const Shape shape(local);
    const Points<T> at = points(step.frame);
    const Lanes<T> per_square(local.falloff.per_square), strength(local.falloff.strength), slope(local.falloff.slope);
    const auto begin = [&](std::size_t i) HWY_ATTR { return shape.template begin<kGradient>(at.get(i)); };
    const auto measure = [&](const auto& begun) HWY_ATTR { return shape.template measure<kGradient>(begun); };
    set(step, begin, measure, [&](const auto& m) HWY_ATTR {
      const Lanes<T> x2 = Shape::kInSupportRadii ? m.square : m.square * per_square;
      const Lanes<T> s = larger(Lanes<T>(1) - x2, Lanes<T>(0)), s2 = s * s, f = s2 * (s * strength);
      if constexpr (kGradient) {
        return with_gradient<N>(f, (s2 * slope) * shape.direction(m));
      } else {
        return f;
      }
    });
  }

  HWY_NOINLINE void chain(const Step& step) const {
    const auto unwidened = [](const LaneVector<T>&) HWY_ATTR { return Unwidened{}; };
    sweep(step, unwidened);
  }

  HWY_NOINLINE void flare(const Step& step) const {
    const LocalFlare<T>& local = program_.flares[step.flare];
    const FlareLanes<T> lanes(local, program_.flare_gaps.data() + local.first_gap);
    sweep(step, [&](const LaneVector<T>& p) HWY_ATTR { return lanes.template at<kGradient>(p); });
  }

  struct Unwidened {};

  /// widening(p): what a flare's segments are widened by at points.
  template <class Widen>
  HWY_INLINE void sweep(const Step& step, const Widen& widening) const {
    constexpr bool kFlare = !std::is_same_v<decltype(widening(LaneVector<T>{})), Unwidened>;
    const LocalSwept<T>* const segments = program_.swept.data() + step.first;
    const std::uint32_t count = step.count;
    const Points<T> at = points(step.frame);
    constexpr T kPerSquare = static_cast<T>(kRadiusPerSupport * kRadiusPerSupport);
    const Lanes<T> per_square(kPerSquare), strength(step.width), slope = Lanes<T>(-6 * kPerSquare) * strength;
    const Lanes<T> six_strengths = Lanes<T>(6) * strength;
    const auto begin = [&](std::size_t i) HWY_ATTR { return at.get(i); };
    const auto same = [](const LaneVector<T>& p) HWY_ATTR { return p; };
    set(step, begin, same, [&](const LaneVector<T>& p) HWY_ATTR {
      SweptNearest<T> best = swept<T, kGradient>(segments[0], p);
      for (std::uint32_t k = 1; k < count; ++k) best = nearer<T, kGradient>(best, swept<T, kGradient>(segments[k], p));
      const auto m = widening(p);
      Lanes<T> x2 = best.square / best.radius_square * per_square;
      if constexpr (kFlare) x2 = x2 * m.per_square;
      const Lanes<T> s = larger(Lanes<T>(1) - x2, Lanes<T>(0)), s2 = s * s, f = s2 * (s * strength);
      if constexpr (kGradient && kFlare) {
        const LaneVector<T> by_chain = (s2 * slope / best.radius_square * m.per_square) * best.vector;
        return with_gradient<N>(f, by_chain + (s2 * x2 * six_strengths) * m.log_gradient);
      } else if constexpr (kGradient) {
        return with_gradient<N>(f, (s2 * slope / best.radius_square) * best.vector);
      } else {
        return f;
      }
    });
  }

  void half_space(const Step& step) const {
    const LocalHalfSpace<T>& k = program_.half_spaces[step.first];
    const LaneVector<T> on_plane = broadcast(k.point), normal = broadcast(k.normal);
    const Lanes<T> per_two_widths(k.inverse_two_widths);
    const LaneVector<T> slope = (Lanes<T>(0) - per_two_widths) * normal;
    const Points<T> at = points(step.frame);
    const auto begin = [&](std::size_t i) HWY_ATTR { return at.get(i); };
    const auto same = [](const LaneVector<T>& p) HWY_ATTR { return p; };
    set(step, begin, same, [&](const LaneVector<T>& p) HWY_ATTR {
      const Lanes<T> t = Lanes<T>(0.5) - dot(p - on_plane, normal) * per_two_widths;
      const N ramp = select(t < Lanes<T>(1), with_gradient<N>(t, slope), N(1));
      return select(t > Lanes<T>(0), ramp, N(0));
    });
  }

  /// slot = rule(its children), for all lanes.
  template <class Rule>
  HWY_INLINE void combine(const Step& step, const Rule& rule) const {
    const Slot<N> to = slot(step.slot);
    const std::size_t n = n_;
    for (std::size_t i = 0; i < n; i += lane_count<T>()) to.put(i, rule(Operands<N>{to, i}));
  }

  void run_step(const Step& step) {
    const std::size_t n = step.count, has_first = step.has_first;
    const bool with_zero = step.with_zero;
    const double width = step.width;
    switch (step.kind) {
      case StepKind::kPoint: primitive<PointLanes<T>>(step, program_.points[step.first]); break;
      case StepKind::kSegment: primitive<SegmentLanes<T>>(step, program_.segments[step.first]); break;
      case StepKind::kCone: primitive<ConeLanes<T>>(step, program_.cones[step.first]); break;
      case StepKind::kDisc: primitive<RingLanes<T, true>>(step, program_.rings[step.first]); break;
      case StepKind::kCircle: primitive<RingLanes<T, false>>(step, program_.rings[step.first]); break;
      case StepKind::kBox: primitive<BoxLanes<T>>(step, program_.boxes[step.first]); break;
      case StepKind::kHalfSpace: half_space(step); break;
      case StepKind::kChain: chain(step); break;
      case StepKind::kFlare: flare(step); break;
      case StepKind::kAdd: combine(step, [](const Operands<N>& f) HWY_ATTR { return f[0] + f[1]; }); break;
      case StepKind::kUnion: combine(step, [=](const Operands<N>& f) HWY_ATTR { return max_of(f, n, with_zero); }); break;
      case StepKind::kIntersection:
        combine(step, [=](const Operands<N>& f) HWY_ATTR { return min_of(f, n, with_zero); });
        break;
      case StepKind::kDifference:
        combine(step, [=](const Operands<N>& f) HWY_ATTR {
          return difference_of(has_first ? f[0] : N(0), f + has_first, n - has_first, with_zero);
        });
        break;
      case StepKind::kRicci: combine(step, [=](const Operands<N>& f) HWY_ATTR { return ricci_of(f, n, width); }); break;
      case StepKind::kContact: {
        const ContactShape<N> shape(width, step.lip);
        combine(step, [=](const Operands<N>& f) CAMBIUM_INLINED { return contact_of(f, n, with_zero, shape); });
        break;
      }
      case StepKind::kFork: {
        const LocalLateral<T>* const laterals = program_.laterals.data() + step.first;
        const Points<T> at = points(step.frame);
        const ContactShape<N> shape(width, step.lip);
        combine(step, [=](const Operands<N>& f) CAMBIUM_INLINED {
          const Weights<N> weights{laterals, at.get(f.i)};
          return fork_of(has_first ? f[0] : N(0), f + has_first, weights, n - has_first, with_zero, shape);
        });
        break;
      }
      case StepKind::kScale: combine(step, [=](const Operands<N>& f) HWY_ATTR { return f[0] * Lanes<T>(width); }); break;
      case StepKind::kWarp: leave_frame(step); break;
    }
  }

  const BatchProgram<T>& program_;
  const BatchArrays& batch_;
  T* points_ = nullptr;
  T* slots_ = nullptr;
  std::size_t frame_arrays_ = 3, capacity_ = 0, stride_ = 0, n_ = 0;
};

void float_values(const BatchProgram<float>& program, ChunkMemory& memory, const BatchArrays& batch) {
  BatchRun<Lanes<float>>(program, memory, batch).run();
}
void float_samples(const BatchProgram<float>& program, ChunkMemory& memory, const BatchArrays& batch) {
  BatchRun<LaneDual<float>>(program, memory, batch).run();
}
void double_values(const BatchProgram<double>& program, ChunkMemory& memory, const BatchArrays& batch) {
  BatchRun<Lanes<double>>(program, memory, batch).run();
}
void double_samples(const BatchProgram<double>& program, ChunkMemory& memory, const BatchArrays& batch) {
  BatchRun<LaneDual<double>>(program, memory, batch).run();
}

std::int64_t this_target() { return HWY_TARGET; }

// NOLINTNEXTLINE(google-readability-namespace-comments)
}  // namespace HWY_NAMESPACE
}  // namespace cambium
HWY_AFTER_NAMESPACE();

#if HWY_ONCE
namespace cambium {

HWY_EXPORT(float_values);
HWY_EXPORT(float_samples);
HWY_EXPORT(double_values);
HWY_EXPORT(double_samples);
HWY_EXPORT(this_target);

template <>
void run_values(const BatchProgram<float>& program, ChunkMemory& memory, const BatchArrays& batch) {
  HWY_DYNAMIC_DISPATCH(float_values)(program, memory, batch);
}
template <>
void run_samples(const BatchProgram<float>& program, ChunkMemory& memory, const BatchArrays& batch) {
  HWY_DYNAMIC_DISPATCH(float_samples)(program, memory, batch);
}
template <>
void run_values(const BatchProgram<double>& program, ChunkMemory& memory, const BatchArrays& batch) {
  HWY_DYNAMIC_DISPATCH(double_values)(program, memory, batch);
}
template <>
void run_samples(const BatchProgram<double>& program, ChunkMemory& memory, const BatchArrays& batch) {
  HWY_DYNAMIC_DISPATCH(double_samples)(program, memory, batch);
}

std::int64_t compiled_vector_targets() { return HWY_TARGETS; }
std::int64_t running_vector_target() { return HWY_DYNAMIC_DISPATCH(this_target)(); }

}  // namespace cambium
#endif  // HWY_ONCE
