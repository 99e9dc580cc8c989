// A field value with its gradient, closed under the arithmetic that operators need (forward differentiation: exact, no steps).
#pragma once

#include "blobtree/skeleton_primitives.h"

#include <cmath>
#include <type_traits>

namespace cambium {

template <class T>
struct Dual {
  T f{0};
  Vec<T> g{T(0)};

  Dual() = default;
  Dual(T value) : f(value) {}
  Dual(T value, const Vec<T>& gradient) : f(value), g(gradient) {}
};

template <class T> Dual<T> operator+(const Dual<T>& a, const Dual<T>& b) { return {a.f + b.f, a.g + b.g}; }
template <class T> Dual<T> operator-(const Dual<T>& a, const Dual<T>& b) { return {a.f - b.f, a.g - b.g}; }
template <class T> Dual<T> operator*(const Dual<T>& a, const Dual<T>& b) { return {a.f * b.f, a.f * b.g + b.f * a.g}; }
template <class T> Dual<T> operator/(const Dual<T>& a, const Dual<T>& b) {
  const T q = a.f / b.f;
  return {q, (a.g - q * b.g) / b.f};
}

template <class T> Dual<T> operator*(const Dual<T>& a, std::type_identity_t<T> b) { return {a.f * b, a.g * b}; }
template <class T> Dual<T> operator/(const Dual<T>& a, std::type_identity_t<T> b) { return {a.f / b, a.g / b}; }

template <class N>
struct NumberOf {
  using type = N;
};
template <class T>
struct NumberOf<Dual<T>> {
  using type = T;
};

/// The plain value of a number, and a number from a value and the gradient that it has.
inline double value_of(double a) { return a; }
inline float value_of(float a) { return a; }
template <class T> T value_of(const Dual<T>& a) { return a.f; }

template <class N>
struct ValueOf {
  using type = typename NumberOf<N>::type;
};
template <class N>
inline constexpr bool kHasGradient = !std::is_floating_point_v<N>;

template <class N>
N with_gradient(typename NumberOf<N>::type value, const Vec<typename NumberOf<N>::type>& gradient) {
  if constexpr (std::is_floating_point_v<N>) {
    (void)gradient;
    return value;
  } else {
    return N(value, gradient);
  }
}

/// The number of value v with the gradient a grad n, or a grad n + b grad m.
template <class T>
  requires std::is_floating_point_v<T>
T of_slope(T v, T, T) {
  return v;
}
template <class T> Dual<T> of_slope(T v, T a, const Dual<T>& n) { return {v, a * n.g}; }
template <class T>
  requires std::is_floating_point_v<T>
T of_slopes(T v, T, T, T, T) {
  return v;
}
template <class T>
Dual<T> of_slopes(T v, T a, const Dual<T>& n, T b, const Dual<T>& m) {
  return {v, a * n.g + b * m.g};
}

/// c ? a : b, and short cuts, as operator_rules-inl.h asks for them.
template <class N> N select(bool c, const N& a, const N& b) { return c ? a : b; }
inline bool all(bool c) { return c; }
inline bool none(bool c) { return !c; }
inline bool quickly_none(bool c) { return !c; }

template <class T>
  requires std::is_floating_point_v<T>
T root(T a) {
  return std::sqrt(a);
}
template <class T>
  requires std::is_floating_point_v<T>
T larger(T a, T b) {
  return a < b ? b : a;
}

/// a^e for a >= 0.
template <class T>
  requires std::is_floating_point_v<T>
T power(T a, T e) {
  return std::pow(a, e);
}
template <class T>
Dual<T> power(const Dual<T>& a, T e) {
  const T p = std::pow(a.f, e);
  return {p, a.f > T(0) ? (e * p / a.f) * a.g : Vec<T>(T(0))};
}

}  // namespace cambium
