// Sine, cosine and angles in vector lanes of double, of products and sums that are never fused: the same bits whatever the
// vector instructions. Included by lane_warps-inl.h once for each set of them. Private to blobtree/.
#if defined(CAMBIUM_BLOBTREE_LANE_ANGLES_INL_H) == defined(HWY_TARGET_TOGGLE)
#ifdef CAMBIUM_BLOBTREE_LANE_ANGLES_INL_H
#undef CAMBIUM_BLOBTREE_LANE_ANGLES_INL_H
#else
#define CAMBIUM_BLOBTREE_LANE_ANGLES_INL_H
#endif

#include "blobtree/lanes-inl.h"

#include <cstdint>
#include <limits>
#include <numbers>

HWY_BEFORE_NAMESPACE();
namespace cambium {
namespace HWY_NAMESPACE {

struct SineAndCosine {
  Lanes<double> sine, cosine;
};

/// Both within 2.5e-16 for |a| <= 10^6. Beyond, up to 10^15, within 2.5e-16 and as much as half the last bit of `a` turns
/// them by.
HWY_INLINE SineAndCosine sine_and_cosine(Lanes<double> a) {
  using V = Lanes<double>;
  const hn::ScalableTag<double> d;
  const hn::ScalableTag<std::uint64_t> bits_d;
  constexpr double kInteger = 0x1.8p52;   // a number whose last bit counts ones
  // pi/2 = high + mid + low, the first two so short that multiples of them up to 10^6 are exact.
  constexpr double kHigh = 0x1.921FB544p0, kMid = 0x42D18469p-64, kLow = 0x898CC51701B84p-116;
  const V shifted = a * V(2 / std::numbers::pi) + V(kInteger), quarters = shifted - V(kInteger);
  const V r = ((a - quarters * V(kHigh)) - quarters * V(kMid)) - quarters * V(kLow), r2 = r * r;
  // Taylor's series; for |r| <= pi/4 what is left out is less than 5e-17 and 3e-18.
  constexpr int kSineTerms = 8, kCosineTerms = 9;
  V sine(1), cosine(1);
  for (int k = kSineTerms - 1; k > 1; --k) sine = V(1) - sine * r2 * V(1.0 / (2 * k * (2 * k + 1)));
  for (int k = kCosineTerms - 1; k > 1; --k) cosine = V(1) - cosine * r2 * V(1.0 / (2 * k * (2 * k - 1)));
  sine = r - sine * (r2 * r) * V(1.0 / 6);
  cosine = V(1) - cosine * r2 * V(0.5);
  const auto count = hn::BitCast(bits_d, shifted.v), one = hn::Set(bits_d, 1), two = hn::Set(bits_d, 2);
  const Condition<double> odd{hn::RebindMask(d, hn::TestBit(count, one))};
  const auto sine_sign = hn::BitCast(d, hn::ShiftLeft<62>(hn::And(count, two)));
  const auto cosine_sign = hn::BitCast(d, hn::ShiftLeft<62>(hn::And(hn::Add(count, one), two)));
  return {V(hn::Xor(select(odd, cosine, sine).v, sine_sign)), V(hn::Xor(select(odd, sine, cosine).v, cosine_sign))};
}

/// The angle of (x, y) from the y axis towards the x axis, in [-pi, pi]: atan2(x, y), within 5e-16; 0 at the origin.
HWY_INLINE Lanes<double> angle_from_y(Lanes<double> x, Lanes<double> y) {
  using V = Lanes<double>;
  constexpr double kPi = std::numbers::pi;
  constexpr double kTan1 = 0.19891236737965800691, kTan2 = 0.41421356237309504880, kTan3 = 0.66817863791929891999;   // of k pi/16
  const V across(hn::Abs(x.v)), along(hn::Abs(y.v)), shorter = smaller(across, along), longer = larger(across, along);
  // Of (longer, shorter), at most pi/4; measured from 0, pi/8 or pi/4, whichever is nearest: at most pi/16 from there.
  const Condition<double> from_first = shorter > V(kTan1) * longer, from_second = shorter > V(kTan3) * longer;
  const V base = or_zero(from_first, select(from_second, V(kPi / 4), V(kPi / 8)));
  const V slope = or_zero(from_first, select(from_second, V(1), V(kTan2)));
  const V divisor = larger(longer + slope * shorter, V(std::numeric_limits<double>::min()));
  const V t = (shorter - slope * longer) / divisor, t2 = t * t;
  constexpr int kTerms = 11;   // the next one would be less than 2e-17 of the first
  V series(1.0 / (2 * kTerms - 1));
  for (int k = kTerms - 2; k > 0; --k) series = V(1.0 / (2 * k + 1)) - series * t2;
  const V angle = base + (t - t * t2 * series);
  const V from_along = select(across > along, V(kPi / 2) - angle, angle);
  const V from_y = select(y < V(0), V(kPi) - from_along, from_along);
  return V(hn::CopySign(from_y.v, x.v));
}

// NOLINTNEXTLINE(google-readability-namespace-comments)
}  // namespace HWY_NAMESPACE
}  // namespace cambium
HWY_AFTER_NAMESPACE();

#endif
