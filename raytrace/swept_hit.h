// Where a ray meets one segment of a sphere-swept polyline, in closed form. The segment's solid is the convex hull of two balls:
// a cone between the circles in which it touches them, and what is left of the balls.
#pragma once

#include "blobtree/skeleton_primitives.h"
#include "raytrace/ray.h"

#include <algorithm>
#include <optional>

namespace cambium {

/// A chain's segment as the field has it (CompiledTree::segment_of): from its begin, which is at the axis's parameter 0.
SweptSegment<double> swept_segment(const Vec3& from, double radius_from, const Vec3& to, double radius_to);

/// A segment's axis as a ray sees it from one of its points, at which everything is counted from.
struct AxisView {
  double h = 0, dh = 0;                    ///< of the point, along the axis from the segment's begin, and per metre of the ray
  double square = 0, mixed = 0, d_square = 0;   ///< of the vectors across the axis, of the point (e) and per metre (d): e.e, e.d, d.d
  Vec3 q{0.0};                             ///< the point from the segment's begin

  /// The least distance of the two lines, squared.
  double nearest_square() const { return d_square > 0 ? std::max(0.0, square - mixed * mixed / d_square) : square; }

  /// Seen from the ray's point at t; near to the segment its roundings are those of the neighbourhood, wherever the ray begins.
  AxisView(const SweptSegment<double>& segment, const Ray& ray, double t) : q((ray.origin - segment.a) + t * ray.direction) {
    h = glm::dot(q, segment.axis);
    dh = glm::dot(ray.direction, segment.axis);
    // Not q.q - h h, which cancels beside a long thin segment.
    const Vec3 across = q - h * segment.axis, d_across = ray.direction - dh * segment.axis;
    square = glm::dot(across, across);
    mixed = glm::dot(across, d_across);
    d_square = glm::dot(d_across, d_across);
  }
  /// Whether the ray's line comes within a distance of the axis's line.
  bool comes_within(double distance) const { return mixed * mixed >= d_square * (square - distance * distance); }
};

/// The largest radius of a segment.
inline double thickest(const SweptSegment<double>& k) { return std::max(k.radius_at(k.begin), k.radius_at(k.end)); }

/// The first t in the part of the ray at which it is in the solid: the part's begin where it already is there; nullopt if none.
/// `view` from the part's middle. Error: a few roundings of the part's length and of the distance from its middle to the segment;
/// where the ray only grazes the solid, the square root of that.
std::optional<double> first_inside(const SweptSegment<double>& segment, const Ray& ray, const RaySegment& part, const AxisView& view);
std::optional<double> first_inside(const SweptSegment<double>& segment, const Ray& ray, const RaySegment& part);

/// Holds all of the part that is within `reach` of the segment's axis, and little more: what is in a cylinder with flat ends.
/// nullopt if nothing is.
std::optional<RaySegment> part_within(const SweptSegment<double>& segment, double reach, const RaySegment& part, const AxisView& view);

/// The same segment with radii `factor` times as large.
SweptSegment<double> widened(const SweptSegment<double>& segment, double factor);

/// Outward, at a point of the solid's surface.
Vec3 swept_normal(const SweptSegment<double>& segment, const Vec3& p);

/// A box that holds what the solid has in common with another box; empty where that is nothing.
Box solid_bounds(const SweptSegment<double>& segment, const Box& within);

}  // namespace cambium
