// The first point of the surface on a ray inside one cell.
#pragma once

#include "blobtree/field.h"

#include <optional>

namespace cambium {

/// A half line: origin + t direction, t >= 0. direction is a unit vector, so t is metres.
struct Ray {
  Vec3 origin;
  Vec3 direction;
  Vec3 at(double t) const { return origin + t * direction; }
};

struct RaySegment {
  double begin = 0;
  double end = 0;
};

/// The part of the ray within [segment] that lies in the box (faces included); nullopt if none does.
std::optional<RaySegment> clip(const Ray& ray, const Box& box, const RaySegment& segment);

/// The first t in the segment with f >= kIso: the segment's begin where the ray starts inside. The segment must lie in
/// field.box(). Stretches are skipped only where the interval proves them empty or, once shorter than 2 % of the smallest
/// radius, where f is outside at both ends; so a twig is missed only where the ray's way through it is shorter than that.
/// Accurate to 1e-6 of the smallest radius. No allocation.
std::optional<double> first_root(Evaluator& evaluator, const PrunedField& field, const Ray& ray, const RaySegment& segment);

}  // namespace cambium
