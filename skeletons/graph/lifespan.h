// How long branches go on (Xu and Mould 2012, section 3.3.3), and what light deals out to them (section 3.4).
#pragma once

#include "blobtree/place_hash.h"
#include "skeletons/graph/plan.h"

#include <span>

namespace cambium {

/// One draw from the table of outcomes.
struct LifespanDecrement {
  double amount = 1;
  bool relative = false;             ///< times the lifespan there is

  /// What is left of a lifespan; not below 0.
  double left(double lifespan) const;
};

/// Precondition: outcomes as validate_lifespan wants them.
LifespanDecrement draw_decrement(std::span<const LifespanOutcome> outcomes, StreamDraws& draws);

/// Errors: InputError (no location) for an L that is not in [0, 1000], no outcome, or one that lengthens life or is not finite.
void validate_lifespan(const Lifespan& lifespan);

/// The numbers of directions in order of their angle to the light, the smallest first; of equal angles the lower number.
std::vector<std::uint32_t> ranked_by_light(std::span<const Vec3> directions, const Vec3& light);

}  // namespace cambium
