#include "blobtree/operators.h"

#include "blobtree/interval_arithmetic.h"

#include <algorithm>
#include <cmath>
#include <vector>

namespace cambium {
namespace {

/// Rounding in the bounds themselves must not make them wrong by a bit.
Interval widened(const Interval& a) {
  const double slack = 1e-14 * (1 + std::max(std::abs(a.lo), std::abs(a.hi)));
  return {a.lo - slack, a.hi + slack};
}

/// D(f) of contact: interpenetration c - f inside, propagation h(f) within `width` outside.
double contact_push(double f, double width, double lip) {
  if (f >= kIso) return kIso - f;
  if (f <= kIso - width) return 0;
  const double u = (kIso - f) / width, v = 1 - u;
  return u * v * v * (1 + u * lip) * width;
}

}  // namespace

// h rises from u = 0 to one peak, which is at 1/3 for lip 0 and at 0.451 for lip 4, and falls to u = 1.
double largest_contact_push(const Interval& f, double width, double lip) {
  if (f.lo >= kIso) return kIso - f.lo;
  const double lo = std::max(f.lo, kIso - width), hi = std::min(f.hi, kIso);
  if (lo > hi) return 0;
  if (lo >= kIso - width / 3) return contact_push(lo, width, lip);
  if (hi <= kIso - width * 0.452) return contact_push(hi, width, lip);
  const double b = 3 - 2 * lip;
  const double peak_u = lip > 1e-9 ? (-b + std::sqrt(b * b + 16 * lip)) / (8 * lip) : 1.0 / 3;
  const double peak = kIso - width * peak_u;
  return contact_push(std::clamp(peak, lo, hi), width, lip);
}

namespace {

/// Of a child beside one that is larger: outside it lifts, inside it does nothing.
double least_contact_push(const Interval& f, double width, double lip) {
  if (f.lo <= kIso - width || f.hi >= kIso) return 0;
  return std::min(contact_push(f.lo, width, lip), contact_push(f.hi, width, lip));
}

}  // namespace

Interval sum_of(const Interval* f, std::size_t n) {
  Interval total = f[0];
  for (std::size_t i = 1; i < n; ++i) total = {total.lo + f[i].lo, total.hi + f[i].hi};
  return n > 1 ? widened(total) : total;
}

Interval max_of(const Interval* f, std::size_t n, bool with_zero) {
  Interval best = f[0];
  for (std::size_t i = 1; i < n; ++i) best = {std::max(best.lo, f[i].lo), std::max(best.hi, f[i].hi)};
  return with_zero ? Interval{std::max(best.lo, 0.0), std::max(best.hi, 0.0)} : best;
}

Interval min_of(const Interval* f, std::size_t n, bool with_zero) {
  Interval best = f[0];
  for (std::size_t i = 1; i < n; ++i) best = {std::min(best.lo, f[i].lo), std::min(best.hi, f[i].hi)};
  return with_zero ? Interval{std::min(best.lo, 0.0), std::min(best.hi, 0.0)} : best;
}

Interval difference_of(const Interval& first, const Interval* taken, std::size_t n, bool capped) {
  Interval best = first;
  for (std::size_t i = 0; i < n; ++i) best = {std::min(best.lo, 1 - taken[i].hi), std::min(best.hi, 1 - taken[i].lo)};
  return capped ? Interval{std::min(best.lo, 1.0), std::min(best.hi, 1.0)} : best;
}

Interval ricci_of(const Interval* f, std::size_t n, double exponent) {
  std::vector<double> lo, hi;
  for (std::size_t i = 0; i < n; ++i) {
    lo.push_back(f[i].lo);
    hi.push_back(f[i].hi);
  }
  const Interval bound = widened({ricci_of(lo.data(), n, exponent), ricci_of(hi.data(), n, exponent)});
  const bool zero = std::all_of(hi.begin(), hi.end(), [](double v) { return v <= 0; });
  return {std::max(0.0, bound.lo), zero ? 0.0 : bound.hi};
}

Interval contact_of(const Interval* f, std::size_t n, bool with_zero, double width, double lip) {
  if (n == 1 && !with_zero) return f[0];
  double lo1 = -kInfinity, lo2 = -kInfinity, hi1 = -kInfinity, hi2 = -kInfinity;
  const auto offer = [](double& first, double& second, double x) {
    if (x > first) {
      second = first;
      first = x;
    } else {
      second = std::max(second, x);
    }
  };
  for (std::size_t i = 0; i < n; ++i) {
    offer(lo1, lo2, f[i].lo);
    offer(hi1, hi2, f[i].hi);
  }
  if (with_zero) {
    offer(lo1, lo2, 0.0);
    offer(hi1, hi2, 0.0);
  }
  if (lo2 >= kIso) return {lo1, hi1};
  // The largest child is raised by the next one's push, but where both are inside, and either by no more than the other's largest push.
  const double pushed1 = hi1 + std::max(0.0, largest_contact_push({lo2, hi2}, width, lip));
  const double pushed2 = hi2 + largest_contact_push({lo1, hi1}, width, lip);
  return widened({lo1 + least_contact_push({lo2, hi2}, width, lip), std::max(pushed1, pushed2)});
}

Interval lateral_contact_weight_interval(const Lateral& lateral, const Ball& ball) {
  const Vec3 q = ball.center - lateral.point;
  const double along = glm::dot(q, lateral.direction), away = glm::length(q), rho = ball.radius;
  const auto weight = [&](double a, double d) {
    const double in_crotch = smooth_step(0.5 + a / (2 * lateral.softness));
    const double beyond = smooth_step((d - lateral.reach) / lateral.reach);
    return 1 - (1 - in_crotch) * (1 - beyond);
  };
  return {weight(along - rho, away - rho), weight(along + rho, away + rho)};
}

Interval fork_of(const Interval& axis, const Interval* f, const Interval* weights, std::size_t n, bool with_zero, double width,
                 double lip) {
  Interval share{1, 0};
  bool may_be_bare = true;
  for (std::size_t k = 0; k < n; ++k) {
    if (f[k].lo > 0) may_be_bare = false;
    if (f[k].hi > 0) share = hull(share, weights[k]);
  }
  if (share.hi < share.lo) return axis;
  const Interval joined = contact_of(f, n, with_zero, width, lip);
  const Interval pair[2] = {{std::max(axis.lo, 0.0), std::max(axis.hi, 0.0)}, joined};
  return forked(axis, joined, contact_of(pair, 2, false, width, lip), share, may_be_bare);
}

Interval forked(const Interval& axis, const Interval& joined, const Interval& touching, const Interval& share, bool may_be_bare) {
  const Interval summed{axis.lo + joined.lo, axis.hi + joined.hi};
  const Interval contact{touching.lo + std::min(axis.lo, 0.0), touching.hi + std::min(axis.hi, 0.0)};
  const auto mix = [](double a, double b, double t) { return (1 - t) * a + t * b; };
  Interval result{std::min(mix(summed.lo, contact.lo, share.lo), mix(summed.lo, contact.lo, share.hi)),
                  std::max(mix(summed.hi, contact.hi, share.lo), mix(summed.hi, contact.hi, share.hi))};
  if (may_be_bare) result = hull(result, axis);
  return widened(result);
}

Interval scaled(const Interval& f, double factor) {
  return factor >= 0 ? Interval{f.lo * factor, f.hi * factor} : Interval{f.hi * factor, f.lo * factor};
}

}  // namespace cambium
