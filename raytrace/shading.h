// Light along one camera ray: surface, ground or sky.
#pragma once

#include "raytrace/lighting.h"
#include "raytrace/sampler.h"
#include "raytrace/tracer.h"

namespace cambium {

/// One camera sample. Its light is direct + albedo * ambient; they are kept apart so that the noise of the few sky rays can be
/// smoothed without touching texture or the sun's shadow edges.
struct CameraSample {
  Vec3 direct{0.0};        ///< sun, and the sky where nothing was hit
  Vec3 ambient{0.0};       ///< light from sky and surroundings, not yet multiplied by albedo
  Vec3 albedo{0.0};
  Vec3 normal{0.0};        ///< geometric, world; zero on a miss
  double depth = kInfinity;
  double branch = -1;
  int rays = 0;

  Vec3 color() const { return direct + albedo * ambient; }
};

struct Ground {
  double height = 0;
  double fade = 1;         ///< metres from the camera over which it goes into the horizon
};

class Shading {
 public:
  Shading(const Tracer& tracer, const Bark& bark, const Light& light, std::optional<Ground> ground, double pixel_angle);

  CameraSample sample(Evaluator& evaluator, const Ray& ray, const PixelSampler& sampler, std::uint32_t index) const;

 private:
  CameraSample on_surface(Evaluator& evaluator, const Ray& ray, const SurfaceHit& hit, const PixelSampler& sampler,
                          std::uint32_t index) const;
  CameraSample on_ground(Evaluator& evaluator, const Ray& ray, double t, const PixelSampler& sampler, std::uint32_t index) const;
  Vec3 sky_from(Evaluator& evaluator, const Vec3& p, const Vec3& normal, const std::array<double, 2>& sample) const;

  const Tracer& tracer_;
  const Bark& bark_;
  Lighting lighting_;
  Vec3 ground_color_;
  std::optional<Ground> ground_;
  double pixel_angle_ = 0;
  Vec3 hidden_{0.0};
};

}  // namespace cambium
