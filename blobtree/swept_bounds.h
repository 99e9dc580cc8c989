// Bounds of segments' swept ratios over eight balls of one size, a vector at a time. Private to blobtree/.
#pragma once

#include "blobtree/skeleton_primitives.h"

#include <array>
#include <cstddef>

namespace cambium {

inline constexpr std::size_t kBalls = 8;

using BallCenters = std::array<std::array<double, kBalls>, 3>;   ///< x, y and z of each

struct BallBounds {
  std::array<double, kBalls> lo, hi;
};

/// What swept_ratio_interval gives over the balls of that radius around the centres, to rounding: bounds[i] is of segments[i].
/// Every set of vector instructions gives the same bits.
void bound_swept_ratios(const SweptSegment<double>* segments, std::size_t count, const BallCenters& centers, double radius,
                        BallBounds* bounds);

}  // namespace cambium
