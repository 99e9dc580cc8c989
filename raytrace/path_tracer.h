// Light along one camera ray: what it meets, and the light that falls there from sun, sky, lamps and other surfaces.
#pragma once

#include "raytrace/bark.h"
#include "raytrace/bsdf.h"
#include "raytrace/camera_sample.h"
#include "raytrace/foliage_tracer.h"
#include "raytrace/ground.h"
#include "raytrace/lights.h"
#include "raytrace/path_options.h"
#include "raytrace/sampler.h"
#include "raytrace/tracer.h"

namespace cambium {

/// Path tracing with light samples and multiple importance sampling (Veach 1997). What a ray brings is kept in two parts:
/// `direct`, sharp and nearly without noise: sun, lamps, an environment's spots, and what the camera sees of the sky; and `ambient`, noisy and even: sky and bounces, over the surface's reflectance. Both are unbiased.
/// Thread safe; each thread brings its own Evaluator. A pure function of its arguments.
class PathTracer {
 public:
  /// The tracer, the bark, an environment and the foliage (null: none) must outlive it. pixel_angle: radians. Errors: InputError for options out of range,
  /// and those of Lights.
  PathTracer(const Tracer& tracer, const Bark& bark, const Light& light, std::optional<Ground> ground, double pixel_angle,
             const PathOptions& options = {}, const FoliageTracer* foliage = nullptr);

  CameraSample sample(Evaluator& evaluator, const Ray& ray, const PixelSampler& sampler, std::uint32_t index) const;

 private:
  /// What one sample carries along its path.
  struct Walk {
    Evaluator& evaluator;
    const PixelSampler& sampler;
    std::uint32_t index;
    int rays = 0;

    std::array<double, 2> pair(Use use, int depth, std::size_t item = 0) const {
      return sampler.pair(index, use, static_cast<std::uint32_t>(depth), static_cast<std::uint32_t>(item));
    }
  };
  /// A point that light falls on.
  struct Vertex {
    Vec3 start;         ///< of rays that leave: just off the surface
    Bsdf bsdf;
    double open = 1;    ///< share of the light around that the bark's own relief lets in
    Vec3 to_back{0.0};  ///< of a leaf: from there to just off its other side, where rays start that leave on that

    Ray towards(const Vec3& direction) const {
      return {glm::dot(to_back, direction) > 0 ? start + to_back : start, direction};
    }
  };
  struct Met {
    double t = kInfinity;
    std::optional<SurfaceHit> tree;   ///< none of this and the next: the ground, or nothing where t is infinite
    std::optional<FoliageHit> leaf = std::nullopt;
  };
  /// Light that a vertex sends on.
  struct Parts {
    Vec3 sharp{0.0}, soft{0.0};
    Vec3 all() const { return sharp + soft; }
  };
  struct Lit {
    Parts reaching, missing;   ///< missing: what would reach it if nothing stood in the way
  };

  Met meet(Walk& walk, const Ray& ray) const;
  bool blocked(Walk& walk, const Ray& ray, double distance) const;

  Vertex bark_vertex(Walk& walk, const Ray& ray, const SurfaceHit& hit, double footprint, CameraSample* seen) const;
  Vertex leaf_vertex(const Ray& ray, const FoliageHit& hit, double footprint, CameraSample* seen) const;
  Vertex ground_vertex(const Ray& ray, double t, double footprint) const;
  Vertex vertex(Walk& walk, const Ray& ray, const Met& met, double footprint) const;

  Lit light_samples(Walk& walk, const Vertex& vertex, int depth) const;
  Vec3 emitted(const Ray& ray, double pdf, double t) const;
  Vec3 bounced(Walk& walk, Vertex vertex, double footprint, double& occlusion) const;
  void shade(Walk& walk, const Vertex& vertex, double footprint, CameraSample& out) const;

  void see_tree(Walk& walk, const Ray& ray, const SurfaceHit& hit, CameraSample& out) const;
  void see_leaf(Walk& walk, const Ray& ray, const FoliageHit& hit, CameraSample& out) const;
  void see_ground(Walk& walk, const Ray& ray, double t, CameraSample& out) const;
  void see_catcher(Walk& walk, const Ray& ray, double t, CameraSample& out) const;

  const Tracer& tracer_;
  const FoliageTracer* foliage_;
  const Bark& bark_;
  Lights lights_;
  Vec3 ground_color_;
  bool catcher_ = false, transparent_ = false;
  std::optional<Ground> ground_;
  double pixel_angle_ = 0;
  PathOptions options_;
};

}  // namespace cambium
