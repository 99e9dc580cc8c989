// The operators of field.md section 4, written once for every kind of value: numbers, numbers with gradients, and vector
// lanes of either. Text for the middle of a namespace, hence no include guard: operators.h includes it for numbers, and
// batch_kernels.cpp once for each set of vector instructions. The namespace supplies
//   NumberOf<N>::type        the number T that N is made of
//   value_of(n)              its value without gradient, which can be compared
//   select(c, a, b)          c ? a : b for a comparison c; all(c), none(c) allow short cuts that change no bit;
//   quickly_all(c), quickly_none(c)   likewise, where the short cut saves so little that lanes had better not branch (false)
//   power(n, e)              n^e for n >= 0
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

/// D(f) of contact: interpenetration c - f inside, propagation h(f) within `width` outside (Gascuel 1993; lip is ours).
template <class N>
CAMBIUM_RULE N contact_push(const N& f, double width, double lip) {
  using T = typename NumberOf<N>::type;
  const auto inside = value_of(f) >= T(kIso);
  const N depth = N(T(kIso)) - f;
  if (quickly_all(inside)) return depth;
  const auto near = value_of(f) > T(kIso - width);
  if (quickly_none(near)) return N(0);
  const N u = depth * T(1 / width);
  const N v = N(1) - u;
  const N propagated = (u * v * v * (N(1) + u * T(lip))) * T(width);
  return select(inside, depth, select(near, propagated, N(0)));
}

template <class N>
CAMBIUM_RULE N contact_of_two(const N& f1, const N& f2, double width, double lip) {  // f1 >= f2
  using T = typename NumberOf<N>::type;
  const auto deep = value_of(f2) >= T(kIso);
  if (quickly_all(deep)) return f1;
  const N pushed1 = f1 + contact_push(f2, width, lip);
  const N pushed2 = f2 + contact_push(f1, width, lip);
  return select(deep, f1, select(value_of(pushed1) >= value_of(pushed2), pushed1, pushed2));
}

template <class N>
CAMBIUM_RULE N contact_of(Operands<N> f, std::size_t n, bool with_zero, double width, double lip) {
  N first = f[0], second(0);
  bool two = false;
  const auto offer = [&](const N& x) CAMBIUM_RULE_LAMBDA {
    const auto larger = value_of(x) > value_of(first);
    const N runner_up = two ? select(value_of(x) > value_of(second), x, second) : x;
    second = select(larger, first, runner_up);
    first = select(larger, x, first);
    two = true;
  };
  for (std::size_t i = 1; i < n; ++i) offer(f[i]);
  if (with_zero) offer(N(0));
  return two ? contact_of_two(first, second, width, lip) : first;
}

/// S(t) = t^2 (3 - 2t), clamped.
template <class N>
CAMBIUM_RULE N smooth_step(const N& t) {
  const N inner = t * t * (N(3) - t * 2);
  return select(value_of(t) <= 0, N(0), select(value_of(t) >= 1, N(1), inner));
}

/// Where a lateral is in contact (1) and where it melts into its axis (0): field.md section 4, `fork`. `along` is the
/// point's distance from the branching point in the lateral's direction, `away` its distance from there.
template <class N, class T>
CAMBIUM_RULE N contact_weight(const N& along, const N& away, T half_per_softness, T reach, T per_reach) {
  const N in_crotch = smooth_step(N(T(0.5)) + along * half_per_softness);
  const N beyond = smooth_step((away - N(reach)) * per_reach);
  return N(1) - (N(1) - in_crotch) * (N(1) - beyond);
}

/// `axis` is 0 where it is not active; weights[k] belongs to f[k].
template <class N>
CAMBIUM_RULE N fork_of(const N& axis, Operands<N> f, Weights<N> weights, std::size_t n, bool with_zero,
                       double width, double lip) {
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
  const N joined = contact_of(f, n, with_zero, width, lip);
  const auto bare = value_of(axis) == 0;
  if (all(bare)) return select(reached, joined, axis);
  const N contact_share = weighted / total;
  const auto positive = value_of(axis) > 0;
  const N solid = select(positive, axis, N(0));
  const auto larger = value_of(joined) > value_of(solid);
  const N in_contact = contact_of_two(select(larger, joined, solid), select(larger, solid, joined), width, lip) +
                       select(positive, N(0), axis);
  const N mixed = (N(1) - contact_share) * (axis + joined) + contact_share * in_contact;
  return select(reached, select(bare, joined, mixed), axis);
}
