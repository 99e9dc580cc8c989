// Where along a straight way t = 0 .. 1 a polynomial of the second degree is above or below something.
#pragma once

#include <algorithm>

namespace cambium {

/// Part of a way; closed.
struct Span {
  double lo = 0, hi = 1;
  bool empty() const { return !(lo <= hi); }
  /// Where slope * t + value >= 0.
  void keep_above(double slope, double value) {
    if (slope > 0) lo = std::max(lo, -value / slope);
    if (slope < 0) hi = std::min(hi, -value / slope);
    if (slope == 0 && value < 0) hi = lo - 1;
  }
};

/// a t^2 + b t + c
struct Quadratic {
  double a = 0, b = 0, c = 0;

  double at(double t) const { return (a * t + b) * t + c; }
  double least(const Span& span) const {
    const double ends = std::min(at(span.lo), at(span.hi));
    return a > 0 ? std::min(ends, at(std::clamp(-b / (2 * a), span.lo, span.hi))) : ends;
  }
  double most(const Span& span) const { return -Quadratic{-a, -b, -c}.least(span); }
};

}  // namespace cambium
