#include "bench/cone_yardstick.h"

#include <cmath>

#undef HWY_TARGET_INCLUDE
#define HWY_TARGET_INCLUDE "bench/cone_yardstick.cpp"
#include <hwy/foreach_target.h>
// Must follow foreach_target.h.
#include <hwy/highway.h>

HWY_BEFORE_NAMESPACE();
namespace cambium::bench::HWY_NAMESPACE {

namespace hn = hwy::HWY_NAMESPACE;
using Tag = hn::ScalableTag<float>;
using Floats = hn::Vec<Tag>;

/// Constants in registers.
struct Cone {
  Floats u[4], v[4], h[4], disc_radius, slant_length, slant_along, slant_across, rim_offset;
};

/// The distance to the solid cone is that to its slant (a strip's edge) above the base plane, and to its base disc below it; both
/// are differences in a frame in the (rho, h) half plane, so one root (rho) is all it takes.
HWY_INLINE Floats field(Tag d, const Cone& c, Floats x, Floats y, Floats z) {
  const Floats u = hn::MulAdd(x, c.u[0], hn::MulAdd(y, c.u[1], hn::MulAdd(z, c.u[2], c.u[3])));
  const Floats v = hn::MulAdd(x, c.v[0], hn::MulAdd(y, c.v[1], hn::MulAdd(z, c.v[2], c.v[3])));
  const Floats h = hn::MulAdd(x, c.h[0], hn::MulAdd(y, c.h[1], hn::MulAdd(z, c.h[2], c.h[3])));
  const Floats rho = hn::Sqrt(hn::MulAdd(u, u, hn::Mul(v, v)));
  const Floats beyond_rim = hn::Sub(rho, c.disc_radius);
  const Floats along_slant = hn::MulSub(h, c.slant_along, hn::Mul(beyond_rim, c.slant_across));
  const Floats off_slant = hn::MulAdd(h, c.slant_across, hn::Mul(beyond_rim, c.slant_along));
  const Floats zero = hn::Zero(d);
  const Floats past_ends = hn::Sub(along_slant, hn::Min(hn::Max(along_slant, zero), c.slant_length));
  const auto below = hn::Lt(h, zero);
  const Floats outwards = hn::Max(hn::IfThenElse(below, beyond_rim, off_slant), zero);
  const Floats other = hn::IfThenElse(below, h, past_ends);
  const Floats s = hn::Max(hn::NegMulAdd(other, other, hn::NegMulAdd(outwards, outwards, hn::Set(d, 1.0f))), zero);
  return hn::Mul(s, hn::Mul(s, s));
}

void evaluate(const YardstickCone& cone, const float* HWY_RESTRICT x, const float* HWY_RESTRICT y, const float* HWY_RESTRICT z,
              float* HWY_RESTRICT f, std::size_t count) {
  const Tag d;
  Cone c;
  for (int i = 0; i < 4; ++i) {
    c.u[i] = hn::Set(d, cone.across_u[i]);
    c.v[i] = hn::Set(d, cone.across_v[i]);
    c.h[i] = hn::Set(d, cone.along[i]);
  }
  c.disc_radius = hn::Set(d, cone.disc_radius);
  c.slant_length = hn::Set(d, cone.slant_length);
  c.slant_along = hn::Set(d, cone.slant_along);
  c.slant_across = hn::Set(d, cone.slant_across);
  const std::size_t lanes = hn::Lanes(d);
  for (std::size_t i = 0; i < count; i += lanes)
    hn::Store(field(d, c, hn::Load(d, x + i), hn::Load(d, y + i), hn::Load(d, z + i)), d, f + i);
}

const char* target_name() { return hwy::TargetName(HWY_TARGET); }

}  // namespace cambium::bench::HWY_NAMESPACE
HWY_AFTER_NAMESPACE();

#if HWY_ONCE
namespace cambium::bench {

HWY_EXPORT(evaluate);
HWY_EXPORT(target_name);

YardstickCone make_yardstick_cone(const double (&base)[3], const double (&tip)[3], double radius_base, double radius_tip) {
  const double support = radius_tip / std::sqrt(1 - std::cbrt(0.5));
  double axis[3], length = 0;
  for (int i = 0; i < 3; ++i) axis[i] = tip[i] - base[i];
  length = std::sqrt(axis[0] * axis[0] + axis[1] * axis[1] + axis[2] * axis[2]);
  for (double& a : axis) a /= length;

  // Any two directions across the axis: the first lies in the plane of the axis and its smallest coordinate.
  int smallest = 0;
  for (int i = 1; i < 3; ++i)
    if (std::abs(axis[i]) < std::abs(axis[smallest])) smallest = i;
  double across[3], size = std::sqrt(1 - axis[smallest] * axis[smallest]);
  for (int i = 0; i < 3; ++i) across[i] = ((i == smallest) - axis[smallest] * axis[i]) / size;
  const double third[3] = {axis[1] * across[2] - axis[2] * across[1], axis[2] * across[0] - axis[0] * across[2],
                           axis[0] * across[1] - axis[1] * across[0]};

  YardstickCone cone{};
  const auto coordinate = [&](const double(&direction)[3], float(&out)[4]) {
    double offset = 0;
    for (int i = 0; i < 3; ++i) {
      out[i] = static_cast<float>(direction[i] / support);
      offset -= direction[i] * base[i];
    }
    out[3] = static_cast<float>(offset / support);
  };
  coordinate(across, cone.across_u);
  coordinate(third, cone.across_v);
  coordinate(axis, cone.along);
  const double disc = radius_base - radius_tip, slant = std::hypot(length, disc);
  cone.disc_radius = static_cast<float>(disc / support);
  cone.slant_length = static_cast<float>(slant / support);
  cone.slant_along = static_cast<float>(length / slant);
  cone.slant_across = static_cast<float>(disc / slant);
  return cone;
}

void cone_yardstick(const YardstickCone& cone, const float* x, const float* y, const float* z, float* f, std::size_t count) {
  HWY_DYNAMIC_DISPATCH(evaluate)(cone, x, y, z, f, count);
}

const char* yardstick_target() { return HWY_DYNAMIC_DISPATCH(target_name)(); }

}  // namespace cambium::bench
#endif
