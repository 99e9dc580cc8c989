// Powers in vector lanes, of products and sums that are never fused: the same bits whatever the vector instructions.
// Included by batch_kernels.cpp once for each set of them. Private to blobtree/.
#if defined(CAMBIUM_BLOBTREE_LANE_POWER_INL_H) == defined(HWY_TARGET_TOGGLE)
#ifdef CAMBIUM_BLOBTREE_LANE_POWER_INL_H
#undef CAMBIUM_BLOBTREE_LANE_POWER_INL_H
#else
#define CAMBIUM_BLOBTREE_LANE_POWER_INL_H
#endif

#include "blobtree/lanes-inl.h"

#include <bit>
#include <cstdint>
#include <numbers>

HWY_BEFORE_NAMESPACE();
namespace cambium {
namespace HWY_NAMESPACE {

/// How a number is made of bits, and how many terms its precision asks of the two series.
template <class T> struct Binary;
template <>
struct Binary<float> {
  using Bits = std::uint32_t;
  static constexpr int kMantissa = 23, kBias = 127, kLogTerms = 5, kExpTerms = 8;
  static constexpr float kLn2High = 0.693359375f, kLn2Low = -2.12194440e-4f, kSmallestLog = -86;
};
template <>
struct Binary<double> {
  using Bits = std::uint64_t;
  static constexpr int kMantissa = 52, kBias = 1023, kLogTerms = 11, kExpTerms = 14;
  static constexpr double kLn2High = 6.93147180369123816490e-01, kLn2Low = 1.90821492927058770002e-10, kSmallestLog = -706;
};

template <class T>
HWY_INLINE auto bits_of(Lanes<T> a) {
  return hn::BitCast(hn::ScalableTag<typename Binary<T>::Bits>(), a.v);
}
template <class T, class V>
HWY_INLINE Lanes<T> from_bits(V bits) {
  return Lanes<T>(hn::BitCast(hn::ScalableTag<T>(), bits));
}

/// Natural logarithm of a > 0 (not of denormals): of 2^e m with m in [sqrt(1/2), sqrt(2)), by the series of 2
/// atanh((m-1)/(m+1)).
template <class T>
HWY_INLINE Lanes<T> log_of(Lanes<T> a) {
  using B = Binary<T>;
  using Bits = typename B::Bits;
  const hn::ScalableTag<Bits> d;
  constexpr T kRootHalf = static_cast<T>(1 / std::numbers::sqrt2);
  constexpr T kInteger = static_cast<T>(Bits{1} << B::kMantissa);   // a number whose last bit counts ones
  constexpr Bits kRootHalfBits = std::bit_cast<Bits>(kRootHalf), kMask = (Bits{1} << B::kMantissa) - 1;
  const auto moved = hn::Add(bits_of(a), hn::Set(d, std::bit_cast<Bits>(T(1)) - kRootHalfBits));
  const auto exponent = hn::Or(hn::ShiftRight<B::kMantissa>(moved), hn::Set(d, std::bit_cast<Bits>(kInteger)));
  const Lanes<T> e = from_bits<T>(exponent) - Lanes<T>(kInteger + B::kBias);
  const Lanes<T> m = from_bits<T>(hn::Add(hn::And(moved, hn::Set(d, kMask)), hn::Set(d, kRootHalfBits)));
  const Lanes<T> t = (m - Lanes<T>(1)) / (m + Lanes<T>(1)), t2 = t * t;
  Lanes<T> series(T(1) / (2 * B::kLogTerms - 1));
  for (int k = B::kLogTerms - 2; k >= 0; --k) series = series * t2 + Lanes<T>(T(1) / (2 * k + 1));
  return e * Lanes<T>(B::kLn2High) + (e * Lanes<T>(B::kLn2Low) + (t + t) * series);
}

/// e^y: 2^k e^r with |r| <= ln(2)/2. What is too small becomes the smallest that there is.
template <class T>
HWY_INLINE Lanes<T> exp_of(Lanes<T> y) {
  using B = Binary<T>;
  using Bits = typename B::Bits;
  const hn::ScalableTag<Bits> d;
  constexpr T kInteger = static_cast<T>(Bits{3} << (B::kMantissa - 1));
  const Lanes<T> limited = larger(y, Lanes<T>(B::kSmallestLog));
  const Lanes<T> shifted = limited * Lanes<T>(T(std::numbers::log2e)) + Lanes<T>(kInteger), k = shifted - Lanes<T>(kInteger);
  const Lanes<T> r = (limited - k * Lanes<T>(B::kLn2High)) - k * Lanes<T>(B::kLn2Low);
  Lanes<T> series(1);
  for (int i = B::kExpTerms - 1; i > 0; --i) series = series * r * Lanes<T>(T(1) / i) + Lanes<T>(1);
  const auto power_of_two = hn::Add(hn::ShiftLeft<B::kMantissa>(bits_of(shifted)), hn::Set(d, std::bit_cast<Bits>(T(1))));
  return series * from_bits<T>(power_of_two);
}

/// a^e for a >= 0.
template <class T> HWY_INLINE Lanes<T> power(Lanes<T> a, std::type_identity_t<T> e) {
  constexpr T kSmallest = std::numeric_limits<T>::min();
  return or_zero(a >= Lanes<T>(kSmallest), exp_of(log_of(larger(a, Lanes<T>(kSmallest))) * Lanes<T>(e)));
}
template <class T> HWY_INLINE LaneDual<T> power(const LaneDual<T>& a, std::type_identity_t<T> e) {
  const Lanes<T> p = power(a.f, e), slope = or_zero(a.f > Lanes<T>(0), Lanes<T>(e) * p / a.f);
  return {p, slope * a.x, slope * a.y, slope * a.z};
}

// NOLINTNEXTLINE(google-readability-namespace-comments)
}  // namespace HWY_NAMESPACE
}  // namespace cambium
HWY_AFTER_NAMESPACE();

#endif
