#include "raytrace/lights.h"

#include "blobtree/input_error.h"
#include "raytrace/directions.h"
#include "raytrace/tone.h"

#include <algorithm>
#include <cmath>
#include <numbers>

namespace cambium {
namespace {

constexpr double kPi = std::numbers::pi;
constexpr Vec3 kStudioSun{2.7, 2.45, 2.05};
constexpr double kWidestSun = 1.0;   // radians

double area_of(const AreaLight& light) {
  return light.shape == AreaLight::Shape::kRectangle ? light.width * light.height : kPi * light.radius * light.radius;
}

const AreaLight& checked(const AreaLight& light) {
  const bool extended = light.shape == AreaLight::Shape::kRectangle ? light.width > 0 && light.height > 0 : light.radius > 0;
  if (!extended) throw InputError({}, "a lamp without extent", "sides or a radius greater than 0");
  if (!(glm::length(light.direction) > 0)) throw InputError({}, "a lamp without direction", "a direction that is not zero");
  return light;
}

/// Of a cap of the unit sphere whose rim has this sine; exact for small ones, too.
double cap_solid_angle(double sine_squared) { return 2 * kPi * sine_squared / (1 + std::sqrt(std::max(0.0, 1 - sine_squared))); }

}  // namespace

Lamp::Lamp(const AreaLight& light) : light_(checked(light)), normal_(glm::normalize(light.direction)), area_(area_of(light)) {
  const Vec3 level = glm::cross(Vec3(0, 0, 1), normal_);
  across_ = glm::length(level) > 1e-9 ? glm::normalize(level) : Vec3(1, 0, 0);
  along_ = glm::cross(normal_, across_);
}

LightSample Lamp::sample(const Vec3& from, const std::array<double, 2>& sample) const {
  if (light_.shape == AreaLight::Shape::kSphere) return sample_sphere(from, sample);
  Vec3 offset = light_.width * (sample[0] - 0.5) * across_ + light_.height * (sample[1] - 0.5) * along_;
  if (light_.shape == AreaLight::Shape::kDisc) {
    const auto [x, y] = disc_point(sample);
    offset = light_.radius * (x * across_ + y * along_);
  }
  const Vec3 way = light_.position + offset - from;
  const double distance = glm::length(way);
  LightSample out{way / distance, distance, light_.radiance, 0};
  const double cosine = -glm::dot(out.direction, normal_);
  if (distance > 0 && cosine > 0) out.pdf = distance * distance / (area_ * cosine);
  return out;
}

std::optional<double> Lamp::cap_pdf(const Vec3& from) const {
  const Vec3 way = light_.position - from;
  const double sine_squared = light_.radius * light_.radius / glm::dot(way, way);
  if (!(sine_squared < 1)) return std::nullopt;   // from inside it does not shine
  return 1 / cap_solid_angle(sine_squared);
}

LightSample Lamp::sample_sphere(const Vec3& from, const std::array<double, 2>& sample) const {
  const auto pdf = cap_pdf(from);
  if (!pdf) return {};
  const Vec3 way = light_.position - from;
  const double far = glm::length(way), sine_squared = light_.radius * light_.radius / (far * far);
  // Even over the cap: the height above its rim's plane goes with the disc's squared radius.
  const auto [x, y] = disc_point(sample);
  const double r2 = x * x + y * y, below_top = r2 * sine_squared / (1 + std::sqrt(1 - sine_squared));
  const double cosine = 1 - below_top, sine = std::sqrt(std::max(0.0, below_top * (2 - below_top)));
  const double scale = r2 > 0 ? sine / std::sqrt(r2) : 0;
  const auto [s, t] = tangents(way / far);
  const Vec3 direction = glm::normalize(scale * (x * s + y * t) + cosine * way / far);
  const double middle = far * cosine, half_chord = std::sqrt(std::max(0.0, light_.radius * light_.radius - far * far * sine * sine));
  return {direction, middle - half_chord, light_.radiance, *pdf};
}

std::optional<LightSample> Lamp::met(const Ray& ray) const {
  if (light_.shape == AreaLight::Shape::kSphere) return met_sphere(ray);
  const double cosine = -glm::dot(ray.direction, normal_);
  if (!(cosine > 0)) return std::nullopt;
  const double t = glm::dot(ray.origin - light_.position, normal_) / cosine;
  if (!(t > 0)) return std::nullopt;
  const Vec3 offset = ray.at(t) - light_.position;
  const double x = glm::dot(offset, across_), y = glm::dot(offset, along_);
  const bool inside = light_.shape == AreaLight::Shape::kDisc
                          ? x * x + y * y <= light_.radius * light_.radius
                          : std::abs(x) <= 0.5 * light_.width && std::abs(y) <= 0.5 * light_.height;
  if (!inside) return std::nullopt;
  return LightSample{ray.direction, t, light_.radiance, t * t / (area_ * cosine)};
}

std::optional<LightSample> Lamp::met_sphere(const Ray& ray) const {
  const auto pdf = cap_pdf(ray.origin);
  if (!pdf) return std::nullopt;
  const Vec3 way = light_.position - ray.origin;
  const double along = glm::dot(way, ray.direction);
  const Vec3 aside = way - along * ray.direction;
  const double rest = light_.radius * light_.radius - glm::dot(aside, aside);
  if (!(along > 0 && rest >= 0)) return std::nullopt;
  return LightSample{ray.direction, along - std::sqrt(rest), light_.radiance, *pdf};
}

Lights::Lights(const Light& light)
    : light_(light), daylight_(light.turbidity, direction_of(light.sun_azimuth, light.sun_elevation)),
      sun_(direction_of(light.sun_azimuth, light.sun_elevation)) {
  if (light.sky == SkyKind::kEnvironment) {
    if (!light.environment) throw InputError({}, "an environment without image", "an image of the surroundings");
    environment_ = light.environment.get();
  }
  for (const AreaLight& lamp : light.area) lamps_.emplace_back(lamp);
  const double size = std::clamp(light.sun_size, 0.0, kWidestSun);
  const auto [s, t] = tangents(sun_);
  sun_s_ = s;
  sun_t_ = t;
  sun_tangent_ = std::tan(size);
  sun_cosine_ = std::cos(size);
  const bool day = light.sky == SkyKind::kDaylight;
  if (light.sun) {
    sun_color_ = light.sun_color.value_or(day ? daylight_sun(light.turbidity, light.sun_elevation, size) : kStudioSun);
  }
  sunlit_ = luminance(sun_color_) > 0;
  const Vec3 sun_on_level_ground = sun_color_ * std::max(0.0, sun_.z);
  on_level_ground_ = sun_on_level_ground + mean_sky();
  sharp_on_level_ground_ = sun_on_level_ground + (environment_ ? environment_->spots_on_level_ground() : Vec3(0.0));
}

LightSample Lights::sun(const std::array<double, 2>& sample) const {
  const auto [x, y] = disc_point(sample);
  // The irradiance is what counts, so the pdf may be that of a disc of any size.
  return {glm::normalize(sun_ + sun_tangent_ * (x * sun_s_ + y * sun_t_)), kInfinity, kPi * sun_color_, 1};
}

Vec3 Lights::sky(const Vec3& direction) const {
  if (environment_) return environment_->radiance(direction);
  if (light_.sky == SkyKind::kDaylight) return daylight_.radiance(direction);
  const double height = std::clamp(direction.z, 0.0, 1.0), glow = std::max(0.0, glm::dot(direction, sun_));
  return glm::mix(light_.sky_horizon, light_.sky_zenith, 1 - std::pow(1 - height, 2.6)) + 0.035 * sun_color_ * std::pow(glow, 12.0);
}

/// By cosine over the upper hemisphere.
Vec3 Lights::mean_sky() const {
  if (environment_) return environment_->on_level_ground();
  constexpr int kSide = 32;
  Vec3 sum(0.0);
  for (int i = 0; i < kSide * kSide; ++i) {
    sum += sky(cosine_direction({0, 0, 1}, {(i % kSide + 0.5) / kSide, (i / kSide + 0.5) / kSide}));
  }
  return sum / double(kSide * kSide);
}

Vec3 Lights::around(const Vec3& direction) const {
  if (environment_) return environment_->even_radiance(direction);
  // Over a narrow band, so that the horizon makes no edge in the shading.
  const double above = std::clamp(0.5 + direction.z / 0.1, 0.0, 1.0);
  if (above == 1) return sky(direction);
  return glm::mix(light_.ground_color * on_level_ground_, sky({direction.x, direction.y, std::max(0.0, direction.z)}), above);
}

Vec3 Lights::backdrop(const Vec3& direction) const {
  if (light_.backdrop == Backdrop::kTransparent) return Vec3(0.0);
  if (light_.backdrop == Backdrop::kColor) return light_.backdrop_color;
  return sky(direction);
}

Vec3 Lights::sun_disc(const Vec3& direction) const {
  const bool shown = light_.backdrop == Backdrop::kSky && light_.sky == SkyKind::kDaylight && sunlit_ && sun_cosine_ < 1;
  if (!shown || glm::dot(direction, sun_) < sun_cosine_) return Vec3(0.0);
  return sun_color_ / (1 - sun_cosine_ * sun_cosine_);
}

}  // namespace cambium
