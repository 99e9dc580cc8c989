// The cross-sections of a flare, written once for numbers and for vector lanes of them. Text for the middle of a namespace, hence no
// include guard: flare.cpp includes it for numbers, lane_flare-inl.h once for each set of vector instructions. The namespace
// supplies root(v), smaller(v, w), or_zero(c, v), which is v where a comparison holds and else 0, and CAMBIUM_RULE (operator_rules-inl.h).
//
// A section is given by its polar radius E(q, tau) for q in [0, 1] (1 on a prong, 0 midway between two) and tau in [0, 0.95]:
// E(0) = 1 in the valleys and E(1) = 1 + tau on the prongs, growing with both. So does its slope by q; that by tau grows with q, and
// with tau goes one way only.

template <class V>
struct SectionRadius {
  V e, by_q, by_tau;
};

/// The envelope of co-axial ellipses with semi-axes 1 + x and 1 - x, |x| <= tau (Varadarajan 2011; field.md section 6b): the largest
/// of their envelope's radii, the one at x = tanh(atanh(q)/3), which is `widest`, if tau allows it. With four prongs and tau = 1 it is the
/// astroid. p = 1 - q.
template <class V>
CAMBIUM_RULE SectionRadius<V> envelope_section(V q, V p, V widest, V tau) {
  const V x = smaller(widest, tau), short_axis = V(1) - x, across = V(1) - x * x;
  const V per_square = V(1) / (short_axis * short_axis + (x + x) * p), e = across * root(per_square);
  return {e, e * x * per_square, or_zero(widest > tau, e * ((q - x) * per_square - (x + x) / across))};
}

/// The quadrifolium r = c |cos 2 theta|, the pedal of the astroid (for n prongs the rose with n petals), on the unit disc: the squares
/// of their radii added, so that its area is that of both and the larger tau, the more it is the rose itself.
template <class V>
CAMBIUM_RULE SectionRadius<V> quadrifolium_section(V q, V tau) {
  const V square = tau * (V(2) + tau), q2 = q * q, e = root(V(1) + square * q2), per_e = V(1) / e;
  return {e, square * q * per_e, (V(1) + tau) * q2 * per_e};
}

/// The circle of diameter 2 + tau that has its middle tau/2 towards the prong: of one prong, a round trunk off its axis; of two, an oval;
/// of more, round lobes.
template <class V>
CAMBIUM_RULE SectionRadius<V> circle_section(V q, V tau) {
  const V off = V(0.5) * tau, cosine = V(2) * q * q - V(1), square = off * cosine * cosine;
  const V rest = root(V(1) + tau + off * square), per_rest = V(1) / rest;
  return {off * cosine + rest, V(4) * q * off * (V(1) + off * cosine * per_rest), V(0.5) * (cosine + (V(1) + square) * per_rest)};
}
