// Operators over courses: the value bounds are those of operators.h, the slopes follow the chain rule over intervals.
#include "blobtree/course.h"
#include "blobtree/interval_arithmetic.h"
#include "blobtree/operators.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <vector>

namespace cambium {
namespace {

constexpr double kNegligible = 1e-9;   // bounds are wider than values by less

/// Children's values in a row, as the rules for intervals want them; few enough to stay on the stack mostly.
class Values {
 public:
  Values(const Course* f, std::size_t n) {
    if (n > few_.size()) many_.resize(n);
    at_ = n > few_.size() ? many_.data() : few_.data();
    for (std::size_t i = 0; i < n; ++i) at_[i] = f[i].value;
  }
  Values(const Values&) = delete;
  Values& operator=(const Values&) = delete;
  const Interval* get() const { return at_; }

 private:
  std::array<Interval, 8> few_;
  std::vector<Interval> many_;
  Interval* at_ = nullptr;
};

/// Slopes of those that may be the largest.
Interval slope_of_largest(const Course* f, std::size_t n, bool with_zero, double largest_lo) {
  Interval slope = with_zero && largest_lo <= 0 ? Interval{0, 0} : kNothing;
  for (std::size_t i = 0; i < n; ++i)
    if (f[i].value.hi >= largest_lo) slope = hull(slope, f[i].slope);
  return slope;
}
Interval slope_of_smallest(const Course* f, std::size_t n, bool with_zero, double smallest_hi) {
  Interval slope = with_zero && smallest_hi >= 0 ? Interval{0, 0} : kNothing;
  for (std::size_t i = 0; i < n; ++i)
    if (f[i].value.lo <= smallest_hi) slope = hull(slope, f[i].slope);
  return slope;
}

/// What is the same all over has no slope, whatever its children's are.
Course unless_constant(const Interval& value, const Interval& slope) { return {value, value.lo == value.hi ? Interval{0, 0} : slope}; }

/// Where two children of a contact are inside, nobody pushes.
bool may_both_be_inside(const Course& a, const Course& b) { return a.value.hi >= kIso && b.value.hi >= kIso; }

/// One child of a contact leads and the other pushes it: the slope then.
Interval pushed_slope(const Course& leads, const Course& pushes, double width, double lip) {
  Interval by_push = contact_push_slope(pushes.value, width, lip);
  if (may_both_be_inside(leads, pushes)) by_push = hull(by_push, {0, 0});
  return leads.slope + by_push * pushes.slope;
}

/// The mean of a quantity of laterals, of each as much as it is above 0; at least one may be. At both its ends those beyond some one of
/// them are as much as they can be and the others as little.
template <class Quantity>
Interval mean_of(const Course* f, std::size_t n, const Quantity& of) {
  Interval mean = kNothing;
  for (std::size_t turn = 0; turn < n; ++turn) {
    if (!(f[turn].value.hi > 0)) continue;
    double low = 0, low_weight = 0, high = 0, high_weight = 0;
    for (std::size_t k = 0; k < n; ++k) {
      if (!(f[k].value.hi > 0)) continue;
      const double least = std::max(0.0, f[k].value.lo), most = f[k].value.hi;
      const double in_low = of(k).lo <= of(turn).lo ? most : least, in_high = of(k).hi >= of(turn).hi ? most : least;
      low += in_low * of(k).lo, low_weight += in_low;
      high += in_high * of(k).hi, high_weight += in_high;
    }
    mean = hull(mean, {low / low_weight, high / high_weight});
  }
  return mean;
}

/// How fast the share of a fork's laterals moves with what each of them has of their sum, times that sum: the sum over pairs of
/// (w_k - w_j) (f_k' p_j - f_j' p_k), p the part that one has.
double share_moves(const Course* f, const Course* weights, std::size_t n, double total_lo) {
  double moves = 0;
  for (std::size_t k = 0; k < n; ++k) {
    if (!(f[k].value.hi > 0)) continue;
    double farthest = 0, away = 0;   // the share from the weight of this one
    for (std::size_t j = 0; j < n; ++j) {
      if (j == k || !(f[j].value.hi > 0)) continue;
      const double apart = std::max(weights[k].value.hi - weights[j].value.lo, weights[j].value.hi - weights[k].value.lo);
      farthest = std::max(farthest, apart);
      away += apart * f[j].value.hi / (f[j].value.hi + total_lo - std::max(0.0, f[j].value.lo));
    }
    moves += times(std::max(std::abs(f[k].slope.lo), std::abs(f[k].slope.hi)), std::min(farthest, away));
  }
  return moves;
}

}  // namespace

// With u = (c - f)/w in [0, 1]: D' = p(u) = -1 + (4 - 2a) u + (6a - 3) u^2 - 4a u^3; -1 inside, 0 beyond the width.
Interval contact_push_slope(const Interval& f, double width, double lip) {
  Interval slope = kNothing;
  if (f.hi >= kIso) slope = hull(slope, {-1, -1});
  if (f.lo <= kIso - width) slope = hull(slope, {0, 0});
  const double u0 = std::clamp((kIso - f.hi) / width, 0.0, 1.0), u1 = std::clamp((kIso - f.lo) / width, 0.0, 1.0);
  const auto take = [&](double u) {
    const double p = -1 + u * ((4 - 2 * lip) + u * ((6 * lip - 3) - 4 * lip * u));
    slope = hull(slope, {p, p});
  };
  take(u0);
  take(u1);
  // p' = (4 - 2a) + (12a - 6) u - 12a u^2: where its sign is the same throughout there is no peak between.
  const double a = -12 * lip, b = 12 * lip - 6, c = 4 - 2 * lip;
  const double least = c + std::min(b * u0, b * u1) + a * u1 * u1, most = c + std::max(b * u0, b * u1) + a * u0 * u0;
  if (least <= 0 && most >= 0) {
    const auto take_peak = [&](double u) {
      if (u > u0 && u < u1) take(u);
    };
    const double discriminant = b * b - 4 * a * c;
    if (lip < 1e-9) {
      take_peak(-c / b);
    } else if (discriminant >= 0) {
      const double q = -0.5 * (b + std::copysign(std::sqrt(discriminant), b));
      take_peak(q / a);
      if (q != 0) take_peak(c / q);
    }
  }
  return {slope.lo - 1e-9, slope.hi + 1e-9};
}

Course sum_of(const Course* f, std::size_t n) {
  Course total{sum_of(Values(f, n).get(), n), f[0].slope};
  for (std::size_t i = 1; i < n; ++i) total.slope = total.slope + f[i].slope;
  return total;
}

Course max_of(const Course* f, std::size_t n, bool with_zero) {
  const Interval value = max_of(Values(f, n).get(), n, with_zero);
  return unless_constant(value, slope_of_largest(f, n, with_zero, value.lo));
}

Course min_of(const Course* f, std::size_t n, bool with_zero) {
  const Interval value = min_of(Values(f, n).get(), n, with_zero);
  return unless_constant(value, slope_of_smallest(f, n, with_zero, value.hi));
}

Course difference_of(const Course& first, const Course* taken, std::size_t n, bool capped) {
  const Interval value = difference_of(first.value, Values(taken, n).get(), n, capped);
  Interval slope = first.value.lo <= value.hi ? first.slope : kNothing;
  for (std::size_t i = 0; i < n; ++i)
    if (1 - taken[i].value.hi <= value.hi) slope = hull(slope, {-taken[i].slope.hi, -taken[i].slope.lo});
  if (capped && value.hi >= 1) slope = hull(slope, {0, 0});
  return unless_constant(value, slope);
}

// dF = sum of (f_i / F)^(e - 1) df_i, over those above 0.
Course ricci_of(const Course* f, std::size_t n, double exponent) {
  const Interval value = ricci_of(Values(f, n).get(), n, exponent);
  Interval slope{0, 0};
  for (std::size_t i = 0; i < n; ++i) {
    if (f[i].value.hi <= 0) continue;
    Interval share{0, 1};
    if (f[i].value.lo > 0) share.lo = std::pow(std::min(1.0, f[i].value.lo / value.hi), exponent - 1) * (1 - 1e-9);
    if (value.lo > 0) share.hi = std::min(1.0, std::pow(f[i].value.hi / value.lo, exponent - 1) * (1 + 1e-9));
    slope = slope + share * f[i].slope;
  }
  return {value, slope};
}

Course contact_of(const Course* f, std::size_t n, bool with_zero, double width, double lip) {
  if (n == 1 && !with_zero) return f[0];
  const Interval value = contact_of(Values(f, n).get(), n, with_zero, width, lip);
  const Course zero{};
  const std::size_t count = n + (with_zero ? 1 : 0);
  const auto child = [&](std::size_t i) -> const Course& { return i < n ? f[i] : zero; };
  double first_lo = -kInfinity, second_lo = -kInfinity;
  for (std::size_t i = 0; i < count; ++i) {
    const double lo = child(i).value.lo;
    second_lo = std::max(second_lo, std::min(first_lo, lo));
    first_lo = std::max(first_lo, lo);
  }
  // The two largest, either leading: not those that two others surely exceed.
  Interval slope = kNothing;
  for (std::size_t i = 0; i < count; ++i) {
    for (std::size_t j = 0; j < count; ++j) {
      if (i == j || child(i).value.hi < second_lo || child(j).value.hi < second_lo) continue;
      const Course &leads = child(i), &pushes = child(j);
      double push = largest_contact_push(pushes.value, width, lip);
      if (may_both_be_inside(leads, pushes)) push = std::max(push, 0.0);
      if (leads.value.hi + push < value.lo - kNegligible) continue;   // the other leads
      slope = hull(slope, pushed_slope(leads, pushes, width, lip));
    }
  }
  return {value, slope};
}

// With s the share, J the joined laterals, t = contact(a+, J) + a- and m = a + J:
// f = (1 - s) m + s t, df = (1 - s) dm + s dt + (t - m) ds, and -min(a+, J) <= t - m <= 0 where J >= 0.
Course fork_of(const Course& axis, const Course* f, const Course* weights, std::size_t n, bool with_zero, double width, double lip) {
  double total_lo = 0;
  bool any_may_be_bare = true, any = false;
  for (std::size_t k = 0; k < n; ++k) {
    if (f[k].value.lo > 0) any_may_be_bare = false;
    if (f[k].value.hi > 0) any = true;
    total_lo += std::max(0.0, f[k].value.lo);
  }
  if (!any) return axis;   // no lateral is here
  const Interval share = mean_of(f, n, [&](std::size_t k) -> const Interval& { return weights[k].value; });
  const Interval share_slope = mean_of(f, n, [&](std::size_t k) -> const Interval& { return weights[k].slope; });
  const Course joined = contact_of(f, n, with_zero, width, lip);
  const bool may_be_negative = axis.value.lo < -kNegligible;
  const Interval may_turn = may_be_negative ? hull(axis.slope, {0, 0}) : axis.slope;
  const Course pair[2] = {{max_of(&axis.value, 1, true), may_turn}, joined};
  const Course touching = contact_of(pair, 2, false, width, lip);
  const Interval value = forked(axis.value, joined.value, touching.value, share, any_may_be_bare);
  const Interval negative_part = may_be_negative ? hull(axis.slope, {0, 0}) : Interval{0, 0};
  const Interval melted = axis.slope + joined.slope, met = touching.slope + negative_part;
  const auto mixed = [&](double s) { return Interval{1 - s, 1 - s} * melted + Interval{s, s} * met; };
  Interval slope = hull(mixed(share.lo), mixed(share.hi));

  const bool joined_positive = joined.value.lo > -kNegligible;
  const double met_less = std::max(0.0, std::min(pair[0].value.hi, joined.value.hi)) + kNegligible;   // t - m >= -met_less
  const Interval missing = joined_positive ? Interval{-met_less, kNegligible} : Interval{-kInfinity, kInfinity};
  slope = slope + missing * share_slope;
  if (n > 1) {
    const double moves = share_moves(f, weights, n, total_lo);
    // t - m is at most the joined laterals, and these at most their sum.
    const double per_total = total_lo > 0 ? std::min(1.0, met_less / total_lo) : 1.0;
    const double most = joined_positive ? times(moves, per_total) : kInfinity;
    slope = slope + Interval{-most, most};
  }
  if (any_may_be_bare) slope = hull(slope, axis.slope);
  return {value, slope};
}

Course scaled(const Course& f, double factor) {
  return {scaled(f.value, factor), Interval{factor, factor} * f.slope};
}

}  // namespace cambium
