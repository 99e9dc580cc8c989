// Falloff and its bounds (Wyvill; field.md section 2).
#pragma once

#include "blobtree/geometry.h"

namespace cambium {

/// g(x) = (1 - x^2)^3 on [0, 1), else 0. x is distance / support radius, x >= 0.
template <class T>
inline T falloff(T x) {
  const T s = T(1) - x * x;
  return x < T(1) ? s * s * s : T(0);
}

/// dg/dx.
template <class T>
inline T falloff_slope(T x) {
  const T s = T(1) - x * x;
  return x < T(1) ? T(-6) * x * s * s : T(0);
}

/// strength * g over x in [lo, hi].
inline Interval falloff_interval(double x_lo, double x_hi, double strength) {
  const double near = strength * falloff(x_lo), far = strength * falloff(x_hi);
  return strength >= 0 ? Interval{far, near} : Interval{near, far};
}

}  // namespace cambium
