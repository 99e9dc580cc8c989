// How a flare widens its chain, in vector lanes (flare.h). Included by batch_kernels.cpp once for each set of vector instructions.
// Private to blobtree/.
#if defined(CAMBIUM_BLOBTREE_LANE_FLARE_INL_H) == defined(HWY_TARGET_TOGGLE)
#ifdef CAMBIUM_BLOBTREE_LANE_FLARE_INL_H
#undef CAMBIUM_BLOBTREE_LANE_FLARE_INL_H
#else
#define CAMBIUM_BLOBTREE_LANE_FLARE_INL_H
#endif

#include "blobtree/lane_angles-inl.h"
#include "blobtree/lanes-inl.h"

#include "blobtree/flare.h"

#include <array>
#include <numbers>

HWY_BEFORE_NAMESPACE();
namespace cambium {
namespace HWY_NAMESPACE {

#define CAMBIUM_RULE HWY_INLINE
#include "blobtree/flare_sections-inl.h"
#undef CAMBIUM_RULE

template <class T>
struct FlareWidening {
  Lanes<T> per_square;          ///< 1 / M^2
  LaneVector<T> log_gradient;   ///< grad M / M; only if it was asked for
};

/// Of a in [0, pi/4], within 3e-8.
template <class T>
HWY_INLINE Lanes<T> short_sine(Lanes<T> a) {
  static constexpr std::array kTerms = taylor_terms<4, T>(3);
  const Lanes<T> a2 = a * a;
  return a + a * a2 * polynomial(kTerms, a2);
}
template <class T>
HWY_INLINE Lanes<T> short_cosine(Lanes<T> a) {
  static constexpr std::array kTerms = taylor_terms<4, T>(2);
  const Lanes<T> a2 = a * a;
  return Lanes<T>(1) + a2 * polynomial(kTerms, a2);
}

/// tanh(atanh(q)/3) for q = cos(2a), a in [0, pi/4]: with v = tan(a)^(2/3) it is (1 - v)/(1 + v). v begins at a quotient of polynomials
/// n/d, which is 1.1 % off at most where the result is below kSharpest, and one step of Halley's leaves 8e-7 of v; where it is
/// above, so is what this gives. E is at its largest there, so that it is off by the square of that only.
template <class T>
HWY_INLINE Lanes<T> widest_ellipse(Lanes<T> a, Lanes<T> sine2, Lanes<T> cosine2) {
  using V = Lanes<T>;
  static constexpr std::array<T, 3> kNumerator{T(0.0090252670), T(4.7106861), T(42.799564)};
  static constexpr std::array<T, 4> kDenominator{T(1), T(30.629583), T(18.809912), T(-13.007821)};
  const V n = polynomial(kNumerator, a), d = polynomial(kDenominator, a);
  const V n3 = n * n * n * cosine2, d3 = d * d * d * sine2;
  const V v = n * (n3 + d3 + d3), over = d * (n3 + n3 + d3);
  return (over - v) / (over + v);
}

template <class T>
class FlareLanes {
 public:
  using V = Lanes<T>;
  HWY_INLINE FlareLanes(const LocalFlare<T>& k, const LocalFlareGap<T>* gaps)
      : k_(k), gaps_(gaps), rest_(k.rest), x_(k.x), y_(k.y), spread_(k.spread), sharpness_(k.sharpness) {}

  template <bool kGradient>
  HWY_INLINE FlareWidening<T> at(const LaneVector<T>& p) const {
    FlareWidening<T> result{V(1), {V(0), V(0), V(0)}};
    const V unlimited = rest_.at(p), rest = larger(smaller(unlimited, V(1)), V(0));
    if (none(rest > V(0))) return result;
    const V x = x_.at(p), y = y_.at(p);
    const Gap gap = gap_at(angle_from_y(y, x));
    const V half_angle = V(std::numbers::pi / 2) * gap.from_prong, sine = short_sine(half_angle), cosine = short_cosine(half_angle);
    const V bent = V(2) * gap.more * gap.from_prong;   // how much longer the nearest prong becomes towards the other, by from_prong
    const V length = select(gap.past, gap.length + gap.more - bent * gap.from_prong, gap.length + bent * gap.from_prong);

    const V rest2 = rest * rest, k = rest2 * rest, wanted = sharpness_ * k * length, tau = smaller(wanted, V(kSharpest));
    const SectionRadius<V> radius = radius_at(half_angle, sine, cosine, tau);
    const V widening = V(1) + spread_ * k, per_m = V(1) / (radius.e * widening);
    result.per_square = per_m * per_m;
    if constexpr (kGradient) {
      const V per_e = widening * per_m, per_widening = radius.e * per_m, turned = V(2 * std::numbers::pi) * sine * cosine * gap.per_width;
      const V q_by_angle = select(gap.past, turned, V(0) - turned), length_by_angle = V(2) * bent * gap.per_width;
      const V by_tau = or_zero(wanted < V(kSharpest), radius.by_tau * sharpness_);
      const V by_angle = (radius.by_q * q_by_angle + by_tau * k * length_by_angle) * per_e;
      const V by_rest = (by_tau * length * per_e + spread_ * per_widening) * or_zero(unlimited < V(1), V(3) * rest2);
      const V around = by_angle / larger(x * x + y * y, V(1e-18));
      const LaneVector<T> slope = (around * x) * y_.direction - (around * y) * x_.direction + by_rest * rest_.direction;
      result.log_gradient = select(rest > V(0), slope, result.log_gradient);   // zeros without a sign, as above
    }
    return result;
  }

 private:
  /// A number that is linear in space.
  struct Coordinate {
    HWY_INLINE explicit Coordinate(const T (&row)[4]) : direction{V(row[0]), V(row[1]), V(row[2])}, offset(row[3]) {}
    HWY_INLINE V at(const LaneVector<T>& p) const { return dot(p, direction) + offset; }
    LaneVector<T> direction;
    V offset;
  };
  /// The gap between prongs that a lane is in, and how far it is from the nearer one, in gaps; past: the middle.
  struct Gap {
    V per_width, length, more, from_prong;
    Condition<T> past;
  };

  HWY_INLINE Gap gap_at(V azimuth) const {
    V begin(gaps_[0].begin), per_width(gaps_[0].per_width), length(gaps_[0].length), more(gaps_[0].more);
    for (std::uint32_t i = 1; i < k_.gap_count; ++i) {
      const Condition<T> reached = azimuth >= V(gaps_[i].begin);
      begin = select(reached, V(gaps_[i].begin), begin);
      per_width = select(reached, V(gaps_[i].per_width), per_width);
      length = select(reached, V(gaps_[i].length), length);
      more = select(reached, V(gaps_[i].more), more);
    }
    const V along = larger(smaller((azimuth - begin) * per_width, V(1)), V(0));
    return {per_width, length, more, smaller(along, V(1) - along), along > V(0.5)};
  }

  HWY_INLINE SectionRadius<V> radius_at(V half_angle, V sine, V cosine, V tau) const {
    const V sine2 = sine * sine, cosine2 = cosine * cosine;
    const V q = cosine2 - sine2;
    if (k_.section == FlareSection::kQuadrifolium) return quadrifolium_section(q, tau);
    if (k_.section == FlareSection::kCircle) return circle_section(q, tau);
    const V limit(1 - kLargestProngCosine), p = sine2 + sine2;
    SectionRadius<V> radius =
        envelope_section(smaller(q, V(kLargestProngCosine)), larger(p, limit), widest_ellipse(half_angle, sine2, cosine2), tau);
    radius.by_q = or_zero(p >= limit, radius.by_q);
    return radius;
  }

  const LocalFlare<T>& k_;
  const LocalFlareGap<T>* gaps_;
  Coordinate rest_, x_, y_;
  V spread_, sharpness_;
};

// NOLINTNEXTLINE(google-readability-namespace-comments)
}  // namespace HWY_NAMESPACE
}  // namespace cambium
HWY_AFTER_NAMESPACE();

#endif
