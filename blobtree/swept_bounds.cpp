// Compiled for the same sets of vector instructions as batch_kernels.cpp.
#ifndef HWY_DISABLED_TARGETS
#define HWY_DISABLED_TARGETS (HWY_SSSE3 | HWY_AVX3_DL | HWY_SVE | HWY_SVE2 | HWY_SVE_256 | HWY_SVE2_128 | HWY_RVV)
#endif
#undef HWY_TARGET_INCLUDE
#define HWY_TARGET_INCLUDE "blobtree/swept_bounds.cpp"
#include <hwy/foreach_target.h>
// After foreach_target.h:
#include "blobtree/lanes-inl.h"

#include "blobtree/swept_bounds.h"

#include <algorithm>

HWY_BEFORE_NAMESPACE();
namespace cambium {
namespace HWY_NAMESPACE {

/// swept_ratio_interval(), which says why, in lanes.
HWY_INLINE void bound_some(const SweptSegment<double>& k, const LaneVector<double>& center, double radius, double* lo,
                           double* hi) {
  using V = Lanes<double>;
  const V begin(k.begin), end(k.end), slope(k.slope), zero(0.0), one(1.0), rho(radius);
  const LaneVector<double> axis{V(k.axis.x), V(k.axis.y), V(k.axis.z)};
  const LaneVector<double> q = center - LaneVector<double>{V(k.a.x), V(k.a.y), V(k.a.z)};
  const auto clamped = [&](V s) { return larger(begin, smaller(end, s)); };
  const auto radius_at = [&](V s) { return V(k.radius) + slope * s; };
  const auto length = [](const LaneVector<double>& v) { return root(dot(v, v)); };

  const V h = dot(q, axis);
  const V denominator = radius_at(h);
  const V nearest = clamped(h);
  const LaneVector<double> across = q - h * axis;
  const V e2 = dot(across, across);
  const V past = h - nearest;                       // |q - nearest axis|^2 = e2 + past^2
  const V at_nearest = root(e2 + past * past);
  if (k.slope == 0) {                               // a straight piece of a trunk: both extremes are at the nearest point
    const V per_radius(1 / k.radius), x = at_nearest * per_radius, reach = rho * per_radius;
    store(larger(zero, x - reach), lo);
    store(x + reach, hi);
    return;
  }
  const V thicker(k.slope > 0 ? k.end : k.begin);
  const V s = select(denominator > zero, clamped((h * V(k.radius) + dot(q, q) * slope) / denominator), thicker);
  const V per_radius = one / radius_at(s), at_center = length(q - s * axis) * per_radius;
  store(at_center + rho * per_radius, hi);

  const V thickest = larger(radius_at(begin), radius_at(end));
  V least = (at_nearest - rho) / thickest;
  const V rho2 = rho * rho, r2 = denominator * denominator;
  const Condition<double> outside = (denominator > zero) & (e2 > rho2);
  if (!none(outside)) {
    const V a = r2 + e2 * slope * slope;
    const V x = (root(rho2 * r2 + a * larger(zero, e2 - rho2)) - rho * denominator) / a;
    const V xk = x * slope, rest = one - xk * xk;
    const V unclamped = h + xk * root(e2 / larger(rest, V(1e-300)));
    const V best = clamped(unclamped);
    const V there = select(best == unclamped, x, (length(q - best * axis) - rho) / radius_at(best));
    least = select(outside & (rest > zero), larger(least, there), least);
  }
  store(smaller(at_center, larger(zero, least)), lo);
}

void swept_ratio_bounds(const SweptSegment<double>* segments, std::size_t count, const BallCenters& centers, double radius,
                        BallBounds* bounds) {
  constexpr std::size_t kStep = lane_count<double>();
  static_assert(kBalls % kStep == 0);
  alignas(64) double x[kBalls], y[kBalls], z[kBalls], lo[kBalls], hi[kBalls];
  std::copy(centers[0].begin(), centers[0].end(), x);
  std::copy(centers[1].begin(), centers[1].end(), y);
  std::copy(centers[2].begin(), centers[2].end(), z);
  for (std::size_t i = 0; i < count; ++i) {
    for (std::size_t c = 0; c < kBalls; c += kStep) {
      bound_some(segments[i], {load(x + c), load(y + c), load(z + c)}, radius, lo + c, hi + c);
    }
    std::copy(lo, lo + kBalls, bounds[i].lo.begin());
    std::copy(hi, hi + kBalls, bounds[i].hi.begin());
  }
}

// NOLINTNEXTLINE(google-readability-namespace-comments)
}  // namespace HWY_NAMESPACE
}  // namespace cambium
HWY_AFTER_NAMESPACE();

#if HWY_ONCE
namespace cambium {

HWY_EXPORT(swept_ratio_bounds);
void bound_swept_ratios(const SweptSegment<double>* segments, std::size_t count, const BallCenters& centers, double radius,
                        BallBounds* bounds) {
  HWY_DYNAMIC_DISPATCH(swept_ratio_bounds)(segments, count, centers, radius, bounds);
}

}  // namespace cambium
#endif  // HWY_ONCE
