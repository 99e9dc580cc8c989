// Sine, cosine and angles in vector lanes, of products and sums that are never fused: the same bits whatever the vector
// instructions. Included by lane_warps-inl.h once for each set of them. Private to blobtree/.
#if defined(CAMBIUM_BLOBTREE_LANE_ANGLES_INL_H) == defined(HWY_TARGET_TOGGLE)
#ifdef CAMBIUM_BLOBTREE_LANE_ANGLES_INL_H
#undef CAMBIUM_BLOBTREE_LANE_ANGLES_INL_H
#else
#define CAMBIUM_BLOBTREE_LANE_ANGLES_INL_H
#endif

#include "blobtree/lanes-inl.h"

#include <array>
#include <cstddef>
#include <cstdint>
#include <limits>
#include <numbers>

HWY_BEFORE_NAMESPACE();
namespace cambium {
namespace HWY_NAMESPACE {

/// c[0] + c[1] x + c[2] x^2 ..., even and odd powers by themselves: two short chains of operations, not a long one.
template <class T, std::size_t kTerms>
HWY_INLINE Lanes<T> polynomial(const std::array<T, kTerms>& c, Lanes<T> x) {
  using V = Lanes<T>;
  constexpr std::size_t kLastEven = (kTerms - 1) / 2 * 2, kLastOdd = kTerms / 2 * 2 - 1;
  const V x2 = x * x;
  V even(c[kLastEven]), odd(c[kLastOdd]);
  for (std::size_t k = kLastEven; k >= 2; k -= 2) even = even * x2 + V(c[k - 2]);
  for (std::size_t k = kLastOdd; k >= 3; k -= 2) odd = odd * x2 + V(c[k - 2]);
  return even + odd * x;
}

/// From the term of a^power on, in powers of a^2: Taylor's series of sine and cosine.
template <std::size_t kTerms, class T = double>
constexpr std::array<T, kTerms> taylor_terms(int power) {
  std::array<T, kTerms> terms{};
  double term = power / 2 % 2 == 0 ? 1 : -1;
  for (int n = 2; n <= power; ++n) term /= n;
  for (T& t : terms) {
    t = static_cast<T>(term);
    term /= -(power + 1.0) * (power + 2.0);
    power += 2;
  }
  return terms;
}

/// The same of the arc tangent.
template <std::size_t kTerms, class T>
constexpr std::array<T, kTerms> arc_tangent_terms(int power) {
  std::array<T, kTerms> terms{};
  double sign = power / 2 % 2 == 0 ? 1 : -1;
  for (T& t : terms) {
    t = static_cast<T>(sign / power);
    sign = -sign;
    power += 2;
  }
  return terms;
}

struct SineAndCosine {
  Lanes<double> sine, cosine;
};

/// Both within 2.5e-16 for |a| <= 10^6. Beyond, up to 10^15, within 2.5e-16 and what the last bit of `a` turns them by.
HWY_INLINE SineAndCosine sine_and_cosine(Lanes<double> a) {
  using V = Lanes<double>;
  const hn::ScalableTag<double> d;
  const hn::ScalableTag<std::uint64_t> bits_d;
  constexpr double kInteger = 0x1.8p52;   // a number whose last bit counts ones
  // pi/2 = high + mid + low, the first two so short that multiples of them up to 10^6 are exact.
  constexpr double kHigh = 0x1.921FB544p0, kMid = 0x42D18469p-64, kLow = 0x898CC51701B84p-116;
  const V shifted = a * V(2 / std::numbers::pi) + V(kInteger), quarters = shifted - V(kInteger);
  const V r = ((a - quarters * V(kHigh)) - quarters * V(kMid)) - quarters * V(kLow), r2 = r * r;
  // For |r| <= pi/4 what is left out is less than 5e-17 and 3e-18.
  static constexpr std::array kSineTerms = taylor_terms<7>(3), kCosineTerms = taylor_terms<7>(4);
  const V sine = r + r2 * r * polynomial(kSineTerms, r2);
  const V cosine = (V(1) - r2 * V(0.5)) + r2 * r2 * polynomial(kCosineTerms, r2);
  const auto count = hn::BitCast(bits_d, shifted.v), one = hn::Set(bits_d, 1), two = hn::Set(bits_d, 2);
  const Condition<double> odd{hn::RebindMask(d, hn::TestBit(count, one))};
  const auto sine_sign = hn::BitCast(d, hn::ShiftLeft<62>(hn::And(count, two)));
  const auto cosine_sign = hn::BitCast(d, hn::ShiftLeft<62>(hn::And(hn::Add(count, one), two)));
  return {V(hn::Xor(select(odd, cosine, sine).v, sine_sign)), V(hn::Xor(select(odd, sine, cosine).v, cosine_sign))};
}

/// The angle of (x, y) from the y axis towards the x axis, in [-pi, pi]: atan2(x, y), within 5e-16, of floats 3e-7; 0 at the origin.
template <class T>
HWY_INLINE Lanes<T> angle_from_y(Lanes<T> x, Lanes<T> y) {
  using V = Lanes<T>;
  constexpr double kPi = std::numbers::pi;
  constexpr double kTan1 = 0.19891236737965800691, kTan2 = 0.41421356237309504880, kTan3 = 0.66817863791929891999;
  const V across(hn::Abs(x.v)), along(hn::Abs(y.v)), shorter = smaller(across, along), longer = larger(across, along);
  // kTan1, 2, 3: of pi/16, pi/8, 3 pi/16.
  // Of (longer, shorter), at most pi/4; measured from 0, pi/8 or pi/4, whichever is nearest: at most pi/16 from there.
  const Condition<T> from_first = shorter > V(kTan1) * longer, from_second = shorter > V(kTan3) * longer;
  const V base = or_zero(from_first, select(from_second, V(kPi / 4), V(kPi / 8)));
  const V slope = or_zero(from_first, select(from_second, V(1), V(kTan2)));
  const V divisor = larger(longer + slope * shorter, V(std::numeric_limits<T>::min()));
  const V t = (shorter - slope * longer) / divisor, t2 = t * t;
  // The next one would be less than 2e-17 of t; for floats 2e-9.
  static constexpr std::array kTerms = arc_tangent_terms<sizeof(T) == sizeof(double) ? 10 : 4, T>(3);
  const V angle = base + (t + t * t2 * polynomial(kTerms, t2));
  const V from_along = select(across > along, V(kPi / 2) - angle, angle);
  const V from_y = select(y < V(0), V(kPi) - from_along, from_along);
  return V(hn::CopySign(from_y.v, x.v));
}

// NOLINTNEXTLINE(google-readability-namespace-comments)
}  // namespace HWY_NAMESPACE
}  // namespace cambium
HWY_AFTER_NAMESPACE();

#endif
