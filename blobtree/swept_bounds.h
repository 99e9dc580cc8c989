// Bounds of segments' swept ratios over the eight children of a cube, a vector at a time. Private to blobtree/.
#pragma once

#include "blobtree/skeleton_primitives.h"

#include <array>
#include <cstddef>

namespace cambium {

inline constexpr std::size_t kChildren = 8;

/// Child k of a cube lies on the high side of axis a where bit a of k is set.
using ChildCenters = std::array<std::array<double, kChildren>, 3>;   ///< x, y and z of each

struct ChildBounds {
  std::array<double, kChildren> lo, hi;
};

/// What swept_ratio_interval gives over the balls of that radius around the centres, to rounding: bounds[i] is of segments[i].
/// Every set of vector instructions gives the same bits.
void bound_swept_ratios(const SweptSegment<double>* segments, std::size_t count, const ChildCenters& centers, double radius,
                        ChildBounds* bounds);

}  // namespace cambium
