// Where rays meet a field, found with its values and intervals alone: slow, simple, and independent of covers, courses, closed
// forms and Embree. What the tracer is judged by.
#pragma once

#include "blobtree/field.h"
#include "raytrace/ray.h"

#include <cstddef>
#include <optional>
#include <vector>

namespace cambium {

/// Beyond this much of f a ray is inside the surface, or passes it, without a doubt.
inline constexpr double kTouching = 1e-12;

/// An octree over the field's bounds, split wherever an interval does not prove that there is no surface. Immutable, shared by threads.
class SampledSurface {
 public:
  explicit SampledSurface(const Field& field);

  /// The first t in [0, end] with f >= level, which is within kTouching of kIso. Of the ray every stretch before it is proved empty
  /// by an interval, or is shorter than 1e-3 of the smallest radius around and sampled, and then searched where f comes near to the
  /// level. Error: a few roundings of t, and what they become where the ray only touches.
  std::optional<double> first_reaching(Evaluator& evaluator, const Ray& ray, double level, double end = kInfinity) const;
  /// The same in all leaves, without the octree.
  std::optional<double> first_reaching_in_any(Evaluator& evaluator, const Ray& ray, double level) const;

  std::size_t leaf_count() const { return leaves_.size(); }

 private:
  struct Node {
    Box box;
    std::size_t first = 0, count = 0;   ///< of its children
    std::optional<std::size_t> leaf;
  };
  /// A leaf that the ray passes through.
  struct Passage {
    RaySegment part;
    std::size_t leaf = 0;
  };
  void split(std::size_t node, const Field& field, const ActiveSet& active, Evaluator& evaluator);
  void pass(std::size_t node, const Ray& ray, const RaySegment& segment, std::vector<Passage>& out) const;

  std::vector<Node> nodes_;
  std::vector<PrunedField> leaves_;
};

}  // namespace cambium
