// Distances to skeletons in vector lanes (field.md section 3): the square of the distance, which is all that the falloff
// asks for, and the vector from the nearest skeleton point, along which the gradient lies. Included by batch_kernels.cpp
// once for each set of vector instructions. Private to blobtree/.
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

// What a shape has to say of a point, in three steps: begin() is all up to roots and divisions, measure() gives the square
// of the distance, direction() the vector from the nearest skeleton point (up to the factor that LocalFalloff::slope has).
// A loop takes each step for another vector of points, because a machine looks only so far ahead for something to do while
// a root takes its time: a cone takes six sevenths of the time that way, with gradient two thirds.

/// Of a shape whose direction is there when the square is.
template <class T>
struct Offset {
  Lanes<T> square;
  LaneVector<T> vector;
};

template <class T>
class PointLanes {
 public:
  static constexpr bool kInSupportRadii = false;
  HWY_INLINE explicit PointLanes(const LocalPoint<T>& k) : center_(broadcast(k.center)) {}
  template <bool kGradient>
  HWY_INLINE LaneVector<T> begin(const LaneVector<T>& p) const {
    return p - center_;
  }
  template <bool kGradient>
  HWY_INLINE Offset<T> measure(const LaneVector<T>& v) const {
    return {dot(v, v), v};
  }
  HWY_INLINE LaneVector<T> direction(const Offset<T>& o) const { return o.vector; }

 private:
  LaneVector<T> center_;
};

template <class T>
class SegmentLanes {
 public:
  static constexpr bool kInSupportRadii = false;
  HWY_INLINE explicit SegmentLanes(const LocalSegment<T>& k)
      : a_(broadcast(k.a)), axis_(broadcast(k.axis)), begin_(k.begin), end_(k.end) {}
  template <bool kGradient>
  HWY_INLINE LaneVector<T> begin(const LaneVector<T>& p) const {
    return p - a_;
  }
  template <bool kGradient>
  HWY_INLINE Offset<T> measure(const LaneVector<T>& q) const {
    const LaneVector<T> v = q - smaller(larger(dot(q, axis_), begin_), end_) * axis_;
    return {dot(v, v), v};
  }
  HWY_INLINE LaneVector<T> direction(const Offset<T>& o) const { return o.vector; }

 private:
  LaneVector<T> a_, axis_;
  Lanes<T> begin_, end_;
};

/// 1 / rho, finite on the axis, where outwards is nowhere.
template <class T>
HWY_INLINE Lanes<T> per_distance(Lanes<T> rho) {
  return Lanes<T>(1) / larger(rho, Lanes<T>(1e-18));
}

template <class T>
class ConeLanes {
 public:
  struct Begun {
    Lanes<T> u, v, h, rho, per_rho;   // the last only for gradients
  };
  struct Measured {
    Lanes<T> square, u, v, per_rho, e_rho, e_h;   // all but the first only for gradients
  };
  static constexpr bool kInSupportRadii = true;
  HWY_INLINE explicit ConeLanes(const LocalCone<T>& k)
      : u_(k.u), v_(k.v), h_(k.h), core_(k.core), tangent_rho_(k.tangent_rho), tangent_h_(k.tangent_h),
        side_begin_(k.side_begin), side_end_(k.side_end), base_h_(k.base_h), disc_radius_(k.disc_radius) {}
  template <bool kGradient>
  HWY_INLINE Begun begin(const LaneVector<T>& p) const {
    Begun b;
    b.u = u_.at(p), b.v = v_.at(p), b.h = h_.at(p);
    b.rho = root(b.u * b.u + b.v * b.v);
    if constexpr (kGradient) b.per_rho = per_distance(b.rho);
    return b;
  }
  template <bool kGradient>
  HWY_INLINE Measured measure(const Begun& b) const {
    // Above the base: in the frame of the slanted side. Inside both components are 0.
    const Lanes<T> from_core = b.rho - core_;
    const Lanes<T> along = b.h * tangent_h_ + from_core * tangent_rho_, out = from_core * tangent_h_ - b.h * tangent_rho_;
    const Lanes<T> beyond = along - smaller(larger(along, side_begin_), side_end_);
    // Below it: beside the disc and under it.
    const Lanes<T> beside = b.rho - disc_radius_, under = b.h - base_h_;
    const Condition<T> below = b.h < base_h_;
    const Lanes<T> e1 = larger(select(below, beside, out), Lanes<T>(0)), e2 = select(below, under, beyond);
    Measured m;
    m.square = e1 * e1 + e2 * e2;
    if constexpr (kGradient) {
      m.u = b.u, m.v = b.v, m.per_rho = b.per_rho;
      m.e_rho = select(below, e1, e2 * tangent_rho_ + e1 * tangent_h_);
      m.e_h = select(below, e2, e2 * tangent_h_ - e1 * tangent_rho_);
    }
    return m;
  }
  HWY_INLINE LaneVector<T> direction(const Measured& m) const {
    const LaneVector<T> outwards = (m.u * m.per_rho) * u_.direction + (m.v * m.per_rho) * v_.direction;
    return m.e_rho * outwards + m.e_h * h_.direction;
  }

 private:
  struct Coordinate {
    HWY_INLINE explicit Coordinate(const T (&row)[4])
        : direction{Lanes<T>(row[0]), Lanes<T>(row[1]), Lanes<T>(row[2])}, offset(row[3]) {}
    HWY_INLINE Lanes<T> at(const LaneVector<T>& p) const {
      return (p.x * direction.x + offset) + (p.y * direction.y + p.z * direction.z);
    }
    LaneVector<T> direction;   ///< of length 1 / support radius
    Lanes<T> offset;
  };
  Coordinate u_, v_, h_;
  Lanes<T> core_, tangent_rho_, tangent_h_, side_begin_, side_end_, base_h_, disc_radius_;
};

template <class T, bool kIsDisc>
class RingLanes {
 public:
  struct Begun {
    LaneVector<T> radial;
    Lanes<T> h, rho, per_rho;   // the last only for gradients
  };
  struct Measured {
    Lanes<T> square;
    LaneVector<T> radial;       // this and the following only for gradients
    Lanes<T> outwards, h;
  };
  static constexpr bool kInSupportRadii = false;
  HWY_INLINE explicit RingLanes(const LocalRing<T>& k)
      : center_(broadcast(k.center)), normal_(broadcast(k.normal)), radius_(k.radius) {}
  template <bool kGradient>
  HWY_INLINE Begun begin(const LaneVector<T>& p) const {
    const LaneVector<T> q = p - center_;
    Begun b;
    b.h = dot(q, normal_);
    b.radial = q - b.h * normal_;
    b.rho = root(dot(b.radial, b.radial));
    if constexpr (kGradient) b.per_rho = per_distance(b.rho);
    return b;
  }
  template <bool kGradient>
  HWY_INLINE Measured measure(const Begun& b) const {
    Lanes<T> e = b.rho - radius_;
    if constexpr (kIsDisc) e = larger(e, Lanes<T>(0));
    Measured m;
    m.square = e * e + b.h * b.h;
    if constexpr (kGradient) m.radial = b.radial, m.outwards = e * b.per_rho, m.h = b.h;
    return m;
  }
  HWY_INLINE LaneVector<T> direction(const Measured& m) const { return m.outwards * m.radial + m.h * normal_; }

 private:
  LaneVector<T> center_, normal_;
  Lanes<T> radius_;
};

template <class T>
class BoxLanes {
 public:
  struct Measured {
    Lanes<T> square, x, y, z;
  };
  static constexpr bool kInSupportRadii = false;
  HWY_INLINE explicit BoxLanes(const LocalBox<T>& k)
      : center_(broadcast(k.center)), x_(broadcast(k.axes[0])), y_(broadcast(k.axes[1])), z_(broadcast(k.axes[2])),
        half_(broadcast(k.half_size)) {}
  template <bool kGradient>
  HWY_INLINE LaneVector<T> begin(const LaneVector<T>& p) const {
    return p - center_;
  }
  template <bool kGradient>
  HWY_INLINE Measured measure(const LaneVector<T>& q) const {
    Measured m;
    m.x = beyond(dot(q, x_), half_.x), m.y = beyond(dot(q, y_), half_.y), m.z = beyond(dot(q, z_), half_.z);
    m.square = m.x * m.x + m.y * m.y + m.z * m.z;
    return m;
  }
  HWY_INLINE LaneVector<T> direction(const Measured& m) const { return m.x * x_ + m.y * y_ + m.z * z_; }

 private:
  static HWY_INLINE Lanes<T> beyond(Lanes<T> s, Lanes<T> half) { return s - smaller(larger(s, Lanes<T>(0) - half), half); }
  LaneVector<T> center_, x_, y_, z_, half_;
};

/// The nearest of a chain's segments so far, as a fraction square / radius_square: one comparison of products each, no
/// division.
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
  if (k.slope == T(0)) {
    const LaneVector<T> v = q - smaller(larger(h, begin), end) * axis;
    result.square = dot(v, v);
    result.radius_square = radius * radius;
    if constexpr (kGradient) result.vector = v;
    return result;
  }
  // field.md's t* is h + e^2 slope / (radius at h), e the distance from the axis; where that radius is gone, the thicker
  // end.
  const Lanes<T> slope(k.slope), radius_at_h = radius + h * slope, thicker(k.slope > T(0) ? k.end : k.begin);
  const LaneVector<T> across = q - h * axis;
  const Lanes<T> e_square = dot(across, across);
  const Lanes<T> best = select(radius_at_h > Lanes<T>(0), h + e_square * slope / radius_at_h, thicker);
  const Lanes<T> s = smaller(larger(best, begin), end), ahead = h - s, r = radius + s * slope;
  result.square = e_square + ahead * ahead;
  result.radius_square = r * r;
  if constexpr (kGradient) result.vector = across + ahead * axis;
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
