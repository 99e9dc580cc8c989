// The operators of field.md section 4 over the values of their active children. `with_zero` says that a child is left out
// because it is 0 here; every rule gives the same bits whether a zero child is given or left out.
// N is double, float, or a Dual of them.
#pragma once

#include "blobtree/blobtree.h"
#include "blobtree/dual.h"

#include <algorithm>
#include <cstdint>
#include <span>

namespace cambium {

template <class N>
N sum_of(const N* f, std::size_t n) {
  N total = f[0];
  for (std::size_t i = 1; i < n; ++i) total = total + f[i];
  return total;
}

template <class N>
N max_of(const N* f, std::size_t n, bool with_zero) {
  N best = f[0];
  for (std::size_t i = 1; i < n; ++i)
    if (value_of(f[i]) > value_of(best)) best = f[i];
  return with_zero && value_of(best) < 0 ? N(0) : best;
}

template <class N>
N min_of(const N* f, std::size_t n, bool with_zero) {
  N best = f[0];
  for (std::size_t i = 1; i < n; ++i)
    if (value_of(f[i]) < value_of(best)) best = f[i];
  return with_zero && value_of(best) > 0 ? N(0) : best;
}

/// first minus the rest; `taken` are the active subtrahends, capped: whether another one is 0 here.
template <class N>
N difference_of(const N& first, const N* taken, std::size_t n, bool capped) {
  N best = first;
  for (std::size_t i = 0; i < n; ++i)
    if (1 - value_of(taken[i]) < value_of(best)) best = N(1) - taken[i];
  return capped && value_of(best) > 1 ? N(1) : best;
}

template <class N>
N ricci_of(const N* f, std::size_t n, double exponent) {
  using T = typename NumberOf<N>::type;
  const T e = static_cast<T>(exponent);
  T largest(0);
  for (std::size_t i = 0; i < n; ++i) largest = std::max(largest, value_of(f[i]));
  const N unit(largest > T(1e-18) ? largest : T(1));  // or high powers would all round to 0
  N total(0);
  for (std::size_t i = 0; i < n; ++i)
    if (value_of(f[i]) > 0) total = total + power(f[i] / unit, e);
  return value_of(total) > 0 ? unit * power(total, T(1) / e) : N(0);
}

/// D(f) of contact: interpenetration c - f inside, propagation h(f) within `width` outside (Gascuel 1993; lip is ours).
template <class N>
N contact_push(const N& f, double width, double lip) {
  using T = typename NumberOf<N>::type;
  if (value_of(f) >= T(kIso)) return N(T(kIso)) - f;
  if (!(value_of(f) > T(kIso - width))) return N(0);
  const N u = (N(T(kIso)) - f) * N(T(1 / width));
  const N v = N(1) - u;
  return N(T(width)) * (u * v * v * (N(1) + N(T(lip)) * u));
}

template <class N>
N contact_of_two(const N& f1, const N& f2, double width, double lip) {  // f1 >= f2
  using T = typename NumberOf<N>::type;
  if (value_of(f2) >= T(kIso)) return f1;
  const N pushed1 = f1 + contact_push(f2, width, lip);
  const N pushed2 = f2 + contact_push(f1, width, lip);
  return value_of(pushed1) >= value_of(pushed2) ? pushed1 : pushed2;
}

template <class N>
N contact_of(const N* f, std::size_t n, bool with_zero, double width, double lip) {
  N first = f[0], second(0);
  bool two = false;
  const auto offer = [&](const N& x) {
    if (value_of(x) > value_of(first)) {
      second = first;
      first = x;
    } else if (!two || value_of(x) > value_of(second)) {
      second = x;
    }
    two = true;
  };
  for (std::size_t i = 1; i < n; ++i) offer(f[i]);
  if (with_zero) offer(N(0));
  return two ? contact_of_two(first, second, width, lip) : first;
}

/// S(t) = t^2 (3 - 2t), clamped.
template <class N>
N smooth_step(const N& t) {
  if (value_of(t) <= 0) return N(0);
  if (value_of(t) >= 1) return N(1);
  return t * t * (N(3) - N(2) * t);
}

/// Where a lateral is in contact (1) and where it melts into its axis (0): field.md section 4, `fork`.
template <class N>
N lateral_contact_weight(const Lateral& lateral, const Vec<typename NumberOf<N>::type>& from_point) {
  using T = typename NumberOf<N>::type;
  const Vec<T> m(lateral.direction);
  const N along = with_gradient<N>(glm::dot(from_point, m), m);
  const Distance<T> d = distance_along<T>(from_point);
  const N away = with_gradient<N>(d.value, d.gradient);
  const N in_crotch = smooth_step(N(T(0.5)) + along * N(T(0.5 / lateral.softness)));
  const N beyond = smooth_step((away - N(T(lateral.reach))) * N(T(1 / lateral.reach)));
  return N(1) - (N(1) - in_crotch) * (N(1) - beyond);
}

/// `axis` is 0 where it is not active; weights[k] belongs to f[k].
template <class N>
N fork_of(const N& axis, const N* f, const N* weights, std::size_t n, bool with_zero, double width, double lip) {
  N total(0), weighted(0);
  for (std::size_t k = 0; k < n; ++k) {
    if (!(value_of(f[k]) > 0)) continue;
    total = total + f[k];
    weighted = weighted + f[k] * weights[k];
  }
  if (!(value_of(total) > 0)) return axis;
  const N joined = contact_of(f, n, with_zero, width, lip);
  if (value_of(axis) == 0) return joined;
  const N contact_share = weighted / total;
  const bool positive = value_of(axis) > 0;
  const N pair[2] = {positive ? axis : N(0), joined};
  const N in_contact = contact_of(pair, 2, false, width, lip) + (positive ? N(0) : axis);
  return (N(1) - contact_share) * (axis + joined) + contact_share * in_contact;
}

// ---- conservative bounds of the same, over intervals --------------------------------------------------------------

Interval sum_of(const Interval* f, std::size_t n);
Interval max_of(const Interval* f, std::size_t n, bool with_zero);
Interval min_of(const Interval* f, std::size_t n, bool with_zero);
Interval difference_of(const Interval& first, const Interval* taken, std::size_t n, bool capped);
Interval ricci_of(const Interval* f, std::size_t n, double exponent);
Interval contact_of(const Interval* f, std::size_t n, bool with_zero, double width, double lip);
Interval lateral_contact_weight_interval(const Lateral& lateral, const Ball& ball);
Interval fork_of(const Interval& axis, const Interval* f, const Interval* weights, std::size_t n, bool with_zero, double width,
                 double lip);
Interval scaled(const Interval& f, double factor);

}  // namespace cambium
