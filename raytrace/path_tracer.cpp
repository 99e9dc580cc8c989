#include "raytrace/path_tracer.h"

#include "raytrace/bark_noise.h"

#include <algorithm>
#include <cmath>

namespace cambium {
namespace {

// Shadow rays start this far off the surface: far above the root's 1e-6, far below what an eye sees.
constexpr double kOffsetRadii = 3e-4;

/// Trampled soil and grass: two octaves of world-space mottling that fade before they alias.
double mottle(const Vec3& p, double footprint) {
  double sum = 0, amplitude = 0.10;
  for (double size : {0.9, 0.23, 0.06}) {
    const double kept = std::clamp(1.2 - footprint / (0.8 * size), 0.0, 1.0);
    sum += amplitude * kept * (2 * bark_noise(p.x / size, p.y / size, 1u << 20, 0x5eed) - 1);
    amplitude *= 0.8;
  }
  return 1 + sum;
}

}  // namespace

PathTracer::PathTracer(const Tracer& tracer, const Bark& bark, const Light& light, std::optional<Ground> ground,
                       double pixel_angle)
    : tracer_(tracer), bark_(bark), lighting_(light), ground_color_(light.ground_color), ground_(ground),
      pixel_angle_(pixel_angle) {}

CameraSample PathTracer::sample(Evaluator& evaluator, const Ray& ray, const PixelSampler& sampler, std::uint32_t index) const {
  const auto hit = tracer_.intersect(evaluator, ray);
  double to_ground = kInfinity;
  if (ground_ && ray.direction.z < 0 && ray.origin.z > ground_->height) {
    to_ground = (ground_->height - ray.origin.z) / ray.direction.z;
  }
  if (hit && hit->t <= to_ground) return on_surface(evaluator, ray, *hit, sampler, index);
  if (to_ground < kInfinity) return on_ground(evaluator, ray, to_ground, sampler, index);
  CameraSample out;
  out.direct = lighting_.background(ray.direction);
  out.rays = 1;
  return out;
}

Vec3 PathTracer::sky_from(Evaluator& evaluator, const Vec3& p, const Vec3& normal, const std::array<double, 2>& sample) const {
  const Ray ray{p, cosine_direction(normal, sample)};
  return tracer_.occluded(evaluator, ray) ? lighting_.hidden() : lighting_.sky(ray.direction);
}

CameraSample PathTracer::on_surface(Evaluator& evaluator, const Ray& ray, const SurfaceHit& hit, const PixelSampler& sampler,
                                 std::uint32_t index) const {
  const PrunedField field = tracer_.cover().field(hit.cell);
  const Vec3 p = glm::clamp(ray.at(hit.t), field.box().lo, field.box().hi);
  const Sample gradient = evaluator.sample(field, p);
  const double steepness = glm::length(gradient.gradient);
  CameraSample out;
  out.normal = steepness > 0 ? -gradient.gradient / steepness : -ray.direction;
  out.depth = hit.t;
  out.position = p;
  out.rays = 2;

  const double footprint = hit.t * pixel_angle_;
  const BarkLook look = bark_.look(evaluator, field, p, out.normal, footprint);
  out.albedo = look.albedo;
  out.branch = look.branch;
  out.order = look.order;
  out.ridge = look.ridge;
  out.uv = look.uv;

  const double radius = field.smallest_radius() < kInfinity ? field.smallest_radius() : glm::length(field.box().size());
  const Vec3 start = p + kOffsetRadii * radius * out.normal;
  // A crack's floor sees less sky than the plates around it.
  const double open = 0.45 + 0.55 * look.height;
  out.ambient = open * sky_from(evaluator, start, out.normal, sampler.pair(index, Use::kSky));

  const Vec3 to_sun = lighting_.towards_sun(sampler.pair(index, Use::kSun));
  const double facing = glm::dot(out.normal, to_sun);
  // The bumped normal may not light what turns away: fade it in over the terminator.
  const double cosine = std::max(0.0, glm::dot(look.normal, to_sun)) * std::clamp(facing / 0.12, 0.0, 1.0);
  if (cosine > 0) {
    ++out.rays;
    if (!tracer_.occluded(evaluator, {start, to_sun})) out.direct = out.albedo * lighting_.sun_color() * cosine;
  }
  return out;
}

CameraSample PathTracer::on_ground(Evaluator& evaluator, const Ray& ray, double t, const PixelSampler& sampler,
                                std::uint32_t index) const {
  CameraSample out;
  const Vec3 p{ray.at(t).x, ray.at(t).y, ground_->height};
  out.rays = 1;
  out.depth = t;
  out.position = p;
  out.normal = {0, 0, 1};
  const double haze = 1 - std::exp(-std::pow(t / ground_->fade, 1.5));
  const double footprint = t * pixel_angle_ / std::max(0.02, -ray.direction.z);
  out.albedo = ground_color_ * mottle(p, footprint);
  Vec3 level = ray.direction;
  level.z = 0;
  out.direct = haze * lighting_.background(glm::normalize(level + Vec3(0, 0, 1e-6)));
  if (haze > 0.995) {
    out.ambient = Vec3(0.0);
    return out;
  }
  out.ambient = (1 - haze) * sky_from(evaluator, p, out.normal, sampler.pair(index, Use::kSky));
  const Vec3 to_sun = lighting_.towards_sun(sampler.pair(index, Use::kSun));
  out.rays = 2;
  if (to_sun.z > 0) {
    ++out.rays;
    if (!tracer_.occluded(evaluator, {p, to_sun})) out.direct += (1 - haze) * out.albedo * lighting_.sun_color() * to_sun.z;
  }
  return out;
}

}  // namespace cambium
