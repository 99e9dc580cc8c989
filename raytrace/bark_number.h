// A number over a branch's two coordinates together with its slopes, so that one pass through a pattern gives its relief's
// gradient too. Patterns are written once, for a plain double and for this. Private to raytrace/.
#pragma once

#include <algorithm>
#include <cmath>
#include <concepts>

namespace cambium {

struct Sloped {
  double f = 0;
  double u = 0, v = 0;   ///< derivatives, per turn and per metre

  Sloped() = default;
  Sloped(double value) : f(value) {}
  Sloped(double value, double per_u, double per_v) : f(value), u(per_u), v(per_v) {}
};

/// double, or double with slopes.
template <class N>
concept BarkNumber = std::same_as<N, double> || std::same_as<N, Sloped>;

inline Sloped operator+(const Sloped& a, const Sloped& b) { return {a.f + b.f, a.u + b.u, a.v + b.v}; }
inline Sloped operator-(const Sloped& a, const Sloped& b) { return {a.f - b.f, a.u - b.u, a.v - b.v}; }
inline Sloped operator-(const Sloped& a) { return {-a.f, -a.u, -a.v}; }
inline Sloped operator*(const Sloped& a, const Sloped& b) { return {a.f * b.f, a.f * b.u + b.f * a.u, a.f * b.v + b.f * a.v}; }
inline Sloped operator*(const Sloped& a, double b) { return {a.f * b, a.u * b, a.v * b}; }
inline Sloped operator*(double a, const Sloped& b) { return b * a; }
inline Sloped& operator+=(Sloped& a, const Sloped& b) { return a = a + b; }

inline double value_of(double a) { return a; }
inline double value_of(const Sloped& a) { return a.f; }

/// f(x, y) where its value and its own derivatives at (x, y) are known.
inline double composed(double f, double, double, double, double) { return f; }
inline Sloped composed(double f, double by_x, double by_y, const Sloped& x, const Sloped& y) {
  return {f, by_x * x.u + by_y * y.u, by_x * x.v + by_y * y.v};
}
inline double composed(double f, double, double) { return f; }
inline Sloped composed(double f, double by_x, const Sloped& x) { return {f, by_x * x.u, by_x * x.v}; }

/// 0 up to lo, 1 from hi on, smooth between.
template <BarkNumber N>
N smooth(double lo, double hi, const N& x) {
  const double t = std::clamp((value_of(x) - lo) / (hi - lo), 0.0, 1.0);
  return composed(t * t * (3 - 2 * t), 6 * t * (1 - t) / (hi - lo), x);
}
template <BarkNumber N>
N clamped(const N& x, double lo, double hi) {
  return value_of(x) < lo ? N(lo) : value_of(x) > hi ? N(hi) : x;
}
template <BarkNumber N>
N larger(const N& a, const N& b) {
  return value_of(a) < value_of(b) ? b : a;
}
template <BarkNumber N>
N mixed(const N& a, const N& b, double t) {
  return a + t * (b - a);
}
template <BarkNumber N>
N mixed(const N& a, const N& b, const Sloped& t) {
  return a + t * (b - a);
}

}  // namespace cambium
