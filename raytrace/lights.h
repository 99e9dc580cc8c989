// Everything that shines: sun, sky or surroundings, and lamps.
#pragma once

#include "raytrace/environment.h"
#include "raytrace/light.h"
#include "raytrace/ray_root.h"
#include "raytrace/sky.h"

#include <array>
#include <optional>
#include <vector>

namespace cambium {

/// One lamp, ready for sampling.
class Lamp {
 public:
  /// Errors: InputError for one without extent or direction.
  explicit Lamp(const AreaLight& light);

  /// A point of it, seen from `from`: evenly by area, of a sphere by solid angle. pdf 0 where it turns its back.
  LightSample sample(const Vec3& from, const std::array<double, 2>& sample) const;
  /// Where the ray meets its shining side, and sample()'s pdf of that direction.
  std::optional<LightSample> met(const Ray& ray) const;
  bool visible() const { return light_.visible; }

 private:
  LightSample sample_sphere(const Vec3& from, const std::array<double, 2>& sample) const;
  std::optional<LightSample> met_sphere(const Ray& ray) const;
  std::optional<double> cap_pdf(const Vec3& from) const;

  AreaLight light_;
  Vec3 normal_, across_, along_;   ///< unit and orthogonal
  double area_ = 0;
};

/// Share of the strategy with the first pdf, of two that both could have found a direction (Veach 1997, power heuristic).
inline double mis_weight(double pdf, double other) { return pdf > 0 ? pdf * pdf / (pdf * pdf + other * other) : 0; }

class Lights {
 public:
  /// Errors: InputError for an environment without image, and Lamp's.
  explicit Lights(const Light& light);

  /// Whether the sun adds any light.
  bool sunlit() const { return sunlit_; }
  /// A direction to the sun's disc. Only light samples find it: a ray that leaves the scene does not.
  LightSample sun(const std::array<double, 2>& sample) const;

  /// Radiance that a ray brings which leaves the scene: without an environment's spots, which only light samples find. Without a
  /// ground, the sky ends in even ground of ground_color.
  Vec3 around(const Vec3& direction) const;
  /// The image to draw light samples from; null where the sky is so even that rays need no guidance.
  const Environment* environment() const { return environment_; }
  /// What the camera sees where nothing is hit: the horizon goes on below itself; black where it is transparent.
  Vec3 backdrop(const Vec3& direction) const;
  /// And before that of a daylight sky, the sun's disc.
  Vec3 sun_disc(const Vec3& direction) const;
  /// What level white ground shows under the open sky: in all, and by the sun and an environment's spots. Lamps do not count.
  const Vec3& on_level_ground() const { return on_level_ground_; }
  const Vec3& sharp_on_level_ground() const { return sharp_on_level_ground_; }

  const std::vector<Lamp>& lamps() const { return lamps_; }

 private:
  Vec3 sky(const Vec3& direction) const;
  Vec3 mean_sky() const;

  Light light_;
  Daylight daylight_;
  const Environment* environment_ = nullptr;
  std::vector<Lamp> lamps_;
  Vec3 sun_, sun_s_, sun_t_;
  Vec3 sun_color_{0.0};
  Vec3 on_level_ground_{0.0}, sharp_on_level_ground_{0.0};
  double sun_tangent_ = 0, sun_cosine_ = 1;   ///< of its angular radius
  bool sunlit_ = false;
};

}  // namespace cambium
