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
  bool analytic = false;    ///< on a chain's own solid: solved in closed form
  std::uint32_t found_in = 0;   ///< for Tracer::cell(): the number of that solid, or of the cell
  Vec3 normal{0.0};         ///< outward unit normal; against the ray where the field has none
  double radius = 0;        ///< of the branch, metres: on a chain's own solid that of the axis nearest, else the smallest in the cell
};

/// The hit's point, raised off the surface just far enough (4e-6 of the radius) that a ray from there that leaves the surface does
/// not meet it again: where shadow rays start.
inline Vec3 off_surface(const Ray& ray, const SurfaceHit& hit) { return ray.at(hit.t) + (4e-6 * hit.radius) * hit.normal; }

/// How fine a cover has to be for rays: not for meshes.
CoverOptions tracing_cells();

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
  /// The cell of the cover that holds the place that intersect() found. Cost: a binary search if it is analytic.
  std::uint32_t cell(const Ray& ray, const SurfaceHit& hit) const;
  /// Whether anything stands before t_end. Who starts so deep inside that no cell is there, and ends before the first, meets nothing.
  bool occluded(Evaluator& evaluator, const Ray& ray, double t_end = kInfinity) const;

 private:
  struct Scene;
  SurfaceCover cover_;
  Box bounds_;
  std::unique_ptr<Scene> scene_;
};

}  // namespace cambium
