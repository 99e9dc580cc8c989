// Embree's own round linear curves over a skeleton: what ray tracing the same tree unblended costs.
#pragma once

#include <cstddef>
#include <memory>
#include <optional>

#include "raytrace/ray.h"
#include "skeletons/skeleton.h"

namespace cambium::bench {

/// One curve segment for each internode: from its parent's radius, or from its own on a lateral, to its own. Thread safe once made.
class EmbreeCurves {
 public:
  /// Errors: std::runtime_error if Embree cannot start.
  explicit EmbreeCurves(const Skeleton& skeleton);
  ~EmbreeCurves();
  EmbreeCurves(const EmbreeCurves&) = delete;
  EmbreeCurves& operator=(const EmbreeCurves&) = delete;

  struct Hit {
    double t = 0;
    Vec3 normal{0.0};   ///< outward, unit
  };
  std::optional<Hit> intersect(const Ray& ray) const;
  bool occluded(const Ray& ray) const;

  /// Of everything Embree holds for it, the curves' own arrays included.
  std::size_t memory_bytes() const;

 private:
  struct Scene;
  std::unique_ptr<Scene> scene_;
};

}  // namespace cambium::bench
