// Vector lanes of a number, and of a number with its gradient, with the arithmetic that operator_rules-inl.h asks for.
// Included by batch_kernels.cpp once for each set of vector instructions, hence the toggled include guard. Private to
// blobtree/.
//
// Multiplications and additions are never fused, whatever the machine could do: so every set of instructions gives the same
// bits.
#if defined(CAMBIUM_BLOBTREE_LANES_INL_H) == defined(HWY_TARGET_TOGGLE)
#ifdef CAMBIUM_BLOBTREE_LANES_INL_H
#undef CAMBIUM_BLOBTREE_LANES_INL_H
#else
#define CAMBIUM_BLOBTREE_LANES_INL_H
#endif

#include <hwy/highway.h>

#include "blobtree/batch_program.h"

#include <cstddef>
#include <type_traits>

HWY_BEFORE_NAMESPACE();
namespace cambium {
namespace HWY_NAMESPACE {

namespace hn = hwy::HWY_NAMESPACE;

template <class T>
struct Condition {
  using D = hn::ScalableTag<T>;
  hn::Mask<D> m;
  friend HWY_INLINE Condition operator&(Condition a, Condition b) { return {hn::And(a.m, b.m)}; }
  friend HWY_INLINE Condition operator!=(Condition a, Condition b) { return {hn::Xor(a.m, b.m)}; }
};
template <class T> HWY_INLINE bool all(Condition<T> c) { return hn::AllTrue(hn::ScalableTag<T>(), c.m); }
template <class T> HWY_INLINE bool none(Condition<T> c) { return hn::AllFalse(hn::ScalableTag<T>(), c.m); }
template <class T> HWY_INLINE bool quickly_none(Condition<T>) { return false; }

template <class T>
struct Lanes {
  using D = hn::ScalableTag<T>;
  hn::Vec<D> v;

  Lanes() = default;
  template <class S>
    requires std::is_arithmetic_v<S>
  HWY_INLINE Lanes(S value) : v(hn::Set(D(), static_cast<T>(value))) {}
  HWY_INLINE explicit Lanes(hn::Vec<D> vector) : v(vector) {}

  friend HWY_INLINE Lanes operator+(Lanes a, Lanes b) { return Lanes(hn::Add(a.v, b.v)); }
  friend HWY_INLINE Lanes operator-(Lanes a, Lanes b) { return Lanes(hn::Sub(a.v, b.v)); }
  friend HWY_INLINE Lanes operator*(Lanes a, Lanes b) { return Lanes(hn::Mul(a.v, b.v)); }
  friend HWY_INLINE Lanes operator/(Lanes a, Lanes b) { return Lanes(hn::Div(a.v, b.v)); }
  friend HWY_INLINE Condition<T> operator<(Lanes a, Lanes b) { return {hn::Lt(a.v, b.v)}; }
  friend HWY_INLINE Condition<T> operator>(Lanes a, Lanes b) { return {hn::Gt(a.v, b.v)}; }
  friend HWY_INLINE Condition<T> operator<=(Lanes a, Lanes b) { return {hn::Le(a.v, b.v)}; }
  friend HWY_INLINE Condition<T> operator>=(Lanes a, Lanes b) { return {hn::Ge(a.v, b.v)}; }
  friend HWY_INLINE Condition<T> operator==(Lanes a, Lanes b) { return {hn::Eq(a.v, b.v)}; }
};

template <class T> HWY_INLINE constexpr std::size_t lane_count() { return hn::MaxLanes(hn::ScalableTag<T>()); }
template <class T> HWY_INLINE Lanes<T> load(const T* from) { return Lanes<T>(hn::Load(hn::ScalableTag<T>(), from)); }
template <class T> HWY_INLINE void store(Lanes<T> a, T* to) { hn::Store(a.v, hn::ScalableTag<T>(), to); }

/// From and to floats anywhere in memory.
template <class T> HWY_INLINE Lanes<T> load_floats(const float* from) {
  const hn::ScalableTag<T> d;
  if constexpr (std::is_same_v<T, float>) {
    return Lanes<T>(hn::LoadU(d, from));
  } else {
    return Lanes<T>(hn::PromoteTo(d, hn::LoadU(hn::Rebind<float, decltype(d)>(), from)));
  }
}
template <class T> HWY_INLINE void store_floats(Lanes<T> a, float* to) {
  const hn::ScalableTag<T> d;
  if constexpr (std::is_same_v<T, float>) {
    hn::StoreU(a.v, d, to);
  } else {
    const hn::Rebind<float, decltype(d)> narrow;
    hn::StoreU(hn::DemoteTo(narrow, a.v), narrow, to);
  }
}

template <class T> HWY_INLINE Lanes<T> select(Condition<T> c, Lanes<T> a, Lanes<T> b) {
  return Lanes<T>(hn::IfThenElse(c.m, a.v, b.v));
}
template <class T> HWY_INLINE Lanes<T> or_zero(Condition<T> c, Lanes<T> a) { return Lanes<T>(hn::IfThenElseZero(c.m, a.v)); }
template <class T> HWY_INLINE Lanes<T> smaller(Lanes<T> a, Lanes<T> b) { return Lanes<T>(hn::Min(a.v, b.v)); }
template <class T> HWY_INLINE Lanes<T> larger(Lanes<T> a, Lanes<T> b) { return Lanes<T>(hn::Max(a.v, b.v)); }
template <class T> HWY_INLINE Lanes<T> root(Lanes<T> a) { return Lanes<T>(hn::Sqrt(a.v)); }

template <class T>
struct LaneDual {
  Lanes<T> f, x, y, z;

  LaneDual() = default;
  HWY_INLINE explicit LaneDual(T value) : f(value), x(0), y(0), z(0) {}
  HWY_INLINE LaneDual(Lanes<T> value, Lanes<T> gx, Lanes<T> gy, Lanes<T> gz) : f(value), x(gx), y(gy), z(gz) {}

  friend HWY_INLINE LaneDual operator+(const LaneDual& a, const LaneDual& b) {
    return {a.f + b.f, a.x + b.x, a.y + b.y, a.z + b.z};
  }
  friend HWY_INLINE LaneDual operator-(const LaneDual& a, const LaneDual& b) {
    return {a.f - b.f, a.x - b.x, a.y - b.y, a.z - b.z};
  }
  friend HWY_INLINE LaneDual operator*(const LaneDual& a, const LaneDual& b) {
    return {a.f * b.f, a.f * b.x + b.f * a.x, a.f * b.y + b.f * a.y, a.f * b.z + b.f * a.z};
  }
  friend HWY_INLINE LaneDual operator/(const LaneDual& a, const LaneDual& b) {
    const Lanes<T> q = a.f / b.f, per_b = Lanes<T>(1) / b.f;
    return {q, (a.x - q * b.x) * per_b, (a.y - q * b.y) * per_b, (a.z - q * b.z) * per_b};
  }
  friend HWY_INLINE LaneDual operator*(const LaneDual& a, Lanes<T> b) { return {a.f * b, a.x * b, a.y * b, a.z * b}; }
  friend HWY_INLINE LaneDual operator/(const LaneDual& a, Lanes<T> b) {
    const Lanes<T> per_b = Lanes<T>(1) / b;
    return {a.f / b, a.x * per_b, a.y * per_b, a.z * per_b};
  }
};

template <class T> HWY_INLINE LaneDual<T> select(Condition<T> c, const LaneDual<T>& a, const LaneDual<T>& b) {
  return {select(c, a.f, b.f), select(c, a.x, b.x), select(c, a.y, b.y), select(c, a.z, b.z)};
}
template <class T> HWY_INLINE Lanes<T> value_of(Lanes<T> a) { return a; }
template <class T> HWY_INLINE Lanes<T> value_of(const LaneDual<T>& a) { return a.f; }

template <class N> struct NumberOf;
template <class T> struct NumberOf<Lanes<T>> { using type = T; };
template <class T> struct NumberOf<LaneDual<T>> { using type = T; };

template <class N> struct ValueOf { using type = Lanes<typename NumberOf<N>::type>; };
template <class N> inline constexpr bool kHasGradient = false;
template <class T> inline constexpr bool kHasGradient<LaneDual<T>> = true;

/// The number of value v with the gradient a grad n, or a grad n + b grad m.
template <class T> HWY_INLINE Lanes<T> of_slope(Lanes<T> v, Lanes<T>, Lanes<T>) { return v; }
template <class T> HWY_INLINE LaneDual<T> of_slope(Lanes<T> v, Lanes<T> a, const LaneDual<T>& n) {
  return {v, a * n.x, a * n.y, a * n.z};
}
template <class T> HWY_INLINE Lanes<T> of_slopes(Lanes<T> v, Lanes<T>, Lanes<T>, Lanes<T>, Lanes<T>) { return v; }
template <class T>
HWY_INLINE LaneDual<T> of_slopes(Lanes<T> v, Lanes<T> a, const LaneDual<T>& n, Lanes<T> b, const LaneDual<T>& m) {
  return {v, a * n.x + b * m.x, a * n.y + b * m.y, a * n.z + b * m.z};
}

/// A point, or a vector, per lane.
template <class T>
struct LaneVector {
  Lanes<T> x, y, z;
  friend HWY_INLINE LaneVector operator-(const LaneVector& a, const LaneVector& b) {
    return {a.x - b.x, a.y - b.y, a.z - b.z};
  }
  friend HWY_INLINE LaneVector operator+(const LaneVector& a, const LaneVector& b) {
    return {a.x + b.x, a.y + b.y, a.z + b.z};
  }
  friend HWY_INLINE LaneVector operator*(Lanes<T> s, const LaneVector& a) { return {s * a.x, s * a.y, s * a.z}; }
};
template <class T> HWY_INLINE Lanes<T> dot(const LaneVector<T>& a, const LaneVector<T>& b) {
  return a.x * b.x + a.y * b.y + a.z * b.z;
}
template <class T> HWY_INLINE LaneVector<T> broadcast(const T (&v)[3]) {
  return {Lanes<T>(v[0]), Lanes<T>(v[1]), Lanes<T>(v[2])};
}
template <class T> HWY_INLINE LaneVector<T> select(Condition<T> c, const LaneVector<T>& a, const LaneVector<T>& b) {
  return {select(c, a.x, b.x), select(c, a.y, b.y), select(c, a.z, b.z)};
}

template <class N, class T> HWY_INLINE N with_gradient(Lanes<T> value, const LaneVector<T>& g) {
  if constexpr (std::is_same_v<N, Lanes<T>>) {
    return value;
  } else {
    return N(value, g.x, g.y, g.z);
  }
}

/// Values in memory: an array of T, or four of them `stride` apart for value and gradient.
template <class N> struct Slot;
template <class T>
struct Slot<Lanes<T>> {
  T* at;
  std::size_t stride;
  HWY_INLINE Lanes<T> get(std::size_t i) const { return load(at + i); }
  HWY_INLINE void put(std::size_t i, Lanes<T> f) const { store(f, at + i); }
  static constexpr std::size_t kArrays = 1;
};
template <class T>
struct Slot<LaneDual<T>> {
  T* at;
  std::size_t stride;
  HWY_INLINE LaneDual<T> get(std::size_t i) const {
    return {load(at + i), load(at + stride + i), load(at + 2 * stride + i), load(at + 3 * stride + i)};
  }
  HWY_INLINE void put(std::size_t i, const LaneDual<T>& n) const {
    store(n.f, at + i);
    store(n.x, at + stride + i);
    store(n.y, at + 2 * stride + i);
    store(n.z, at + 3 * stride + i);
  }
  static constexpr std::size_t kArrays = 4;
};

/// The children of an operator at lanes i and on: consecutive slots.
template <class N>
struct Operands {
  Slot<N> first;
  std::size_t i;
  HWY_INLINE N operator[](std::size_t child) const {
    return Slot<N>{first.at + child * Slot<N>::kArrays * first.stride, first.stride}.get(i);
  }
  HWY_INLINE Operands operator+(std::size_t children) const {
    return {{first.at + children * Slot<N>::kArrays * first.stride, first.stride}, i};
  }
};

// NOLINTNEXTLINE(google-readability-namespace-comments)
}  // namespace HWY_NAMESPACE
}  // namespace cambium
HWY_AFTER_NAMESPACE();

#endif
