#include "skeletons/graph/lifespan.h"

#include "blobtree/input_error.h"
#include "skeletons/number_checks.h"

#include <algorithm>
#include <cmath>
#include <numeric>

namespace cambium {
namespace {

constexpr double kLongestLife = 1000;

}  // namespace

double LifespanDecrement::left(double lifespan) const {
  return std::max(0.0, lifespan - amount * (relative ? lifespan : 1.0));
}

LifespanDecrement draw_decrement(std::span<const LifespanOutcome> outcomes, StreamDraws& draws) {
  double total = 0;
  for (const LifespanOutcome& outcome : outcomes) total += outcome.probability;
  double chosen = draws.uniform() * total;
  std::size_t k = 0;
  while (k + 1 < outcomes.size() && chosen >= outcomes[k].probability) chosen -= outcomes[k++].probability;
  return {draws.between(outcomes[k].low, outcomes[k].high), outcomes[k].relative};
}

void validate_lifespan(const Lifespan& lifespan) {
  const double life = lifespan.initial.value_or(0);
  if (!(life >= 0 && life <= kLongestLife)) throw InputError({}, numbered("lifespan: L", life), "an L of 0 to 1000");
  double total = 0;
  for (const LifespanOutcome& outcome : lifespan.outcomes) {
    if (!(outcome.probability >= 0) || !std::isfinite(outcome.probability))
      throw InputError({}, numbered("lifespan: probability", outcome.probability), "a probability of 0 or more");
    if (!(outcome.low >= 0 && outcome.low <= outcome.high) || !std::isfinite(outcome.high))
      throw InputError({}, "lifespan: a decrement of " + std::to_string(outcome.low) + " to " + std::to_string(outcome.high),
                       "the least first, and neither below 0");
    total += outcome.probability;
  }
  if (!(total > 0)) throw InputError({}, "lifespan: no outcome with a probability above 0", "at least one");
}

std::vector<std::uint32_t> ranked_by_light(std::span<const Vec3> directions, const Vec3& light) {
  std::vector<std::uint32_t> order(directions.size());
  std::iota(order.begin(), order.end(), 0u);
  std::stable_sort(order.begin(), order.end(), [&](std::uint32_t a, std::uint32_t b) {
    return glm::dot(directions[a], light) > glm::dot(directions[b], light);
  });
  return order;
}

}  // namespace cambium
