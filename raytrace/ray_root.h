// The first point of the surface on a ray inside one cell.
#pragma once

#include "blobtree/field.h"
#include "raytrace/ray.h"

#include <optional>

namespace cambium {

/// The length that roots in a cell are accurate to parts of: its smallest active radius; the box's diagonal if none has one.
double radius_in(const PrunedField& field);

/// The first t in the segment with f >= kIso: the segment's begin where the ray starts inside. The segment must lie in
/// field.box(). A stretch is skipped only where bounds prove it empty, or once it is shorter than 1e-6 of the smallest radius with
/// both ends outside; a root is the first because f is proved to rise up to it, or to be below kIso. So with r that radius and s the
/// slope of f along the ray (about 0.78/r where it meets a lone branch straight on): a surface through which the ray's way is
/// longer than 1e-6 r is never missed, what is reported is a place where f reaches kIso to within 1e-6 r s, and it is within
/// 1e-6 r of the first. Where the ray only touches the surface, f exceeding kIso on less than 1e-6 r, either answer may come:
/// on a ball the ray is then less than 2e-13 r deep. Not so where slopes are unknown, on the far side of a bend's centre: there
/// stretches shorter than 2 % of the smallest radius are settled by their ends. No allocation. Cost: two or three courses and as many
/// samples where the ray meets the surface, one course where it passes it by, some twenty of each where it touches.
std::optional<double> first_root(Evaluator& evaluator, const PrunedField& field, const Ray& ray, const RaySegment& segment);

/// Whether there is any such t: the same answer, sooner.
bool any_inside(Evaluator& evaluator, const PrunedField& field, const Ray& ray, const RaySegment& segment);

}  // namespace cambium
