#include "raytrace/bark.h"

#include "raytrace/bark_texture.h"
#include "raytrace/bark_wounds.h"
#include "blobtree/place_hash.h"

#include <algorithm>
#include <cmath>
#include <utility>

namespace cambium {
namespace {

/// Steeper relief than this is shaded as if it were this steep: a normal map cannot hide what is behind a step.
constexpr double kSteepest = 1.4;

/// A primitive whose field is a smaller part than this of the largest is left out: it would cost as much as all the others.
constexpr double kNegligible = 0.05;

/// How the outer colour changes where a pattern is warm by 1.
constexpr Vec3 kWarmth(0.16, 0.01, -0.15);

std::vector<Contribution>& scratch() {
  thread_local std::vector<Contribution> contributions;
  return contributions;
}

/// One primitive's bark, before blending.
struct Layer {
  Vec3 albedo{0.0};
  double roughness = 0.85, height = 1, relief = 0;
  Vec3 relief_gradient{0.0};
};

Vec3 pattern_color(const BarkMaterial& m, double outer, double inner, double warm, double young) {
  const Vec3 color = young > 0 ? glm::mix(m.color, m.young_color.value_or(m.color), young) : m.color;
  return glm::max(Vec3(0.0), color * (Vec3(outer) + warm * kWarmth) + inner * m.crack_color);
}

template <BarkNumber N>
Layer patterned(const BarkMaterial& m, const Contribution& c, std::uint64_t seed, double footprint) {
  N u, v;
  if constexpr (std::same_as<N, Sloped>) {
    u = {c.u, 1, 0};
    v = {c.v, 0, 1};
  } else {
    u = c.u;
    v = c.v;
  }
  const auto texel = bark_pattern<N>({m.style, m.scale, m.mature_radius, hash_of(seed, c.branch)}, u, v, c.radius, footprint);
  Layer layer{pattern_color(m, texel.outer, texel.inner, texel.warm, texel.young), texel.roughness, texel.height,
              value_of(texel.relief), Vec3(0.0)};
  if constexpr (std::same_as<N, Sloped>) layer.relief_gradient = texel.relief.u * c.u_gradient + texel.relief.v * c.v_gradient;
  return layer;
}

Layer textured(const BarkMaterial& m, const Contribution& c, double footprint) {
  const BarkMaps maps{*m.texture, m.normal_map.get(), m.roughness_map.get(), m.texture_size * m.scale};
  const MappedBark mapped = maps.at(c.u, c.v, c.radius, footprint);
  Layer layer{mapped.albedo, mapped.roughness, 1, 0, Vec3(0.0)};
  const double turns_per_metre = glm::length(c.u_gradient);
  if (turns_per_metre > 0) layer.relief_gradient = (mapped.slope.x / turns_per_metre) * c.u_gradient + mapped.slope.y * c.v_gradient;
  return layer;
}

/// The surface's normal as relief of this gradient tilts it.
Vec3 tilted(const Vec3& normal, const Vec3& gradient) {
  const Vec3 along = gradient - glm::dot(gradient, normal) * normal;
  const double slope = glm::length(along);
  return glm::normalize(normal - (slope > kSteepest ? kSteepest / slope : 1.0) * along);
}

}  // namespace

std::vector<BarkMaterial> poplar_bark() {
  const Vec3 olive(0.275, 0.280, 0.195);
  const BarkMaterial trunk{.style = BarkStyle::kRidged, .color = {0.270, 0.235, 0.195}, .crack_color = {0.060, 0.047, 0.036},
                           .young_color = olive};
  const BarkMaterial branch{.style = BarkStyle::kSmooth, .color = olive, .crack_color = {0.120, 0.095, 0.060}};
  const BarkMaterial twig{.style = BarkStyle::kSmooth, .color = {0.250, 0.120, 0.062}, .crack_color = {0.420, 0.300, 0.190}, .scale = 0.7};
  return {trunk, branch, twig};
}

Bark::Bark(std::vector<BarkMaterial> by_order, std::uint64_t seed)
    : by_order_(by_order.empty() ? poplar_bark() : std::move(by_order)), seed_(seed) {}

const BarkMaterial& Bark::material(std::uint32_t order) const {
  return by_order_[std::min<std::size_t>(order, by_order_.size() - 1)];
}

BarkLook Bark::look(Evaluator& evaluator, const PrunedField& field, const Vec3& p, const Vec3& normal, double footprint) const {
  evaluator.contributions(field, p, scratch());
  return look(scratch(), evaluator.surface_traits(field, p), normal, footprint);
}

BarkLook Bark::glance(Evaluator& evaluator, const PrunedField& field, const Vec3& p, double footprint) const {
  evaluator.contributions(field, p, scratch());
  return glance(scratch(), evaluator.surface_traits(field, p), footprint);
}

BarkLook Bark::look(std::span<const Contribution> contributions, const SurfaceTraits& traits, const Vec3& normal,
                    double footprint) const {
  Vec3 gradient(0.0);
  BarkLook out = blended<Sloped>(contributions, traits, footprint, gradient);
  out.normal = tilted(normal, gradient);
  return out;
}

BarkLook Bark::glance(std::span<const Contribution> contributions, const SurfaceTraits& traits, double footprint) const {
  Vec3 none(0.0);
  return blended<double>(contributions, traits, footprint, none);
}

template <BarkNumber N>
BarkLook Bark::blended(std::span<const Contribution> contributions, const SurfaceTraits& traits, double footprint,
                       Vec3& relief_gradient) const {
  const Contribution* main = nullptr;
  for (const Contribution& c : contributions) {
    if (c.weight > 0 && (!main || c.weight > main->weight)) main = &c;
  }
  BarkLook out;
  if (!main) {
    out.albedo = by_order_[0].color;
    return out;
  }
  Layer sum{Vec3(0.0), 0, 0, 0, Vec3(0.0)};
  double total = 0;
  Vec3 total_gradient(0.0), reweighed(0.0);   // of the weights, and of the blend as they change
  for (const Contribution& c : contributions) {
    const double share = c.weight / main->weight, over = share - kNegligible;
    if (!(over > 0)) continue;
    const BarkMaterial& m = material(c.order);
    const Layer layer = m.texture ? textured(m, c, footprint) : patterned<N>(m, c, seed_, footprint);
    const double weight = over * over * over;
    sum.albedo += weight * layer.albedo;
    sum.roughness += weight * layer.roughness;
    sum.height += weight * layer.height;
    sum.relief += weight * layer.relief;
    total += weight;
    if constexpr (std::same_as<N, Sloped>) {
      const Vec3 gradient = (3 * over * over / main->weight) * (c.weight_gradient - share * main->weight_gradient);
      sum.relief_gradient += weight * layer.relief_gradient;
      reweighed += layer.relief * gradient;
      total_gradient += gradient;
    }
  }
  out.albedo = sum.albedo / total;
  out.roughness = sum.roughness / total;
  out.height = sum.height / total;
  out.relief = sum.relief / total;
  relief_gradient = (sum.relief_gradient + reweighed - out.relief * total_gradient) / total;
  out.ridge = traits.ridge;
  out.branch = main->branch;
  out.order = main->order;
  out.uv = {main->u, main->v};
  if (traits.ridge > 0 || traits.dent > 0 || traits.cut > 0)
    show_wounds(*main, material(main->order), traits, footprint, seed_, out, relief_gradient);
  out.albedo = glm::clamp(out.albedo, 0.0, 0.95);
  out.roughness = std::clamp(out.roughness, 0.05, 1.0);
  return out;
}

std::shared_ptr<const TextureImage> load_texture(const std::filesystem::path& path, TextureUse use) {
  return std::make_shared<const TextureImage>(read_pixels(path), use);
}

}  // namespace cambium
