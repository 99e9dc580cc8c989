#include "blobtree/surface_traits.h"

#include "blobtree/operators.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <vector>

namespace cambium {
namespace {

SurfaceTraits mixed(const SurfaceTraits& a, const SurfaceTraits& b, double t) {
  const auto mix = [t](double x, double y) { return (1 - t) * x + t * y; };
  return {mix(a.cut, b.cut), mix(a.ridge, b.ridge), mix(a.dent, b.dent)};
}

/// Average by positive value.
SurfaceTraits averaged(const TraitedValue* f, std::size_t n) {
  SurfaceTraits sum;
  double total = 0;
  for (std::size_t i = 0; i < n; ++i) {
    const double w = std::max(0.0, f[i].f);
    total += w;
    sum.cut += w * f[i].traits.cut;
    sum.ridge += w * f[i].traits.ridge;
    sum.dent += w * f[i].traits.dent;
  }
  if (!(total > 0)) return {};
  return {sum.cut / total, sum.ridge / total, sum.dent / total};
}

/// The plain values in a row; on the stack where there are few, since every shaded point asks.
class Values {
 public:
  Values(const TraitedValue* f, std::size_t n) {
    if (n > few_.size()) many_.resize(n);
    double* const values = many_.empty() ? few_.data() : many_.data();
    for (std::size_t i = 0; i < n; ++i) values[i] = f[i].f;
  }
  const double* data() const { return many_.empty() ? few_.data() : many_.data(); }

 private:
  std::array<double, 16> few_;
  std::vector<double> many_;
};

/// A ridge where two children come near the surface together: both near the iso-value, neither far ahead.
double ridge_between(double first, double second, double width) {
  const double near = std::clamp(1 - (kIso - second) / width, 0.0, 1.0);
  const double even = std::clamp(1 - (first - second) / width, 0.0, 1.0);
  return near * even;
}

}  // namespace

TraitedValue sum_of(const TraitedValue* f, std::size_t n) {
  TraitedValue out{f[0].f, averaged(f, n)};
  double taken = std::min(0.0, f[0].f);
  for (std::size_t i = 1; i < n; ++i) {
    out.f += f[i].f;
    taken += std::min(0.0, f[i].f);
  }
  out.traits.dent = std::clamp(out.traits.dent - taken / kIso, 0.0, 1.0);
  return out;
}

TraitedValue max_of(const TraitedValue* f, std::size_t n, bool with_zero) {
  const TraitedValue best = *std::max_element(f, f + n, [](const auto& a, const auto& b) { return a.f < b.f; });
  return with_zero && best.f < 0 ? TraitedValue{} : best;
}

TraitedValue min_of(const TraitedValue* f, std::size_t n, bool with_zero) {
  const TraitedValue best = *std::min_element(f, f + n, [](const auto& a, const auto& b) { return a.f < b.f; });
  return with_zero && best.f > 0 ? TraitedValue{} : best;
}

TraitedValue difference_of(const TraitedValue& first, const TraitedValue* taken, std::size_t n, bool capped) {
  TraitedValue best = first;
  for (std::size_t i = 0; i < n; ++i)
    if (1 - taken[i].f < best.f) best = {1 - taken[i].f, {1, 0, 0}};
  if (capped) best.f = std::min(best.f, 1.0);
  return best;
}

TraitedValue ricci_of(const TraitedValue* f, std::size_t n, double exponent) {
  const Values v(f, n);
  return {ricci_of(v.data(), n, exponent), averaged(f, n)};
}

TraitedValue contact_of(const TraitedValue* f, std::size_t n, bool with_zero, double width, double lip) {
  const Values v(f, n);
  TraitedValue out{contact_of(v.data(), n, with_zero, width, lip), averaged(f, n)};
  double first = with_zero ? 0 : -kInfinity, second = -kInfinity;
  for (std::size_t i = 0; i < n; ++i) {
    second = std::max(second, std::min(first, f[i].f));
    first = std::max(first, f[i].f);
  }
  if (second > -kInfinity) out.traits.ridge = std::max(out.traits.ridge, ridge_between(first, second, width));
  return out;
}

TraitedValue fork_of(const TraitedValue& axis, const TraitedValue* f, const TraitedValue* weights, std::size_t n, bool with_zero,
                     double width, double lip) {
  const Values v(f, n), w(weights, n);
  const double value = fork_of(axis.f, v.data(), w.data(), n, with_zero, width, lip);
  double total = 0, share = 0;
  for (std::size_t k = 0; k < n; ++k) {
    total += std::max(0.0, f[k].f);
    share += std::max(0.0, f[k].f) * weights[k].f;
  }
  if (!(total > 0)) return {value, axis.traits};
  const TraitedValue joined = contact_of(f, n, with_zero, width, lip);
  const TraitedValue pair[2] = {axis, joined};
  const TraitedValue touching = contact_of(pair, 2, false, width, lip);
  return {value, mixed(averaged(pair, 2), touching.traits, share / total)};
}

TraitedValue scaled(const TraitedValue& f, double factor) { return {f.f * factor, f.traits}; }

}  // namespace cambium
