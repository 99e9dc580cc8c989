// The machine's own limit: the field of one solid finite cone over points in cache, written for speed alone and with nothing
// of the library in it.
#pragma once

#include <cstddef>

namespace cambium::bench {

/// What field.md section 3 makes of `cone` (radius_base > radius_tip > 0), in a frame of the cone's own. Lengths are in
/// units of the support radius, so that falloff needs no division.
struct YardstickCone {
  float across_u[4], across_v[4], along[4];  ///< coordinates across and along the axis: x * [0] + y * [1] + z * [2] + [3]
  float disc_radius;                         ///< of the solid cone's base
  float slant_length;                        ///< from its rim to its apex
  float slant_along, slant_across;           ///< the slant's unit direction: up the axis, and inwards
};

/// Metres. The cone has its base at (base) and its tip at (tip).
YardstickCone make_yardstick_cone(const double (&base)[3], const double (&tip)[3], double radius_base, double radius_tip);

/// f[i] = the cone's field at (x[i], y[i], z[i]), metres. Arrays of `count` floats, aligned to 64 bytes; count is a multiple
/// of 64. Runs on the best vector set of this CPU.
void cone_yardstick(const YardstickCone& cone, const float* x, const float* y, const float* z, float* f, std::size_t count);

/// Name of that vector set, as Highway calls it.
const char* yardstick_target();

}  // namespace cambium::bench
