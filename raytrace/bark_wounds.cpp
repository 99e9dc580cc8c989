#include "raytrace/bark_wounds.h"

#include "raytrace/bark_noise.h"
#include "blobtree/place_hash.h"

#include <algorithm>
#include <cmath>
#include <numbers>

namespace cambium {
namespace {

constexpr std::uint32_t kAround = 16;   // columns of the wounds' own noise

/// Noise on a branch by its coordinates, of features this part of the radius in size, faded under a pixel; with its gradient.
struct SurfaceNoise {
  double f = 0;
  Vec3 gradient{0.0};
};
SurfaceNoise surface_noise(const Contribution& c, double size, double elongation, double footprint, std::uint64_t seed) {
  const auto period = static_cast<std::uint32_t>(std::clamp(2 * std::numbers::pi / size, 4.0, 4096.0));
  // Not v / radius, which would shear along a taper.
  const double metres = size * elongation * std::exp2(std::floor(std::log2(std::max(1e-6, c.radius))));
  const double kept = 1 - smooth(0.25, 1.0, footprint / (c.radius * size));
  if (!(kept > 0)) return {};
  const NoiseAt at = noise_at(c.u * period, c.v / metres, period, static_cast<std::uint32_t>(seed));
  return {kept * at.f, kept * (at.by_x * period * c.u_gradient + at.by_y / metres * c.v_gradient)};
}

/// Distance from the axis in surface radii, back from the field value of an unblended primitive.
double radii_from_axis(double weight) {
  return kSupportPerRadius * std::sqrt(std::max(0.0, 1 - std::cbrt(std::clamp(weight, 0.0, 1.0))));
}

/// How far a check, a crack from drying, is open here: a few thin wedges from the pith, each with a reach of its own.
double check_in_wood(double u, double from_axis, double pixel, std::uint64_t seed) {
  constexpr std::uint32_t kSectors = 5;
  const double wander = 0.10 * (bark_noise(u * 9, 7 * from_axis, 9, seed ^ 54) - 0.5);
  const double sector = u * kSectors + wander;
  const std::uint64_t which = wrapped_column(cell_of(sector), kSectors);
  const double reach = unit_of(hash_of(seed, 71, which));
  if (reach < 0.45) return 0;
  const double middle = 0.3 + 0.4 * unit_of(hash_of(seed, 72, which));
  const double away = std::abs(sector - std::floor(sector) - middle) / kSectors * 2 * std::numbers::pi * from_axis;
  const double half_width = 0.022 * std::max(0.0, 1 - from_axis / reach);
  return half_width > 0 ? half_width / (half_width + pixel) * smooth(half_width + pixel, 0.0, away) : 0;
}

/// Sawn wood: pale, with growth rings that darken to the late wood, checks, a dark pith and the bark seen end on.
Vec3 sawn_wood(const Contribution& c, double footprint, std::uint64_t seed) {
  const double from_axis = radii_from_axis(c.weight), pixel = footprint / c.radius;
  const double wobble = 0.045 * (bark_noise(c.u * 5, 3 * from_axis, 5, seed ^ 51) - 0.5) * smooth(0.0, 0.3, from_axis);
  // Narrow and wide years: the rings are evenly spaced in a slowly varying measure of the radius.
  const double rings = std::clamp(std::round(c.radius / 0.0026), 6.0, 40.0), out = std::clamp(from_axis + wobble, 0.0, 1.2);
  const double x = rings * (std::pow(out, 0.85) + 0.6 / rings * bark_noise(0, 0.45 * rings * out, 1, seed ^ 55));
  const double phase = x - std::floor(x), year = unit_of(hash_of(seed, static_cast<std::uint64_t>(x)));
  const double kept = 1 - smooth(0.3, 1.0, pixel * rings);
  const double late = kept * (0.45 + 0.55 * year) * smooth(0.30, 0.90, phase) * smooth(1.0, 0.94, phase) + (1 - kept) * 0.27;
  const double rays = 0.95 + 0.10 * bark_noise(c.u * 64, 3 * from_axis, 64, seed ^ 52);
  const double stain = bark_noise(c.u * 5, 2.5 * from_axis, 5, seed ^ 53);
  Vec3 color = glm::mix(Vec3(0.43, 0.320, 0.195), Vec3(0.215, 0.130, 0.066), late) * (rays * (0.84 + 0.32 * stain));
  color = glm::mix(color, Vec3(0.26, 0.170, 0.095), 0.45 * smooth(0.50, 0.25, from_axis + 2 * wobble));   // heartwood
  color = glm::mix(color, Vec3(0.085, 0.060, 0.040), 0.9 * check_in_wood(c.u, from_axis, pixel, seed));
  color = glm::mix(color, Vec3(0.12, 0.08, 0.05), smooth(0.055, 0.02, from_axis));                // pith
  color = glm::mix(color, Vec3(0.25, 0.17, 0.09), 0.8 * smooth(0.865, 0.89, from_axis));         // bast
  return glm::mix(color, Vec3(0.085, 0.066, 0.05), smooth(0.91, 0.94, from_axis));                // the bark seen end on
}

/// A branch bark ridge: bark crumpled into a dark line, with folds across it. On white bark it is the black brow over a branch.
void show_ridge(const Contribution& main, const BarkMaterial& material, double ridge, double footprint, std::uint64_t seed,
                BarkLook& look, Vec3& relief_gradient) {
  const SurfaceNoise folds = surface_noise(main, 0.14, 0.5, footprint, seed ^ 61), fine = surface_noise(main, 0.05, 0.6, footprint, seed ^ 62);
  const double at = ridge + 0.22 * folds.f + 0.12 * fine.f;
  const bool brow = material.style == BarkStyle::kBirch;
  const double swollen = smooth(0.30, 0.85, at), line = brow ? smooth(0.16, 0.42, at) : smooth(0.66, 0.96, at);
  const Vec3 dark = material.texture ? Vec3(0.040, 0.031, 0.024) : 0.6 * material.crack_color;
  look.albedo = glm::mix(look.albedo, look.albedo * Vec3(0.66, 0.58, 0.49) * (1 + 0.5 * folds.f + 0.5 * fine.f), swollen);
  look.albedo = glm::mix(look.albedo, glm::min(dark, Vec3(0.06)) * (1 + fine.f), 0.85 * line);
  look.roughness = glm::mix(look.roughness, 0.95, swollen);
  look.height = glm::mix(look.height, 0.55, line);
  relief_gradient += swollen * main.radius * (0.05 * folds.gradient + 0.018 * fine.gradient);
}

/// An old scar: grey weathered wood, checked, within a roll of young bark.
void show_scar(const Contribution& main, double dent, double footprint, std::uint64_t seed, BarkLook& look, Vec3& relief_gradient) {
  const SurfaceNoise coarse = surface_noise(main, 0.25, 1, footprint, seed ^ 63), grain = surface_noise(main, 0.035, 3.5, footprint, seed ^ 64);
  const double at = dent + 0.10 * coarse.f;
  const double callus = smooth(0.06, 0.20, at) * smooth(0.55, 0.40, at), wood = smooth(0.46, 0.56, at);
  const double rim = smooth(0.36, 0.46, at) * smooth(0.60, 0.52, at);
  look.albedo = glm::mix(look.albedo, glm::mix(look.albedo, Vec3(0.25, 0.22, 0.17), 0.6) * (1 + 0.35 * coarse.f), callus);
  look.albedo = glm::mix(look.albedo, Vec3(0.215, 0.200, 0.180) * (1 + 0.9 * grain.f + 0.3 * coarse.f), wood);
  look.albedo *= 1 - 0.65 * rim;
  look.roughness = glm::mix(look.roughness, 0.9, std::max(callus, wood));
  look.height = glm::mix(look.height, 0.9, std::max(callus, wood));
  relief_gradient *= 1 - 0.85 * std::max(callus, wood);
  relief_gradient += wood * 0.02 * main.radius * grain.gradient + callus * 0.03 * main.radius * coarse.gradient;
}

}  // namespace

void show_wounds(const Contribution& main, const BarkMaterial& material, const SurfaceTraits& traits, double footprint,
                 std::uint64_t seed, BarkLook& look, Vec3& relief_gradient) {
  const std::uint64_t own = hash_of(seed, main.branch);
  if (traits.ridge > 0) show_ridge(main, material, std::min(1.0, traits.ridge), footprint, own, look, relief_gradient);
  if (traits.dent > 0) show_scar(main, std::min(1.0, traits.dent), footprint, own, look, relief_gradient);
  if (traits.cut > 0) {
    const double cut = std::min(1.0, traits.cut);
    look.albedo = glm::mix(look.albedo, sawn_wood(main, footprint, own), cut);
    look.roughness = glm::mix(look.roughness, 0.75, cut);
    look.height = glm::mix(look.height, 1.0, cut);
    look.relief *= 1 - cut;
    relief_gradient *= 1 - cut;
  }
}

}  // namespace cambium
