// The warps that are not rigid (warps.h) in vector lanes of double: W^-1 of points, and gradients back. Included by
// batch_kernels.cpp once for each set of vector instructions. Private to blobtree/.
//
// Each is made from the warp and the origins that points outside and inside of it are relative to.
#if defined(CAMBIUM_BLOBTREE_LANE_WARPS_INL_H) == defined(HWY_TARGET_TOGGLE)
#ifdef CAMBIUM_BLOBTREE_LANE_WARPS_INL_H
#undef CAMBIUM_BLOBTREE_LANE_WARPS_INL_H
#else
#define CAMBIUM_BLOBTREE_LANE_WARPS_INL_H
#endif

#include "blobtree/lane_angles-inl.h"
#include "blobtree/warps.h"

#include <cmath>

HWY_BEFORE_NAMESPACE();
namespace cambium {
namespace HWY_NAMESPACE {

using DoubleVector = LaneVector<double>;

HWY_INLINE DoubleVector broadcast(const Vec3& v) { return {Lanes<double>(v.x), Lanes<double>(v.y), Lanes<double>(v.z)}; }
HWY_INLINE DoubleVector cross(const DoubleVector& a, const DoubleVector& b) {
  return {a.y * b.z - a.z * b.y, a.z * b.x - a.x * b.z, a.x * b.y - a.y * b.x};
}

class BendLanes {
 public:
  using V = Lanes<double>;
  HWY_INLINE BendLanes(const BendWarp& w, const Vec3& outside, const Vec3& inside)
      : from_center_(broadcast(outside - w.center)), start_(broadcast(w.a - inside)), u_(broadcast(w.u)), d_(broadcast(w.d)),
        n_(broadcast(w.n)), rho_(w.rho), half_(w.angle / 2), arc_(w.arc), sine_(std::sin(w.angle / 2)),
        cosine_(std::cos(w.angle / 2)) {}

  HWY_INLINE DoubleVector unwarp(const DoubleVector& p) const {
    const DoubleVector q = p + from_center_;
    const V x = dot(q, u_), y = dot(q, d_), end_sine = towards(x);
    const Condition<double> bent = in_arc(x, y);
    const V along = select(bent, rho_ * (angle_from_y(x, y) + half_), or_zero(x > V(0), arc_) + (x * cosine_ - y * end_sine));
    const V out = select(bent, root(x * x + y * y), x * end_sine + y * cosine_) - rho_;
    return start_ + (along * u_ + out * d_ + dot(q, n_) * n_);
  }

  HWY_INLINE DoubleVector pull_back(const DoubleVector& p, const DoubleVector& g) const {
    const DoubleVector q = p + from_center_;
    const V x = dot(q, u_), y = dot(q, d_);
    const Condition<double> bent = in_arc(x, y);
    const V per_r = V(1) / larger(root(x * x + y * y), V(std::numeric_limits<double>::min()));
    const V sine = select(bent, x * per_r, towards(x)), cosine = select(bent, y * per_r, cosine_);
    const V along = dot(g, u_) * select(bent, rho_ * per_r, V(1)), out = dot(g, d_);
    return (along * cosine + out * sine) * u_ + (out * cosine - along * sine) * d_ + dot(g, n_) * n_;
  }

 private:
  /// Whether the angle from the y axis is at most half the bend's: the sine of the rest, half - |angle|, is not negative.
  HWY_INLINE Condition<double> in_arc(V x, V y) const { return sine_ * y >= cosine_ * V(hn::Abs(x.v)); }
  /// Sine of the end's angle that is on this side.
  HWY_INLINE V towards(V x) const { return select(x > V(0), sine_, V(0) - sine_); }

  DoubleVector from_center_, start_, u_, d_, n_;
  V rho_, half_, arc_, sine_, cosine_;
};

class TwistLanes {
 public:
  using V = Lanes<double>;
  HWY_INLINE TwistLanes(const TwistWarp& w, const Vec3& outside, const Vec3& inside)
      : from_point_(broadcast(outside - w.point)), point_(broadcast(w.point - inside)), axis_(broadcast(w.axis)),
        rate_(w.rate) {}

  HWY_INLINE DoubleVector unwarp(const DoubleVector& p) const {
    const DoubleVector q = p + from_point_;
    const V height = dot(q, axis_);
    const SineAndCosine turn = sine_and_cosine(rate_ * height);
    const DoubleVector on_axis = height * axis_, across = q - on_axis;
    return point_ + on_axis + (turn.cosine * across - turn.sine * cross(axis_, across));
  }

  HWY_INLINE DoubleVector pull_back(const DoubleVector& p, const DoubleVector& g) const {
    const DoubleVector q = p + from_point_;
    const SineAndCosine turn = sine_and_cosine(rate_ * dot(q, axis_));
    const V along = dot(g, axis_);
    const DoubleVector turned = turn.cosine * (g - along * axis_) + turn.sine * cross(axis_, g);
    return turned + (along - rate_ * dot(turned, cross(axis_, q))) * axis_;
  }

 private:
  DoubleVector from_point_, point_, axis_;
  V rate_;
};

class TaperLanes {
 public:
  using V = Lanes<double>;
  HWY_INLINE TaperLanes(const TaperWarp& w, const Vec3& outside, const Vec3& inside)
      : from_point_(broadcast(outside - w.point)), point_(broadcast(w.point - inside)), axis_(broadcast(w.axis)),
        from_height_(w.from_height), to_height_(w.to_height), from_scale_(w.from_scale), to_scale_(w.to_scale),
        slope_((w.to_scale - w.from_scale) / (w.to_height - w.from_height)) {}

  HWY_INLINE DoubleVector unwarp(const DoubleVector& p) const {
    const DoubleVector q = p + from_point_;
    const V height = dot(q, axis_);
    const DoubleVector on_axis = height * axis_;
    return point_ + on_axis + (V(1) / scale_at(height)) * (q - on_axis);
  }

  HWY_INLINE DoubleVector pull_back(const DoubleVector& p, const DoubleVector& g) const {
    const DoubleVector q = p + from_point_;
    const V height = dot(q, axis_), per_scale = V(1) / scale_at(height), along = dot(g, axis_);
    const V slope = or_zero((height > from_height_) & (height < to_height_), slope_);
    const DoubleVector shrunk = per_scale * (g - along * axis_);
    return shrunk + (along - dot(shrunk, q) * slope * per_scale) * axis_;   // shrunk is orthogonal to the axis
  }

 private:
  HWY_INLINE V scale_at(V height) const {
    const V between = from_scale_ + slope_ * (height - from_height_);
    return select(height <= from_height_, from_scale_, select(height >= to_height_, to_scale_, between));
  }

  DoubleVector from_point_, point_, axis_;
  V from_height_, to_height_, from_scale_, to_scale_, slope_;
};

// NOLINTNEXTLINE(google-readability-namespace-comments)
}  // namespace HWY_NAMESPACE
}  // namespace cambium
HWY_AFTER_NAMESPACE();

#endif
