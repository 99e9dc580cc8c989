#include "raytrace/bark.h"

#include "raytrace/bark_pattern.h"
#include "raytrace/hash.h"
#include "raytrace/texture_image.h"

#include <algorithm>
#include <cmath>
#include <numbers>
#include <utility>

namespace cambium {
namespace {

double smooth(double lo, double hi, double x) {
  const double t = std::clamp((x - lo) / (hi - lo), 0.0, 1.0);
  return t * t * (3 - 2 * t);
}

/// The texture goes round a whole number of times, and that number may not jump along a tapering branch: the two neighbouring
/// powers of two are faded over.
Vec3 textured(const BarkMaterial& material, const Contribution& c, double footprint) {
  const TextureImage& image = *material.texture;
  const double size = std::max(1e-6, material.texture_size * material.scale);
  const double turns = 2 * std::numbers::pi * c.radius / (size * image.aspect());
  const double level = std::log2(std::clamp(turns, 1.0, 1024.0));
  const double whole = std::floor(level), weight = smooth(0.35, 0.65, level - whole);
  const double pixels = footprint / size;
  const Vec3 few = image.lookup(c.u * std::exp2(whole), c.v / size, pixels);
  return weight <= 0 ? few : glm::mix(few, image.lookup(c.u * std::exp2(whole + 1), c.v / size, pixels), weight);
}

/// Distance from the axis in surface radii, back from the field value of an unblended primitive.
double radii_from_axis(double weight) {
  return kSupportPerRadius * std::sqrt(std::max(0.0, 1 - std::cbrt(std::clamp(weight, 0.0, 1.0))));
}

/// Sawn wood: pale, with growth rings that darken to the late wood and a dark pith.
Vec3 wood(const Contribution& c, double footprint, std::uint64_t seed) {
  const double from_axis = radii_from_axis(c.weight);
  const double wobble = 0.012 * (bark_noise(c.u * 6, 3 * from_axis, 6, seed ^ 51) - 0.5);
  const double rings = std::clamp(std::round(c.radius / 0.004), 5.0, 24.0);
  const double x = std::pow(std::clamp(from_axis + wobble, 0.0, 1.2), 0.85) * rings, phase = x - std::floor(x);
  const double kept = 1 - smooth(0.3, 1.0, footprint * rings / c.radius);
  const double late = kept * smooth(0.35, 0.95, phase) * (1 - smooth(0.95, 1.0, phase)) + (1 - kept) * 0.4;
  const double ray = 0.94 + 0.12 * bark_noise(c.u * 48, 4 * from_axis, 48, seed ^ 52);
  Vec3 color = glm::mix(Vec3(0.62, 0.47, 0.29), Vec3(0.40, 0.25, 0.125), 0.75 * late) * ray;
  color = glm::mix(color, Vec3(0.40, 0.27, 0.14), 0.55 * (1 - smooth(0.15, 0.45, from_axis)));   // heartwood
  color = glm::mix(color, Vec3(0.16, 0.10, 0.06), 1 - smooth(0.02, 0.05, from_axis));            // pith
  return glm::mix(color, Vec3(0.11, 0.085, 0.06), smooth(0.90, 0.95, from_axis));                // the bark seen end on
}

std::vector<Contribution>& scratch() {
  thread_local std::vector<Contribution> contributions;
  return contributions;
}

}  // namespace

std::vector<BarkMaterial> poplar_bark() {
  BarkMaterial trunk{BarkStyle::kRidged, {0.270, 0.235, 0.195}, {0.060, 0.047, 0.036}, 1, nullptr, 0.3};
  BarkMaterial branch{BarkStyle::kSmooth, {0.275, 0.280, 0.195}, {0.120, 0.095, 0.060}, 1, nullptr, 0.3};
  BarkMaterial twig{BarkStyle::kSmooth, {0.250, 0.120, 0.062}, {0.420, 0.300, 0.190}, 0.7, nullptr, 0.3};
  return {trunk, branch, twig};
}

Bark::Bark(std::vector<BarkMaterial> by_order, std::uint64_t seed)
    : by_order_(by_order.empty() ? poplar_bark() : std::move(by_order)), seed_(seed) {}

const BarkMaterial& Bark::material(std::uint32_t order) const {
  return by_order_[std::min<std::size_t>(order, by_order_.size() - 1)];
}

BarkLook Bark::look(Evaluator& evaluator, const PrunedField& field, const Vec3& p, const Vec3& normal, double footprint) const {
  BarkLook out = glance(evaluator, field, p, footprint);
  out.normal = shading_normal(evaluator, field, p, normal, footprint);
  return out;
}

BarkLook Bark::glance(Evaluator& evaluator, const PrunedField& field, const Vec3& p, double footprint) const {
  std::vector<Contribution>& contributions = scratch();
  evaluator.contributions(field, p, contributions);
  return glance(contributions, evaluator.surface_traits(field, p), footprint);
}

BarkLook Bark::glance(std::span<const Contribution> contributions, const SurfaceTraits& traits, double footprint) const {
  BarkLook out;
  out.height = 0;
  double total = 0;
  const Contribution* main = nullptr;
  for (const Contribution& c : contributions) {
    if (!(c.weight > 0)) continue;
    const BarkMaterial& m = material(c.order);
    const BarkTexel texel = bark_pattern(m.style, m.scale, c.u, c.v, c.radius, hash_of(seed_, c.branch), footprint);
    Vec3 color;
    if (m.texture) {
      color = textured(m, c, footprint);
    } else {
      color = glm::mix(m.crack_color, m.color * texel.shade, texel.height);
      color = glm::mix(color, m.crack_color, texel.mark);
    }
    out.albedo += c.weight * color;
    out.height += c.weight * texel.height;
    out.relief += c.weight * texel.height * bark_depth(m.style) * c.radius;
    total += c.weight;
    if (!main || c.weight > main->weight) main = &c;
  }
  if (!main) {
    out.albedo = by_order_[0].color;
    out.height = 1;
    return out;
  }
  out.branch = main->branch;
  out.order = main->order;
  out.uv = {main->u, main->v};
  out.ridge = traits.ridge;
  out.albedo /= total;
  out.height /= total;
  out.relief /= total;

  const double grain = 0.9 + 0.2 * bark_noise(main->u * 24, main->v / std::max(main->radius, 1e-6) * 3, 24, seed_ ^ 61);
  if (traits.ridge > 0) out.albedo = glm::mix(out.albedo, out.albedo * Vec3(0.52, 0.43, 0.33), std::min(1.0, traits.ridge));
  if (traits.dent > 0) {
    out.albedo = glm::mix(out.albedo, Vec3(0.20, 0.19, 0.175) * grain, std::min(1.0, traits.dent));
    out.relief *= 1 - 0.6 * std::min(1.0, traits.dent);
  }
  if (traits.cut > 0) {
    const double cut = std::min(1.0, traits.cut);
    out.albedo = glm::mix(out.albedo, wood(*main, footprint, hash_of(seed_, main->branch)), cut);
    out.height = glm::mix(out.height, 1.0, cut);
    out.relief *= 1 - cut;
  }
  out.albedo = glm::clamp(out.albedo, 0.0, 0.95);
  return out;
}

double Bark::relief_at(Evaluator& evaluator, const PrunedField& field, const Vec3& p, double footprint) const {
  std::vector<Contribution>& contributions = scratch();
  evaluator.contributions(field, p, contributions);
  double sum = 0, total = 0;
  for (const Contribution& c : contributions) {
    if (!(c.weight > 0)) continue;
    const BarkMaterial& m = material(c.order);
    const BarkTexel texel = bark_pattern(m.style, m.scale, c.u, c.v, c.radius, hash_of(seed_, c.branch), footprint);
    sum += c.weight * texel.height * bark_depth(m.style) * c.radius;
    total += c.weight;
  }
  return total > 0 ? sum / total : 0;
}

Vec3 Bark::shading_normal(Evaluator& evaluator, const PrunedField& field, const Vec3& p, const Vec3& normal,
                          double footprint) const {
  if (!(field.smallest_radius() < kInfinity)) return normal;
  // Half a pixel, but not below a hundredth of the girth's finest plates nor past the cell's own scale.
  const double step = std::clamp(0.5 * footprint, 2e-3 * field.smallest_radius(), 0.3 * field.smallest_radius());
  const Vec3 side = std::abs(normal.z) < 0.9 ? Vec3(0, 0, 1) : Vec3(1, 0, 0);
  const Vec3 s = glm::normalize(glm::cross(side, normal)), t = glm::cross(normal, s);
  // Just outside its box the pruned field lacks only what is about to fade in, so differences may reach across: turning them
  // round at the box would draw its outline on the bark.
  const double here = relief_at(evaluator, field, p, footprint);
  const double ds = (relief_at(evaluator, field, p + step * s, footprint) - here) / step;
  const double dt = (relief_at(evaluator, field, p + step * t, footprint) - here) / step;
  const double slope = std::hypot(ds, dt), limit = 1.1;
  const double scale = slope > limit ? limit / slope : 1;
  return glm::normalize(normal - scale * (ds * s + dt * t));
}

std::shared_ptr<const TextureImage> load_texture(const std::filesystem::path& path) {
  return std::make_shared<const TextureImage>(read_pixels(path));
}

}  // namespace cambium
