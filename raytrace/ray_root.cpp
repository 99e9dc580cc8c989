#include "raytrace/ray_root.h"

#include <algorithm>
#include <cmath>

namespace cambium {
namespace {

constexpr double kShortRadii = 0.02;      // a stretch this short is settled by its ends (0.05 chips crotch creases)
constexpr double kToleranceRadii = 1e-6;

/// Newton on f along the ray, kept inside a bracket with f(outside) < kIso <= f(inside).
double refine(Evaluator& evaluator, const PrunedField& field, const Ray& ray, double outside, double inside, double tolerance) {
  double t = 0.5 * (outside + inside);
  for (int iteration = 0; iteration < 60 && inside - outside > tolerance; ++iteration) {
    const Sample sample = evaluator.sample(field, ray.at(t));
    (sample.value < kIso ? outside : inside) = t;
    const double slope = glm::dot(sample.gradient, ray.direction);
    double next = slope > 0 ? t - (sample.value - kIso) / slope : outside;
    if (!(next > outside && next < inside)) {
      next = 0.5 * (outside + inside);
    } else if (std::abs(next - t) < 0.5 * tolerance) {
      // Converged from one side: step just across the root so that the bracket closes too.
      const double across = sample.value < kIso ? t + tolerance : t - tolerance;
      if (!(across > outside && across < inside)) break;
      const double value = evaluator.value(field, ray.at(across));
      (value < kIso ? outside : inside) = across;
      if ((value < kIso) != (sample.value < kIso)) break;
      next = 0.5 * (outside + inside);
    }
    t = next;
  }
  return inside;
}

}  // namespace

std::optional<RaySegment> clip(const Ray& ray, const Box& box, const RaySegment& segment) {
  RaySegment part = segment;
  for (int axis = 0; axis < 3; ++axis) {
    const double d = ray.direction[axis], o = ray.origin[axis];
    if (d == 0) {
      if (o < box.lo[axis] || o > box.hi[axis]) return std::nullopt;
      continue;
    }
    const double a = (box.lo[axis] - o) / d, b = (box.hi[axis] - o) / d;
    part.begin = std::max(part.begin, std::min(a, b));
    part.end = std::min(part.end, std::max(a, b));
  }
  if (!(part.begin <= part.end)) return std::nullopt;
  return part;
}

// A march by stretches of eight steps. What the interval proves empty is passed at once; where it fails the next stretch
// is as long as the step that failed, and after a proof of all eight it is doubled. That is a search of an eight-fold
// tree, nearest branch first, with the unfinished branches implied by (t, stretch) instead of kept on a stack.
std::optional<double> first_root(Evaluator& evaluator, const PrunedField& field, const Ray& ray, const RaySegment& segment) {
  const double length = segment.end - segment.begin;
  const double radius = field.smallest_radius() < kInfinity ? field.smallest_radius() : glm::length(field.box().size());
  const double shortest = kShortRadii * radius, tolerance = kToleranceRadii * radius;

  double t = segment.begin;
  if (evaluator.value(field, ray.at(t)) >= kIso) return t;
  double stretch = length;
  while (t < segment.end) {
    const double next = std::min(t + stretch, segment.end);
    const double span = next - t;
    if (span > shortest) {
      const int outside = evaluator.outside_along(field, ray.at(t), ray.at(next));
      if (outside == Evaluator::kStretches) {
        t = next;
        stretch = 2 * span;
      } else {
        t += outside * (span / Evaluator::kStretches);
        stretch = std::max(span / Evaluator::kStretches, 0.999 * shortest);   // below `shortest` at the latest after log8 failures
      }
      continue;
    }
    if (evaluator.value(field, ray.at(next)) >= kIso) return refine(evaluator, field, ray, t, next, tolerance);
    if (!(next > t)) return std::nullopt;
    t = next;
    stretch = 2 * shortest;
  }
  return std::nullopt;
}

}  // namespace cambium
