#include "raytrace/path_tracer.h"

#include "blobtree/input_error.h"
#include "raytrace/tone.h"

#include <algorithm>
#include <cmath>
#include <string>

namespace cambium {
namespace {

// A pixel is drawn out over bark that is seen at a grazing angle, but not without end.
constexpr double kLeastFacing = 0.06;
constexpr double kFullHaze = 0.995;
constexpr int kCatcherRays = 4;      // to the sky, for each sample of a shadow that no smoothing will see
constexpr int kSureBounces = 3;      // before chance may end a path
constexpr double kBounceFootprint = 0.3;   // of a bounce's length: what one of its rays stands for on the surface it meets

/// How much of the light around the bark's relief lets in: a crack's floor sees less of it than the plates at its sides.
double open_share(const BarkLook& look) { return 0.45 + 0.55 * look.height; }

const PathOptions& checked(const PathOptions& options) {
  if (options.bounces < 0 || options.bounces > kMostBounces) {
    throw InputError({}, std::to_string(options.bounces) + " bounces", "0 to " + std::to_string(kMostBounces));
  }
  if (!(options.clamp > 0)) throw InputError({}, "a clamp of " + std::to_string(options.clamp), "more than 0");
  if (!(options.occlusion_distance > 0)) {
    throw InputError({}, "an occlusion distance of " + std::to_string(options.occlusion_distance), "more than 0 metres");
  }
  return options;
}

Vec3 bounded(const Vec3& light, double most) {
  const double bright = luminance(light);
  return bright > most ? light * (most / bright) : light;
}

}  // namespace

PathTracer::PathTracer(const Tracer& tracer, const Bark& bark, const Light& light, std::optional<Ground> ground,
                       double pixel_angle, const PathOptions& options, const FoliageTracer* foliage)
    : tracer_(tracer), foliage_(foliage), bark_(bark), lights_(light), ground_color_(light.ground_color), catcher_(light.catcher),
      transparent_(light.backdrop == Backdrop::kTransparent), ground_(ground), pixel_angle_(pixel_angle),
      options_(checked(options)) {}

PathTracer::Met PathTracer::meet(Walk& walk, const Ray& ray) const {
  ++walk.rays;
  const double to_ground = ground_ ? cambium::meet(*ground_, ray) : kInfinity;
  const auto hit = tracer_.intersect(walk.evaluator, ray);
  const Met met = hit && hit->t <= to_ground ? Met{hit->t, hit} : Met{to_ground, std::nullopt};
  const auto leaf = foliage_ ? foliage_->intersect(ray, met.t) : std::nullopt;
  return leaf ? Met{leaf->t, std::nullopt, leaf} : met;
}

bool PathTracer::blocked(Walk& walk, const Ray& ray, double distance) const {
  if (ground_ && cambium::meet(*ground_, ray) < distance) return true;
  ++walk.rays;
  return (foliage_ && foliage_->occluded(ray, distance)) || tracer_.occluded(walk.evaluator, ray, distance);
}

/// The tree's surface where it was hit. With `seen`, as the camera sees it, and what it sees is noted there.
PathTracer::Vertex PathTracer::bark_vertex(Walk& walk, const Ray& ray, const SurfaceHit& hit, double footprint,
                                           CameraSample* seen) const {
  const PrunedField field = tracer_.cover().field(tracer_.cell(ray, hit));
  const Vec3 p = glm::clamp(ray.at(hit.t), field.box().lo, field.box().hi);
  Vec3 normal = hit.normal;
  const bool fine = seen && options_.relief;
  const double covered = footprint / std::max(kLeastFacing, -glm::dot(normal, ray.direction));
  const BarkLook look = fine ? bark_.look(walk.evaluator, field, p, normal, covered) : bark_.glance(walk.evaluator, field, p, covered);
  if (seen) {
    seen->normal = normal;
    seen->position = p;
    seen->depth = hit.t;
    seen->uv = look.uv;
    seen->branch = look.branch;
    seen->order = look.order;
    seen->ridge = look.ridge;
  }
  // On the very rim, rounding may show the surface from behind.
  if (glm::dot(normal, ray.direction) > 0) normal = glm::normalize(normal - glm::dot(normal, ray.direction) * ray.direction);
  return {off_surface(ray, hit), Bsdf({normal, fine ? look.normal : normal, look.albedo, look.roughness}, -ray.direction),
          options_.relief ? open_share(look) : 1};
}

/// Either side of a leaf, likewise.
PathTracer::Vertex PathTracer::leaf_vertex(const Ray& ray, const FoliageHit& hit, double footprint, CameraSample* seen) const {
  const FoliageLook look = foliage_->look(ray, hit, footprint);
  if (seen) {
    seen->normal = look.normal;
    seen->position = look.position;
    seen->depth = hit.t;
    seen->uv = look.uv;
    seen->branch = look.branch;
    seen->leaf = true;
  }
  const Vec3 off = foliage_->lift() * look.normal;
  const double through = look.material->translucency;
  return {look.position + off,
          Bsdf({look.normal, look.shading_normal, (1 - through) * look.color, look.material->roughness, true, through * look.color},
               -ray.direction),
          1, -2.0 * off};
}

PathTracer::Vertex PathTracer::ground_vertex(const Ray& ray, double t, double footprint) const {
  const Vec3 p{ray.at(t).x, ray.at(t).y, ground_->height}, up{0, 0, 1};
  return {p, Bsdf({up, up, ground_color_ * mottle(p, footprint), 1, false}, -ray.direction)};
}

/// What a bounce met.
PathTracer::Vertex PathTracer::vertex(Walk& walk, const Ray& ray, const Met& met, double footprint) const {
  if (met.leaf) return leaf_vertex(ray, *met.leaf, footprint, nullptr);
  return met.tree ? bark_vertex(walk, ray, *met.tree, footprint, nullptr) : ground_vertex(ray, met.t, footprint);
}

/// One shadow ray to each light that has a place: sun, lamps, and an environment by its brightness.
PathTracer::Lit PathTracer::light_samples(Walk& walk, const Vertex& vertex, int depth) const {
  Lit lit;
  const auto add = [&](const LightSample& light, bool met_by_rays, Vec3 Parts::*part) {
    if (!(light.pdf > 0)) return;
    const Vec3 value = vertex.bsdf.value(light.direction);
    if (value == Vec3(0.0)) return;
    const double weight = met_by_rays ? mis_weight(light.pdf, vertex.bsdf.pdf(light.direction)) : 1;
    Parts& parts = blocked(walk, vertex.towards(light.direction), light.distance) ? lit.missing : lit.reaching;
    parts.*part += weight / light.pdf * value * light.radiance;
  };
  if (lights_.sunlit()) add(lights_.sun(walk.pair(Use::kSun, depth)), false, &Parts::sharp);
  for (std::size_t i = 0; i < lights_.lamps().size(); ++i) {
    add(lights_.lamps()[i].sample(vertex.start, walk.pair(Use::kLamp, depth, i)), true, &Parts::sharp);
  }
  if (const Environment* around = lights_.environment()) {
    add(around->sample_spots(walk.pair(Use::kSpot, depth)), false, &Parts::sharp);
    add(around->sample_even(walk.pair(Use::kAround, depth)), true, &Parts::soft);
  }
  return lit;
}

/// What a ray drawn with that pdf brings from lamps before t and, where t is infinite, from all around: the share that light
/// samples leave to it.
Vec3 PathTracer::emitted(const Ray& ray, double pdf, double t) const {
  Vec3 light(0.0);
  for (const Lamp& lamp : lights_.lamps()) {
    const auto met = lamp.met(ray);
    if (met && met->distance < t) light += mis_weight(pdf, met->pdf) * met->radiance;
  }
  if (t < kInfinity) return light;
  const Environment* around = lights_.environment();
  return light + (around ? mis_weight(pdf, around->even_pdf(ray.direction)) : 1) * lights_.around(ray.direction);
}

/// Light that comes to the vertex by rays of its own: from the sky, and from other surfaces by up to options.bounces of them.
Vec3 PathTracer::bounced(Walk& walk, Vertex at, double footprint, double& occlusion) const {
  Vec3 light(0.0), weight(1.0);
  for (int depth = 0;; ++depth) {
    const BsdfSample onward = at.bsdf.sample(walk.pair(Use::kOnward, depth));
    if (!(onward.pdf > 0)) break;
    const Ray ray = at.towards(onward.direction);
    const bool last = depth == options_.bounces;
    // Only the first needs to know how far it got; of the last, that it was stopped is enough.
    const bool brief = last && depth > 0 && lights_.lamps().empty();
    const Met met = brief ? Met{blocked(walk, ray, kInfinity) ? 0.0 : kInfinity, {}} : meet(walk, ray);
    if (depth == 0 && met.t < options_.occlusion_distance) occlusion = onward.cosine_share;
    weight *= onward.weight * at.open;
    light += weight * emitted(ray, onward.pdf, met.t);
    if (last || !(met.t < kInfinity)) break;
    footprint = std::max(footprint, kBounceFootprint * met.t);
    at = vertex(walk, ray, met, footprint);
    light += weight * light_samples(walk, at, depth + 1).reaching.all();
    if (depth < kSureBounces) continue;
    const double survival = std::min(0.95, std::max({weight.x, weight.y, weight.z}));
    if (!(walk.pair(Use::kRoulette, depth)[0] < survival)) break;
    weight /= survival;
  }
  return bounded(light, options_.clamp);
}

void PathTracer::shade(Walk& walk, const Vertex& vertex, double footprint, CameraSample& out) const {
  const Parts lit = light_samples(walk, vertex, 0).reaching;
  out.albedo = vertex.bsdf.reflectance();
  out.direct += lit.sharp;
  const Vec3 soft = bounded(vertex.open * lit.soft, options_.clamp) + bounced(walk, vertex, footprint, out.occlusion);
  for (int c = 0; c < 3; ++c) {
    if (out.albedo[c] > 0) out.ambient[c] = soft[c] / out.albedo[c];
  }
}

void PathTracer::see_tree(Walk& walk, const Ray& ray, const SurfaceHit& hit, CameraSample& out) const {
  const double footprint = hit.t * pixel_angle_;
  shade(walk, bark_vertex(walk, ray, hit, footprint, &out), footprint, out);
}

void PathTracer::see_leaf(Walk& walk, const Ray& ray, const FoliageHit& hit, CameraSample& out) const {
  const double footprint = hit.t * pixel_angle_;
  shade(walk, leaf_vertex(ray, hit, footprint, &out), footprint, out);
}

void PathTracer::see_ground(Walk& walk, const Ray& ray, double t, CameraSample& out) const {
  const double gone = haze(*ground_, t), footprint = t * pixel_angle_ / std::max(0.02, -ray.direction.z);
  const Vertex vertex = ground_vertex(ray, t, footprint);
  out.position = vertex.start;
  out.normal = {0, 0, 1};
  out.depth = t;
  if (gone < kFullHaze) shade(walk, vertex, footprint, out);
  const Vec3 horizon = lights_.backdrop(glm::normalize(Vec3(ray.direction.x, ray.direction.y, 1e-9)));
  out.direct = (1 - gone) * out.direct + gone * horizon;
  out.ambient *= 1 - gone;
  out.alpha = transparent_ ? 1 - gone : 1;
}

/// The backdrop, darkened by the share of light that the tree takes from the ground there.
void PathTracer::see_catcher(Walk& walk, const Ray& ray, double t, CameraSample& out) const {
  const Vec3 p{ray.at(t).x, ray.at(t).y, ground_->height}, up{0, 0, 1};
  const Vertex white{p, Bsdf({up, up, Vec3(1.0), 1, false}, -ray.direction)};
  const Lit lit = light_samples(walk, white, 0);
  Vec3 sharp = lit.missing.sharp, soft = lit.missing.soft;
  for (int i = 0; i < kCatcherRays; ++i) {
    const BsdfSample up_to = white.bsdf.sample(walk.sampler.pair(kCatcherRays * walk.index + i, Use::kOnward));
    const Ray sky{p, up_to.direction};
    if (!(up_to.pdf > 0) || !blocked(walk, sky, kInfinity)) continue;
    soft += up_to.weight * emitted(sky, up_to.pdf, kInfinity) / double(kCatcherRays);
  }
  double lamps = 0;   // what they give or would give here
  if (!lights_.lamps().empty()) lamps = luminance(lit.reaching.sharp + lit.missing.sharp);
  const double whole = std::max(1e-12, luminance(lights_.on_level_ground()) + lamps);
  const double sharp_share = luminance(lights_.sharp_on_level_ground()) / whole;
  const double sharp_left = sharp_share - luminance(sharp) / whole, soft_left = 1 - sharp_share - luminance(soft) / whole;
  if (transparent_) {
    out.alpha = 1 - sharp_left - soft_left;
    return;
  }
  out.albedo = lights_.backdrop(ray.direction);
  out.direct = sharp_left * out.albedo;
  out.ambient = Vec3(soft_left);
  out.position = p;
  out.normal = up;
  out.depth = t;
}

CameraSample PathTracer::sample(Evaluator& evaluator, const Ray& ray, const PixelSampler& sampler, std::uint32_t index) const {
  Walk walk{evaluator, sampler, index};
  CameraSample out;
  const Met met = meet(walk, ray);
  if (met.leaf) {
    see_leaf(walk, ray, *met.leaf, out);
  } else if (met.tree) {
    see_tree(walk, ray, *met.tree, out);
  } else if (met.t < kInfinity) {
    catcher_ ? see_catcher(walk, ray, met.t, out) : see_ground(walk, ray, met.t, out);
  } else {
    out.direct = lights_.backdrop(ray.direction) + lights_.sun_disc(ray.direction);
    out.alpha = transparent_ ? 0 : 1;
  }
  for (const Lamp& lamp : lights_.lamps()) {
    const auto seen = lamp.visible() ? lamp.met(ray) : std::nullopt;
    if (seen && seen->distance < met.t) out.direct += seen->radiance;
  }
  out.rays = walk.rays;
  return out;
}

}  // namespace cambium
