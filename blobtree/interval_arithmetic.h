// Sums, products and hulls of intervals. Private to blobtree/.
#pragma once

#include "blobtree/geometry.h"

#include <algorithm>

namespace cambium {

inline constexpr Interval kNothing{kInfinity, -kInfinity};   ///< hull's neutral

inline Interval operator+(const Interval& a, const Interval& b) { return {a.lo + b.lo, a.hi + b.hi}; }
inline Interval hull(const Interval& a, const Interval& b) { return {std::min(a.lo, b.lo), std::max(a.hi, b.hi)}; }
/// 0 times infinity is 0 here: a bound that does not count.
inline double times(double a, double b) { return a == 0 || b == 0 ? 0 : a * b; }
inline Interval operator*(const Interval& a, const Interval& b) {
  const double ll = times(a.lo, b.lo), lh = times(a.lo, b.hi), hl = times(a.hi, b.lo), hh = times(a.hi, b.hi);
  return {std::min({ll, lh, hl, hh}), std::max({ll, lh, hl, hh})};
}

}  // namespace cambium
