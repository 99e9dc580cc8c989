// The corners of the polygon dual to a minimal edge.
#pragma once

#include "polygonize/minimal_edges.h"

#include <array>

namespace cambium {

/// The polygon's patches in ring order, counter-clockwise seen from outside, each once; quadrant: where each was found first.
struct Ring {
  std::array<std::uint32_t, 4> patches{};
  std::array<std::array<int, 2>, 4> across{};   ///< the quadrants on both sides of the face to the next
  int count = 0;
};

inline Ring ring_of(const MinimalEdge& edge, const std::array<std::uint32_t, 4>& patch_of) {
  Ring ring;
  for (int k = 0; k < 4; ++k) {
    const int q = edge.low_inside ? kRing[k] : kRing[3 - k];
    const int next = edge.low_inside ? kRing[(k + 1) % 4] : kRing[(6 - k) % 4];
    if (edge.leaves[q] == edge.leaves[next]) continue;
    ring.patches[ring.count] = patch_of[q];
    ring.across[ring.count] = {q, next};
    ++ring.count;
  }
  return ring;
}

}  // namespace cambium
