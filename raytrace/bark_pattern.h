// Procedural bark over a branch's own coordinates: periodic around the girth, so u = 0 shows no seam.
#pragma once

#include "raytrace/bark.h"

#include <cstdint>

namespace cambium {

/// What a pattern gives at one point.
struct BarkTexel {
  double height = 1;   ///< 1 on an outer plate, 0 in a crack
  double shade = 1;    ///< factor on the plate's colour, around 1
  double mark = 0;     ///< [0, 1] how much of a lenticel or a dark band covers the point
};

/// u in turns, v in metres along the branch, radius in metres, footprint: metres on the surface that one pixel covers; detail
/// smaller than that fades to its mean. Continuous in u (period 1), v and radius. Deterministic in (seed, place).
BarkTexel bark_pattern(BarkStyle style, double scale, double u, double v, double radius, std::uint64_t seed, double footprint);

/// How deep the style's cracks are, as a fraction of the radius.
double bark_depth(BarkStyle style);

/// Periodic value noise in [0, 1]: x has the integer period `period`, y is free.
double bark_noise(double x, double y, std::uint32_t period, std::uint64_t seed);

}  // namespace cambium
