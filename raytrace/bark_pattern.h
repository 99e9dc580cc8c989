// Procedural bark over a branch's own coordinates: periodic around the girth, so u = 0 shows no seam.
#pragma once

#include "raytrace/bark_noise.h"
#include "raytrace/bark_number.h"

#include <cstdint>

namespace cambium {

/// Furrows between braided ridges (poplar, oak, ash); plates of thin scales (pine); grey skin with pores (beech, anything young);
/// white with dark bands (birch).
enum class BarkStyle { kRidged, kPlated, kSmooth, kBirch };

/// What a pattern gives at one point. A bark's colour there is outer * (its colour, warmed) + inner * (its crack's colour), so the
/// mean colour of a patch is that of the mean texel.
template <BarkNumber N>
struct BarkTexel {
  N relief{0.0};           ///< metres, 0 on an outer plate and negative in a crack
  double height = 1;       ///< 1 on an outer plate, 0 in a crack
  double outer = 1, inner = 0;
  double warm = 0;         ///< around 0: how much the outer colour turns to red
  double roughness = 0.85;
  double young = 0;        ///< how much of it is still the smooth skin of a thin stem
};

struct BarkPatternKind {
  BarkStyle style = BarkStyle::kRidged;
  double scale = 1;            ///< of the pattern, 1 = as grown on such a radius
  double mature_radius = 0;    ///< metres: from here on it is `style`; below a third of it the skin is still smooth
  std::uint64_t seed = 0;
};

/// u in turns, v in metres along the branch, radius in metres, footprint: metres on the surface that one pixel covers; detail
/// smaller than that fades to its mean. Continuous in u (period 1), v and radius. Deterministic in (seed, place).
template <BarkNumber N>
BarkTexel<N> bark_pattern(const BarkPatternKind& kind, const N& u, const N& v, double radius, double footprint);

extern template BarkTexel<double> bark_pattern(const BarkPatternKind&, const double&, const double&, double, double);
extern template BarkTexel<Sloped> bark_pattern(const BarkPatternKind&, const Sloped&, const Sloped&, double, double);

}  // namespace cambium
