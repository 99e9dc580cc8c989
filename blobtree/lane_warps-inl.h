// The warps that are not rigid (warps.h) in vector lanes: W^-1 of points, in double, and gradients back. Included by
// batch_kernels.cpp once for each set of vector instructions. Private to blobtree/.
//
// unwarp() is made from a warp and the origins that points outside and inside of it are relative to. It also gives three
// numbers of the Jacobian at the point, which pull_back() of the warp's slopes wants again: nothing that takes long is done
// twice, and gradients keep their own precision.
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

template <class T = double> HWY_INLINE LaneVector<T> broadcast(const Vec3& v) {
  return {Lanes<T>(v.x), Lanes<T>(v.y), Lanes<T>(v.z)};
}
template <class T> HWY_INLINE LaneVector<T> cross(const LaneVector<T>& a, const LaneVector<T>& b) {
  return {a.y * b.z - a.z * b.y, a.z * b.x - a.x * b.z, a.x * b.y - a.y * b.x};
}

/// The part of v across an axis.
inline Vec3 across_of(const Vec3& v, const Vec3& axis) { return v - glm::dot(v, axis) * axis; }

class BendLanes {
 public:
  using V = Lanes<double>;
  HWY_INLINE BendLanes(const BendWarp& w, const Vec3& outside, const Vec3& inside)
      : from_center_(broadcast(outside - w.center)), start_(broadcast(w.a - inside)), u_(broadcast(w.u)), d_(broadcast(w.d)),
        n_(broadcast(w.n)), rho_(w.rho), half_(w.angle / 2), arc_(w.arc), sine_(std::sin(w.angle / 2)),
        cosine_(std::cos(w.angle / 2)) {}

  HWY_INLINE DoubleVector unwarp(const DoubleVector& p, DoubleVector& slopes) const {
    const DoubleVector q = p + from_center_;
    const V x = dot(q, u_), y = dot(q, d_), r = root(x * x + y * y);
    const V end_sine = select(x > V(0), sine_, V(0) - sine_);
    // Whether the angle from the y axis is at most half the bend's: the sine of the rest, half - |angle|, is not negative.
    const Condition<double> bent = sine_ * y >= cosine_ * V(hn::Abs(x.v));
    const V on_arc = rho_ * (angle_from_y(x, y) + half_), beyond = or_zero(x > V(0), arc_) + (x * cosine_ - y * end_sine);
    const V along = select(bent, on_arc, beyond);
    const V out = select(bent, r, x * end_sine + y * cosine_) - rho_;
    const V per_r = V(1) / larger(r, V(std::numeric_limits<double>::min()));
    slopes = {select(bent, x * per_r, end_sine), select(bent, y * per_r, cosine_), select(bent, rho_ * per_r, V(1))};
    return start_ + (along * u_ + out * d_ + dot(q, n_) * n_);
  }

 private:
  DoubleVector from_center_, start_, u_, d_, n_;
  V rho_, half_, arc_, sine_, cosine_;
};

/// Slopes of a bend: sine and cosine of the angle on the arc, and how much longer the child is there.
template <class T>
class BendSlopes {
 public:
  HWY_INLINE BendSlopes(const BendWarp& w, const Vec3&)
      : u_(broadcast<T>(w.u)), d_(broadcast<T>(w.d)), n_(broadcast<T>(w.n)) {}

  HWY_INLINE LaneVector<T> pull_back(const LaneVector<T>&, const LaneVector<T>& slopes, const LaneVector<T>& g) const {
    const Lanes<T> sine = slopes.x, cosine = slopes.y, along = dot(g, u_) * slopes.z, out = dot(g, d_);
    return (along * cosine + out * sine) * u_ + (out * cosine - along * sine) * d_ + dot(g, n_) * n_;
  }

 private:
  LaneVector<T> u_, d_, n_;
};

class TwistLanes {
 public:
  using V = Lanes<double>;
  HWY_INLINE TwistLanes(const TwistWarp& w, const Vec3& outside, const Vec3& inside)
      : from_point_(broadcast(outside - w.point)), point_(broadcast(w.point - inside)), axis_(broadcast(w.axis)),
        rate_(w.rate) {}

  HWY_INLINE DoubleVector unwarp(const DoubleVector& p, DoubleVector& slopes) const {
    const DoubleVector q = p + from_point_;
    const V height = dot(q, axis_);
    const SineAndCosine turn = sine_and_cosine(rate_ * height);
    const DoubleVector on_axis = height * axis_, across = q - on_axis;
    slopes = {turn.sine, turn.cosine, V(0)};
    return point_ + on_axis + (turn.cosine * across - turn.sine * cross(axis_, across));
  }

 private:
  DoubleVector from_point_, point_, axis_;
  V rate_;
};

/// Slopes of a twist: sine and cosine of its angle.
template <class T>
class TwistSlopes {
 public:
  HWY_INLINE TwistSlopes(const TwistWarp& w, const Vec3& outside)
      : from_axis_(broadcast<T>(across_of(outside - w.point, w.axis))), axis_(broadcast<T>(w.axis)),
        rate_(w.rate) {}

  HWY_INLINE LaneVector<T> pull_back(const LaneVector<T>& p, const LaneVector<T>& slopes, const LaneVector<T>& g) const {
    const Lanes<T> sine = slopes.x, cosine = slopes.y, along = dot(g, axis_);
    const LaneVector<T> turned = cosine * (g - along * axis_) + sine * cross(axis_, g);
    return turned + (along - rate_ * dot(turned, cross(axis_, p + from_axis_))) * axis_;
  }

 private:
  LaneVector<T> from_axis_, axis_;
  Lanes<T> rate_;
};

class TaperLanes {
 public:
  using V = Lanes<double>;
  HWY_INLINE TaperLanes(const TaperWarp& w, const Vec3& outside, const Vec3& inside)
      : from_point_(broadcast(outside - w.point)), point_(broadcast(w.point - inside)), axis_(broadcast(w.axis)),
        from_height_(w.from_height), to_height_(w.to_height), from_scale_(w.from_scale), to_scale_(w.to_scale),
        slope_((w.to_scale - w.from_scale) / (w.to_height - w.from_height)) {}

  HWY_INLINE DoubleVector unwarp(const DoubleVector& p, DoubleVector& slopes) const {
    const DoubleVector q = p + from_point_;
    const V height = dot(q, axis_);
    const DoubleVector on_axis = height * axis_;
    const Condition<double> above = height > from_height_, below = height < to_height_;
    const V between = from_scale_ + slope_ * (height - from_height_);
    const V per_scale = V(1) / select(above, select(below, between, to_scale_), from_scale_);
    slopes = {per_scale, or_zero(above & below, slope_) * per_scale, V(0)};
    return point_ + on_axis + per_scale * (q - on_axis);
  }

 private:
  DoubleVector from_point_, point_, axis_;
  V from_height_, to_height_, from_scale_, to_scale_, slope_;
};

/// Slopes of a taper: 1 / scale, and how fast the scale grows, over the scale.
template <class T>
class TaperSlopes {
 public:
  HWY_INLINE TaperSlopes(const TaperWarp& w, const Vec3& outside)
      : from_axis_(broadcast<T>(across_of(outside - w.point, w.axis))), axis_(broadcast<T>(w.axis)) {}

  HWY_INLINE LaneVector<T> pull_back(const LaneVector<T>& p, const LaneVector<T>& slopes, const LaneVector<T>& g) const {
    const Lanes<T> along = dot(g, axis_);
    const LaneVector<T> shrunk = slopes.x * (g - along * axis_);   // orthogonal to the axis
    return shrunk + (along - dot(shrunk, p + from_axis_) * slopes.y) * axis_;
  }

 private:
  LaneVector<T> from_axis_, axis_;
};

// NOLINTNEXTLINE(google-readability-namespace-comments)
}  // namespace HWY_NAMESPACE
}  // namespace cambium
HWY_AFTER_NAMESPACE();

#endif
