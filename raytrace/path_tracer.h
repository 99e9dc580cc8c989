// Light along one camera ray: surface, ground or sky.
#pragma once

#include "raytrace/bark.h"
#include "raytrace/camera_sample.h"
#include "raytrace/lighting.h"
#include "raytrace/sampler.h"
#include "raytrace/tracer.h"

namespace cambium {

struct Ground {
  double height = 0;
  double fade = 1;         ///< metres from the camera over which it goes into the horizon
};

class PathTracer {
 public:
  PathTracer(const Tracer& tracer, const Bark& bark, const Light& light, std::optional<Ground> ground, double pixel_angle);

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
