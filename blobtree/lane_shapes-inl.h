// Distances to skeletons in vector lanes (field.md section 3): the square of the distance, which is all that the falloff asks for,
// and the vector from the nearest skeleton point, along which the gradient lies. Included by batch_kernels.cpp once for each
// set of vector instructions. Private to blobtree/.
#if defined(CAMBIUM_BLOBTREE_LANE_SHAPES_INL_H) == defined(HWY_TARGET_TOGGLE)
#ifdef CAMBIUM_BLOBTREE_LANE_SHAPES_INL_H
#undef CAMBIUM_BLOBTREE_LANE_SHAPES_INL_H
#else
#define CAMBIUM_BLOBTREE_LANE_SHAPES_INL_H
#endif

#include "blobtree/lanes-inl.h"

HWY_BEFORE_NAMESPACE();
namespace cambium {
namespace HWY_NAMESPACE {

template <class T>
struct Offset {
  Lanes<T> square;
  LaneVector<T> vector;   ///< only if it was asked for
};

template <class T>
class PointLanes {
 public:
  HWY_INLINE explicit PointLanes(const LocalPoint<T>& k) : center_(broadcast(k.center)) {}
  template <bool kGradient>
  HWY_INLINE Offset<T> offset(const LaneVector<T>& p) const {
    const LaneVector<T> v = p - center_;
    return {dot(v, v), v};
  }

 private:
  LaneVector<T> center_;
};

template <class T>
class SegmentLanes {
 public:
  HWY_INLINE explicit SegmentLanes(const LocalSegment<T>& k)
      : a_(broadcast(k.a)), axis_(broadcast(k.axis)), begin_(k.begin), end_(k.end) {}
  template <bool kGradient>
  HWY_INLINE Offset<T> offset(const LaneVector<T>& p) const {
    const LaneVector<T> q = p - a_;
    const LaneVector<T> v = q - smaller(larger(dot(q, axis_), begin_), end_) * axis_;
    return {dot(v, v), v};
  }

 private:
  LaneVector<T> a_, axis_;
  Lanes<T> begin_, end_;
};

/// Of a point at distance rho from an axis: the vector e_rho outwards and e_h along the axis. On the axis outwards is nowhere.
template <class T>
HWY_INLINE LaneVector<T> back_in_space(const LaneVector<T>& axis, const LaneVector<T>& radial, Lanes<T> rho, Lanes<T> e_rho, Lanes<T> e_h) {
  return or_zero(rho > Lanes<T>(1e-18), e_rho / rho) * radial + e_h * axis;
}

template <class T>
class ConeLanes {
 public:
  HWY_INLINE explicit ConeLanes(const LocalCone<T>& k)
      : a_(broadcast(k.a)), axis_(broadcast(k.axis)), core_(k.core), tangent_rho_(k.tangent_rho), tangent_h_(k.tangent_h),
        side_begin_(k.side_begin), side_end_(k.side_end), base_h_(k.base_h), disc_radius_(k.disc_radius) {}
  template <bool kGradient>
  HWY_INLINE Offset<T> offset(const LaneVector<T>& p) const {
    const LaneVector<T> q = p - a_;
    const Lanes<T> h = dot(q, axis_);
    const LaneVector<T> radial = q - h * axis_;
    const Lanes<T> rho = root(dot(radial, radial));
    // Above the base: in the frame of the slanted side. Inside both components are 0.
    const Lanes<T> from_core = rho - core_;
    const Lanes<T> along = h * tangent_h_ + from_core * tangent_rho_;
    const Lanes<T> beyond = along - smaller(larger(along, side_begin_), side_end_);
    const Lanes<T> out = larger(from_core * tangent_h_ - h * tangent_rho_, Lanes<T>(0));
    // Below it: beside the disc and under it.
    const Lanes<T> beside = larger(rho - disc_radius_, Lanes<T>(0)), under = h - base_h_;
    const Condition<T> below = h < base_h_;
    const Lanes<T> e1 = select(below, beside, beyond), e2 = select(below, under, out);
    Offset<T> result;
    result.square = e1 * e1 + e2 * e2;
    if constexpr (kGradient) {
      const Lanes<T> e_rho = select(below, beside, beyond * tangent_rho_ + out * tangent_h_);
      const Lanes<T> e_h = select(below, under, beyond * tangent_h_ - out * tangent_rho_);
      result.vector = back_in_space(axis_, radial, rho, e_rho, e_h);
    }
    return result;
  }

 private:
  LaneVector<T> a_, axis_;
  Lanes<T> core_, tangent_rho_, tangent_h_, side_begin_, side_end_, base_h_, disc_radius_;
};

template <class T, bool kIsDisc>
class RingLanes {
 public:
  HWY_INLINE explicit RingLanes(const LocalRing<T>& k) : center_(broadcast(k.center)), normal_(broadcast(k.normal)), radius_(k.radius) {}
  template <bool kGradient>
  HWY_INLINE Offset<T> offset(const LaneVector<T>& p) const {
    const LaneVector<T> q = p - center_;
    const Lanes<T> h = dot(q, normal_);
    const LaneVector<T> radial = q - h * normal_;
    const Lanes<T> rho = root(dot(radial, radial));
    Lanes<T> e = rho - radius_;
    if constexpr (kIsDisc) e = larger(e, Lanes<T>(0));
    Offset<T> result;
    result.square = e * e + h * h;
    if constexpr (kGradient) result.vector = back_in_space(normal_, radial, rho, e, h);
    return result;
  }

 private:
  LaneVector<T> center_, normal_;
  Lanes<T> radius_;
};

template <class T>
class BoxLanes {
 public:
  HWY_INLINE explicit BoxLanes(const LocalBox<T>& k)
      : center_(broadcast(k.center)), x_(broadcast(k.axes[0])), y_(broadcast(k.axes[1])), z_(broadcast(k.axes[2])),
        half_(broadcast(k.half_size)) {}
  template <bool kGradient>
  HWY_INLINE Offset<T> offset(const LaneVector<T>& p) const {
    const LaneVector<T> q = p - center_;
    const Lanes<T> x = beyond(dot(q, x_), half_.x), y = beyond(dot(q, y_), half_.y), z = beyond(dot(q, z_), half_.z);
    Offset<T> result;
    result.square = x * x + y * y + z * z;
    if constexpr (kGradient) result.vector = x * x_ + y * y_ + z * z_;
    return result;
  }

 private:
  static HWY_INLINE Lanes<T> beyond(Lanes<T> s, Lanes<T> half) { return s - smaller(larger(s, Lanes<T>(0) - half), half); }
  LaneVector<T> center_, x_, y_, z_, half_;
};

/// The nearest of a chain's segments so far, as a fraction square / radius_square: one comparison of products each, no division.
template <class T>
struct SweptNearest {
  Lanes<T> square, radius_square;
  LaneVector<T> vector;   ///< only if it was asked for
};

template <class T, bool kGradient>
HWY_INLINE SweptNearest<T> swept(const LocalSwept<T>& k, const LaneVector<T>& p) {
  const LaneVector<T> axis = broadcast(k.axis), q = p - broadcast(k.a);
  const Lanes<T> begin(k.begin), end(k.end), radius(k.radius), h = dot(q, axis);
  SweptNearest<T> result;
  Lanes<T> s = h, r = radius;
  if (k.slope != T(0)) {
    const Lanes<T> slope(k.slope), denominator = radius + h * slope, thicker(k.slope > T(0) ? k.end : k.begin);
    s = select(denominator > Lanes<T>(0), (h * radius + dot(q, q) * slope) / denominator, thicker);
    s = smaller(larger(s, begin), end);
    r = radius + s * slope;
  } else {
    s = smaller(larger(s, begin), end);
  }
  const LaneVector<T> v = q - s * axis;
  result.square = dot(v, v);
  result.radius_square = r * r;
  if constexpr (kGradient) result.vector = v;
  return result;
}

template <class T, bool kGradient>
HWY_INLINE SweptNearest<T> nearer(const SweptNearest<T>& a, const SweptNearest<T>& b) {
  const Condition<T> c = b.square * a.radius_square < a.square * b.radius_square;
  SweptNearest<T> result;
  result.square = select(c, b.square, a.square);
  result.radius_square = select(c, b.radius_square, a.radius_square);
  if constexpr (kGradient) result.vector = select(c, b.vector, a.vector);
  return result;
}

// NOLINTNEXTLINE(google-readability-namespace-comments)
}  // namespace HWY_NAMESPACE
}  // namespace cambium
HWY_AFTER_NAMESPACE();

#endif
