// The operators of field.md section 4, written once for every kind of value: numbers, numbers with gradients, and vector
// lanes of either. Text for the middle of a namespace, hence no include guard: operators.h includes it for numbers, and
// batch_kernels.cpp once for each set of vector instructions. The namespace supplies
//   NumberOf<N>::type        the number T that N is made of
//   value_of(n)              its value without gradient, which can be compared
//   select(c, a, b)          c ? a : b for a comparison c; all(c), none(c) allow short cuts that change no bit;
//   quickly_none(c)          likewise, where the short cut saves so little that lanes had better not branch (false)
//   root(v), larger(v, w)    the square root of a value, the larger of two
//   power(n, e)              n^e for n >= 0
//   ValueOf<N>::type         what value_of gives; kHasGradient<N>: whether N has a gradient besides
//   with_gradient<N>(v, g)   the N of value v and gradient g
//   of_slope(v, a, n), of_slopes(v, a, n, b, m)   the N of value v and gradient a grad n, or a grad n + b grad m
//   CAMBIUM_RULE, CAMBIUM_RULE_LAMBDA   what the compiler is to know of a function, and of a lambda
//   Operands<N>              children by index, and offset by +; Weights<N> likewise for a fork
// `with_zero` says that a child is left out because it is 0 here; every rule gives the same bits whether a zero child is
// given or left out.

template <class N>
CAMBIUM_RULE N sum_of(Operands<N> f, std::size_t n) {
  N total = f[0];
  for (std::size_t i = 1; i < n; ++i) total = total + f[i];
  return total;
}

template <class N>
CAMBIUM_RULE N max_of(Operands<N> f, std::size_t n, bool with_zero) {
  N best = f[0];
  for (std::size_t i = 1; i < n; ++i) {
    const N x = f[i];
    best = select(value_of(x) > value_of(best), x, best);
  }
  return with_zero ? select(value_of(best) < 0, N(0), best) : best;
}

template <class N>
CAMBIUM_RULE N min_of(Operands<N> f, std::size_t n, bool with_zero) {
  N best = f[0];
  for (std::size_t i = 1; i < n; ++i) {
    const N x = f[i];
    best = select(value_of(x) < value_of(best), x, best);
  }
  return with_zero ? select(value_of(best) > 0, N(0), best) : best;
}

/// first minus the rest; `taken` are the active subtrahends, capped: whether another one is 0 here.
template <class N>
CAMBIUM_RULE N difference_of(const N& first, Operands<N> taken, std::size_t n, bool capped) {
  N best = first;
  for (std::size_t i = 0; i < n; ++i) {
    const N left = N(1) - taken[i];
    best = select(value_of(left) < value_of(best), left, best);
  }
  return capped ? select(value_of(best) > 1, N(1), best) : best;
}

template <class N>
CAMBIUM_RULE N ricci_of(Operands<N> f, std::size_t n, double exponent) {
  using T = typename NumberOf<N>::type;
  const T e = static_cast<T>(exponent);
  auto largest = value_of(N(0));
  for (std::size_t i = 0; i < n; ++i) {
    const auto x = value_of(f[i]);
    largest = select(largest < x, x, largest);
  }
  const auto unit = select(largest > T(1e-18), largest, value_of(N(1)));  // or high powers would all round to 0
  N total(0);
  for (std::size_t i = 0; i < n; ++i) {
    const N x = f[i];
    const auto positive = value_of(x) > 0;
    if (none(positive)) continue;
    total = select(positive, total + power(x / unit, e), total);
  }
  const auto positive = value_of(total) > 0;
  if (none(positive)) return N(0);
  return select(positive, power(total, T(1) / e) * unit, N(0));
}

/// Width and lip of a contact, made ready before a loop. The push of a child is D(f): interpenetration c - f inside,
/// propagation h(f) within `width` outside (Gascuel 1993; lip is ours).
template <class N>
struct ContactShape {
  using T = typename NumberOf<N>::type;
  using V = typename ValueOf<N>::type;
  V iso, nearest, per_width, width, lip;
  CAMBIUM_RULE ContactShape(double w, double a)
      : iso(T(kIso)), nearest(T(kIso - w)), per_width(T(1 / w)), width(T(w)), lip(T(a)) {}
};

/// The larger of f1 + D(f2) and f2 + D(f1), for f1 >= f2, and f1 itself where both are inside. Which of the two leads, and
/// how the other one's push grows with it (only worked out if N has a gradient).
template <class N>
struct Meeting {
  using V = typename ValueOf<N>::type;
  V f;
  decltype(V(0) < V(0)) first_leads;
  V slope;
};
template <class N, class V>
CAMBIUM_RULE Meeting<N> meeting(const V& f1, const V& f2, const ContactShape<N>& c) {
  const V depth1 = c.iso - f1, depth2 = c.iso - f2;
  // Beyond the width u = 1, where h is 0. Likewise where both are inside: then the first leads, with nothing added.
  const V u1 = select(f1 > c.nearest, depth1 * c.per_width, V(1));
  const V u2 = select((f2 > c.nearest) & (f2 < c.iso), depth2 * c.per_width, V(1));
  const V v1 = V(1) - u1, v2 = V(1) - u2;
  const V h1 = (u1 * v1 * v1 * (V(1) + u1 * c.lip)) * c.width, h2 = (u2 * v2 * v2 * (V(1) + u2 * c.lip)) * c.width;
  const V pushed1 = f1 + h2, pushed2 = f2 + select(f1 >= c.iso, depth1, h1);
  const auto first_leads = pushed1 >= pushed2;
  const V f = select(first_leads, pushed1, pushed2);
  if constexpr (kHasGradient<N>) {
    const V other = select(first_leads, u2, u1), u = larger(other, V(0));   // inside D' = h'(c) = -1
    const V v = V(1) - u, q = V(1) + u * c.lip;
    return {f, first_leads, v * ((q + q) * (u - v) + v)};
  } else {
    return {f, first_leads, f};
  }
}

/// The same of a and b in any order, and its derivatives by them.
template <class N>
struct OfTwo {
  using V = typename ValueOf<N>::type;
  V f, by_a, by_b;
};
template <class N, class V>
CAMBIUM_RULE OfTwo<N> contact_of_two(const V& a, const V& b, const ContactShape<N>& shape) {
  const auto swapped = b > a;
  const Meeting<N> met = meeting<N>(select(swapped, b, a), select(swapped, a, b), shape);
  if constexpr (kHasGradient<N>) {
    const auto a_leads = met.first_leads != swapped;
    return {met.f, select(a_leads, V(1), met.slope), select(a_leads, met.slope, V(1))};
  } else {
    return {met.f, met.f, met.f};
  }
}

template <class N>
CAMBIUM_RULE N contact_of(Operands<N> f, std::size_t n, bool with_zero, const ContactShape<N>& shape) {
  const N a = f[0];
  if (n == 1 && !with_zero) return a;
  if (n == 1) {
    const OfTwo<N> two = contact_of_two<N>(value_of(a), value_of(N(0)), shape);
    return of_slope(two.f, two.by_a, a);
  }
  const N b = f[1];
  if (n == 2 && !with_zero) {
    const OfTwo<N> two = contact_of_two<N>(value_of(a), value_of(b), shape);
    return of_slopes(two.f, two.by_a, a, two.by_b, b);
  }
  const auto swapped = value_of(b) > value_of(a);
  N first = select(swapped, b, a), second = select(swapped, a, b);
  const auto offer = [&](const N& x) CAMBIUM_RULE_LAMBDA {
    const auto leads = value_of(x) > value_of(first);
    const N runner_up = select(value_of(x) > value_of(second), x, second);
    second = select(leads, first, runner_up);
    first = select(leads, x, first);
  };
  for (std::size_t i = 2; i < n; ++i) offer(f[i]);
  if (with_zero) offer(N(0));
  using V = typename ValueOf<N>::type;
  const Meeting<N> met = meeting<N>(value_of(first), value_of(second), shape);
  return of_slopes(met.f, select(met.first_leads, V(1), met.slope), first, select(met.first_leads, met.slope, V(1)), second);
}

/// S(t) = t^2 (3 - 2t), clamped, and S'(t).
template <class V>
CAMBIUM_RULE V smooth_step(const V& t) {
  const V inner = t * t * (V(3) - t * 2);
  return select(t <= 0, V(0), select(t >= 1, V(1), inner));
}
template <class V>
CAMBIUM_RULE V smooth_step_slope(const V& t) {
  const V inner = t * (V(6) - t * 6);
  return larger(inner, V(0));
}

/// Where a lateral is in contact (1) and where it melts into its axis (0): field.md section 4, `fork`. `offset` is the
/// point's from the branching point, `along` its part in the lateral's direction and `square` its length squared.
template <class N, class V, class Vector, class T>
CAMBIUM_RULE N contact_weight(const Vector& offset, const Vector& direction, const V& along, const V& square,
                              T half_per_softness, T reach, T per_reach) {
  const V in_crotch = V(T(0.5)) + along * half_per_softness, not_in_crotch = V(1) - smooth_step(in_crotch);
  if (none(square > reach * reach)) {
    const V weight = V(1) - not_in_crotch;
    if constexpr (kHasGradient<N>)
      return N(0) + with_gradient<N>(weight, (smooth_step_slope(in_crotch) * half_per_softness) * direction);   // no -0
    else
      return weight;
  }
  const V away = root(square), beyond = (away - V(reach)) * per_reach, not_beyond = V(1) - smooth_step(beyond);
  const V weight = V(1) - not_in_crotch * not_beyond;
  if constexpr (kHasGradient<N>) {
    const V by_along = not_beyond * smooth_step_slope(in_crotch) * half_per_softness;
    const V by_away = not_in_crotch * smooth_step_slope(beyond) * per_reach;   // 0 up to `reach`
    const V per_away = V(1) / select(away > reach, away, V(reach));
    return N(0) + with_gradient<N>(weight, by_along * direction + (by_away * per_away) * offset);
  } else {
    return weight;
  }
}

/// Axis and laterals, the latter joined in a contact, of which `share` counts and the rest melts into the axis.
template <class N>
CAMBIUM_RULE N forked(const N& axis, const N& joined, const N& share, const ContactShape<N>& shape) {
  using V = typename ValueOf<N>::type;
  const V a = value_of(axis), c = value_of(joined), s = value_of(share);
  const auto bare = a == 0, positive = a > 0;
  const OfTwo<N> touching = contact_of_two<N>(select(positive, a, V(0)), c, shape);
  const V in_contact = touching.f + select(positive, V(0), a);
  const V melted = a + c, melts = V(1) - s;
  const V f = melts * melted + s * in_contact;
  if constexpr (kHasGradient<N>) {
    const V by_axis = melts + s * select(positive, touching.by_a, V(1)), by_joined = melts + s * touching.by_b;
    return select(bare, joined, of_slopes(f, by_axis, axis, by_joined, joined) + of_slope(V(0), in_contact - melted, share));
  } else {
    return select(bare, joined, f);
  }
}

/// `axis` is 0 where it is not active; weights[k] belongs to f[k].
template <class N>
CAMBIUM_RULE N fork_of(const N& axis, Operands<N> f, Weights<N> weights, std::size_t n, bool with_zero,
                       const ContactShape<N>& shape) {
  using V = typename ValueOf<N>::type;
  if (n == 1) {
    const N x = f[0];
    const auto reached = value_of(x) > 0;
    if (none(reached)) return axis;
    const N joined = contact_of(f, 1, with_zero, shape);
    if (all(value_of(axis) == 0)) return select(reached, joined, axis);
    const N weight = weights[0];
    const N share = of_slope(value_of(x) * value_of(weight) / value_of(x), V(1), weight);   // divided: so are several
    return select(reached, forked(axis, joined, share, shape), axis);
  }
  N total(0), weighted(0);
  for (std::size_t k = 0; k < n; ++k) {
    const N x = f[k];
    const auto positive = value_of(x) > 0;
    if (quickly_none(positive)) continue;
    total = select(positive, total + x, total);
    weighted = select(positive, weighted + x * weights[k], weighted);
  }
  const auto reached = value_of(total) > 0;
  if (none(reached)) return axis;
  const N joined = contact_of(f, n, with_zero, shape);
  if (all(value_of(axis) == 0)) return select(reached, joined, axis);
  return select(reached, forked(axis, joined, weighted / total, shape), axis);
}
