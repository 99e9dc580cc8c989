// The operators of field.md section 4 over the values of their active children, for double, float, or a Dual of them, and
// bounds of the same over intervals. `with_zero` says that a child is left out because it is 0 here.
#pragma once

#include "blobtree/blobtree.h"
#include "blobtree/dual.h"

#include <cstddef>

namespace cambium {

/// Children (and the weights of a fork's laterals) in a row.
template <class N>
using Operands = const N*;
template <class N>
using Weights = const N*;

#define CAMBIUM_RULE
#define CAMBIUM_RULE_LAMBDA
#include "blobtree/operator_rules-inl.h"
#undef CAMBIUM_RULE_LAMBDA
#undef CAMBIUM_RULE

template <class N>
N contact_of(const N* f, std::size_t n, bool with_zero, double width, double lip) {
  return contact_of<N>(f, n, with_zero, ContactShape<N>(width, lip));
}
template <class N>
N fork_of(const N& axis, const N* f, const N* weights, std::size_t n, bool with_zero, double width, double lip) {
  return fork_of<N>(axis, f, weights, n, with_zero, ContactShape<N>(width, lip));
}

/// The weight of a lateral at a point relative to its branching point.
template <class N>
N lateral_contact_weight(const Lateral& lateral, const Vec<typename NumberOf<N>::type>& from_point) {
  using T = typename NumberOf<N>::type;
  const Vec<T> m(lateral.direction);
  return contact_weight<N>(from_point, m, glm::dot(from_point, m), glm::dot(from_point, from_point),
                           T(0.5 / lateral.softness), T(lateral.reach), T(1 / lateral.reach));
}

// ---- conservative bounds of the same, over intervals --------------------------------------------------------------

Interval sum_of(const Interval* f, std::size_t n);
Interval max_of(const Interval* f, std::size_t n, bool with_zero);
Interval min_of(const Interval* f, std::size_t n, bool with_zero);
Interval difference_of(const Interval& first, const Interval* taken, std::size_t n, bool capped);
Interval ricci_of(const Interval* f, std::size_t n, double exponent);
Interval contact_of(const Interval* f, std::size_t n, bool with_zero, double width, double lip);
/// The most that a child with such values pushes another: D(f) of field.md section 4.
double largest_contact_push(const Interval& f, double width, double lip);
Interval lateral_contact_weight_interval(const Lateral& lateral, const Ball& ball);
Interval fork_of(const Interval& axis, const Interval* f, const Interval* weights, std::size_t n,
                 bool with_zero, double width, double lip);
/// The same from its parts: the laterals joined, their contact with what of the axis is positive, and the share that counts.
Interval forked(const Interval& axis, const Interval& joined, const Interval& touching, const Interval& share, bool may_be_bare);
Interval scaled(const Interval& f, double factor);

}  // namespace cambium
