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

/// The distance to the solid cone is that to its slant (a strip's edge) above the base plane, and to its base disc below it;
/// both are differences in a frame in the (rho, h) half plane, so one root (rho) is all it takes.
void evaluate(const YardstickCone& cone, const float* HWY_RESTRICT x, const float* HWY_RESTRICT y,
              const float* HWY_RESTRICT z, float* HWY_RESTRICT f, std::size_t count) {
  const Tag d;
  const Floats zero = hn::Zero(d), one = hn::Set(d, 1.0f);
  const Floats u_x = hn::Set(d, cone.across_u[0]), u_y = hn::Set(d, cone.across_u[1]), u_z = hn::Set(d, cone.across_u[2]);
  const Floats v_x = hn::Set(d, cone.across_v[0]), v_y = hn::Set(d, cone.across_v[1]), v_z = hn::Set(d, cone.across_v[2]);
  const Floats h_x = hn::Set(d, cone.along[0]), h_y = hn::Set(d, cone.along[1]), h_z = hn::Set(d, cone.along[2]);
  const Floats u_0 = hn::Set(d, cone.across_u[3]), v_0 = hn::Set(d, cone.across_v[3]), h_0 = hn::Set(d, cone.along[3]);
  const Floats disc_radius = hn::Set(d, cone.disc_radius), slant_length = hn::Set(d, cone.slant_length);
  const Floats slant_along = hn::Set(d, cone.slant_along), slant_across = hn::Set(d, cone.slant_across);
  const std::size_t lanes = hn::Lanes(d);
  for (std::size_t i = 0; i < count; i += lanes) {
    const Floats px = hn::Load(d, x + i), py = hn::Load(d, y + i), pz = hn::Load(d, z + i);
    const Floats u = hn::MulAdd(px, u_x, hn::MulAdd(py, u_y, hn::MulAdd(pz, u_z, u_0)));
    const Floats v = hn::MulAdd(px, v_x, hn::MulAdd(py, v_y, hn::MulAdd(pz, v_z, v_0)));
    const Floats h = hn::MulAdd(px, h_x, hn::MulAdd(py, h_y, hn::MulAdd(pz, h_z, h_0)));
    const Floats rho = hn::Sqrt(hn::MulAdd(u, u, hn::Mul(v, v)));
    const Floats beyond_rim = hn::Sub(rho, disc_radius);
    const Floats along_slant = hn::MulSub(h, slant_along, hn::Mul(beyond_rim, slant_across));
    const Floats off_slant = hn::MulAdd(h, slant_across, hn::Mul(beyond_rim, slant_along));
    const Floats past_ends = hn::Sub(along_slant, hn::Min(hn::Max(along_slant, zero), slant_length));
    const auto below = hn::Lt(h, zero);
    const Floats outwards = hn::Max(hn::IfThenElse(below, beyond_rim, off_slant), zero);
    const Floats other = hn::IfThenElse(below, h, past_ends);
    const Floats s = hn::Max(hn::NegMulAdd(other, other, hn::NegMulAdd(outwards, outwards, one)), zero);
    hn::Store(hn::Mul(s, hn::Mul(s, s)), d, f + i);
  }
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
