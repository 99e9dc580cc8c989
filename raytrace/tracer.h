// Rays against all cells of a surface cover, through an Embree hierarchy.
#pragma once

#include "blobtree/surface_cover.h"
#include "raytrace/ray_root.h"

#include <cstdint>
#include <memory>
#include <optional>

namespace cambium {

struct SurfaceHit {
  double t = 0;             ///< metres along the ray
  std::uint32_t cell = 0;   ///< index of the cell it was found in
};

/// Owns the cover. Thread safe: each thread brings its own Evaluator. Errors: std::runtime_error if Embree cannot start.
class Tracer {
 public:
  explicit Tracer(SurfaceCover cover);
  ~Tracer();
  Tracer(const Tracer&) = delete;
  Tracer& operator=(const Tracer&) = delete;

  const SurfaceCover& cover() const { return cover_; }
  const Box& bounds() const { return bounds_; }   ///< of the cells

  /// The nearest surface point with t > 0 (t = 0 where the ray starts inside); solved in double, whatever Embree does in float.
  std::optional<SurfaceHit> intersect(Evaluator& evaluator, const Ray& ray) const;
  /// Whether anything stands before t_end.
  bool occluded(Evaluator& evaluator, const Ray& ray, double t_end = kInfinity) const;

 private:
  struct Scene;
  SurfaceCover cover_;
  Box bounds_;
  std::unique_ptr<Scene> scene_;
};

}  // namespace cambium
