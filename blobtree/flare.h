// How a flare widens the chain that it is (field.md section 6b): D' = D / M, M = E (1 + spread k), which depends on the place alone and
// not on the segment. Above the flare's height M is exactly 1. Private to blobtree/.
//
// q is limited to 0.999999 in the envelope, as field.md has it: its prongs end 1e-6 tau / (1 - tau)^2 of themselves short of 1 + tau.
#pragma once

#include "blobtree/geometry.h"
#include "blobtree/nodes.h"

#include <cstddef>
#include <string_view>
#include <vector>

namespace cambium {

inline constexpr double kSharpest = 0.95;
inline constexpr double kLargestProngCosine = 0.999999;

/// As in BlobTree JSON.
std::string_view name_of(FlareSection section);

/// In [0, 2 pi).
double wrapped_angle(double angle);

/// From one prong around to the next, radians.
struct FlareGap {
  double begin = 0, width = 0;
  double length = 1, next_length = 1;   ///< of the two prongs
};

struct CompiledFlare {
  explicit CompiledFlare(const Flare& authored);
  /// In metres along the axis, from the reference direction, and beside it.
  Vec3 local(const Vec3& p) const { return {glm::dot(p - base, axis), glm::dot(p - base, x), glm::dot(p - base, y)}; }

  Vec3 base, axis, x, y;                ///< a right-handed frame: x, y, axis
  double height = 0, spread = 0, sharpness = 0;
  FlareSection section = FlareSection::kEnvelope;
  double longest = 1;                   ///< of the prongs' lengths
  std::vector<FlareGap> gaps;           ///< ascending; all around
};

struct FlareFactor {
  double value = 1;
  Vec3 log_gradient{0.0};               ///< grad M / M; 0 on the axis, where there is none
};

/// M at a point.
double flare_factor(const CompiledFlare& flare, const Vec3& p);
FlareFactor flare_factor_gradient(const CompiledFlare& flare, const Vec3& p);

/// The azimuths at which a ball is that has its middle at one of them and rho from the axis; a hair more.
Interval arc_of_ball(double azimuth, double rho, double radius);
/// The gaps that an arc meets, ascending, their begins as the arc's ends are counted; one may be there twice.
std::vector<FlareGap> gaps_in_arc(const CompiledFlare& flare, const Interval& arc);

/// 1 + spread k: M in the valleys between prongs, the same all around the axis.
double flare_widening(const CompiledFlare& flare, const Vec3& p);

/// Bounds of M over a ball, and over the part of it in a box around its centre.
Interval flare_factor_interval(const CompiledFlare& flare, const Ball& ball);
Interval flare_factor_interval(const CompiledFlare& flare, const Ball& ball, const Vec3& half_size);

/// Ways through a ball, with velocities within `turn` of the given one; for those of unknown direction it is 0.
struct FlareWay {
  Ball ball;
  Vec3 velocity{0.0};
  double turn = 0;
  double half = 0;                      ///< or else a straight one, for so long before and after the ball's centre; turn is 0
};
struct FlareCourse {
  Interval factor, log_slope;           ///< of M, and of the derivative of ln M along the way; endless beside the axis
};
FlareCourse flare_course(const CompiledFlare& flare, const FlareWay& way);

/// The most that M can be where the sweep of a chain's segment, its radii 2.2 M times as large, reaches. 1 where that is nowhere
/// below the flare's height: there the flare is the chain.
double flare_reach(const CompiledFlare& flare, const ChainNode* ends);

}  // namespace cambium
