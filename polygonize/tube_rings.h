// Rings around a chain: the cross-sections between which a straight wall stays within a tolerance of the swept surface.
// Private to polygonize/.
#pragma once

#include "blobtree/run_options.h"
#include "polygonize/chain_path.h"

#include <cstdint>
#include <vector>

namespace cambium {

struct TubeRule {
  double tolerance = 0;       ///< metres, of walls from the surface
  double min_sides = 6;
};

struct TubeRing {
  double at = 0;              ///< metres along the chain
  Vec3 center{0.0};
  Vec3 along{0.0};            ///< unit, across its plane, towards the chain's tip
  Vec3 side{0.0};             ///< unit, to its corner 0
  std::uint32_t sides = 0;
};

/// Corner k of a ring is as far outside of the surface as the middles of its sides are inside; the normal is the surface's.
ChainPath::SurfacePoint ring_corner(const ChainPath& path, const TubeRing& ring, std::uint32_t k);

/// Rings from one end of a stretch to the other: at the nodes where the chain bends or tapers, and so often that a branch that a
/// shader bends stays round (every kRingRadii radii). Where a bend is too sharp for rings that do not meet, a ring ends one part
/// and another begins the next; parts have at least two rings, and what lies between them has none. Of no use if cancelled.
std::vector<std::vector<TubeRing>> plan_rings(const ChainPath& path, const Stretch& stretch, const TubeRule& rule,
                                               const RunOptions& run = {});

inline constexpr double kRingRadii = 12;

}  // namespace cambium
