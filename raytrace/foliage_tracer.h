// Rays against leaves: Embree's triangles, each shape once, instanced.
#pragma once

#include "blobtree/run_options.h"
#include "raytrace/foliage_scene.h"
#include "raytrace/ray.h"

#include <cstdint>
#include <memory>
#include <optional>
#include <vector>

namespace cambium {

struct FoliageHit {
  double t = 0;                 ///< metres along the ray
  std::uint32_t instance = 0, triangle = 0;
  double u = 0, v = 0;          ///< weights of the triangle's second and third corner
};

/// What a hit's place looks like.
struct FoliageLook {
  Vec3 position{0.0};
  Vec3 normal{0.0}, shading_normal{0.0};   ///< unit, of the side that the ray came from
  glm::dvec2 uv{0.0};
  Vec3 color{0.0};              ///< linear
  const FoliageMaterial* material = nullptr;
  std::int32_t branch = -1;
};

/// Thread safe. Cost: some 1.1 kB an instance.
class FoliageTracer {
 public:
  /// Once run is cancelled what is made meets nothing. Errors: InputError for an index without an item, a sheet whose vertices have
  /// not all they need, and numbers out of range; std::runtime_error if Embree cannot start.
  explicit FoliageTracer(FoliageScene scene, const RunOptions& run = {});
  ~FoliageTracer();
  FoliageTracer(const FoliageTracer&) = delete;
  FoliageTracer& operator=(const FoliageTracer&) = delete;

  const FoliageScene& scene() const { return scene_; }
  /// One for each instance.
  std::vector<Box> boxes() const;

  /// The nearest place before t_end that is not cut out, from either side; of several at one place always the same.
  std::optional<FoliageHit> intersect(const Ray& ray, double t_end = kInfinity) const;
  bool occluded(const Ray& ray, double t_end = kInfinity) const;
  /// footprint: metres that a pixel covers there, across the ray.
  FoliageLook look(const Ray& ray, const FoliageHit& hit, double footprint) const;
  /// How far beside a sheet a ray has to start that is not to meet it again, metres.
  double lift() const { return lift_; }

 private:
  struct Embree;
  FoliageScene scene_;
  Box bounds_;
  double lift_ = 0;
  std::unique_ptr<Embree> embree_;   ///< null where there is nothing to meet
};

}  // namespace cambium
