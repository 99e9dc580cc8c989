#include "skeletons/graph/prepared_solid.h"

#include "skeletons/graph/closed_mesh.h"
#include "skeletons/graph/quadratic.h"
#include "skeletons/graph/revolution.h"

#include <algorithm>
#include <cmath>

namespace cambium {
namespace {

double across2(const Vec3& p) { return p.x * p.x + p.y * p.y; }

/// Whether p's direction is within the angle of z.
bool in_cone(const Vec3& p, double cos_angle) {
  const double adjacent2 = cos_angle * cos_angle * glm::dot(p, p);
  return cos_angle >= 0 ? p.z >= 0 && p.z * p.z >= adjacent2 : p.z >= 0 || p.z * p.z <= adjacent2;
}

/// The square of the distance from the origin along the way.
Quadratic length2_along(const Vec3& from, const Vec3& way) {
  return {glm::dot(way, way), 2 * glm::dot(from, way), glm::dot(from, from)};
}

/// Likewise from the z axis.
Quadratic across2_along(const Vec3& from, const Vec3& way) { return {across2(way), 2 * (from.x * way.x + from.y * way.y), across2(from)}; }

/// Where the distance from the origin is not above the radius.
Span span_in_ball(const Vec3& from, const Vec3& way, double radius) {
  const Quadratic length2 = length2_along(from, way);
  if (length2.least({}) > radius * radius) return {1, 0};
  if (length2.a == 0) return {};
  const double middle = -length2.b / (2 * length2.a);
  const double half = std::sqrt(std::max(radius * radius - length2.at(middle), 0.0) / length2.a);
  return {std::max(middle - half, 0.0), std::min(middle + half, 1.0)};
}

/// Where z is in 0 .. height.
Span span_in_slab(const Vec3& from, const Vec3& way, double height) {
  Span span;
  span.keep_above(way.z, from.z);
  span.keep_above(-way.z, height - from.z);
  return span;
}

bool meets_ball_part(const Vec3& from, const Vec3& way, double radius, double cos_angle) {
  Span span = span_in_ball(from, way, radius);
  if (span.empty()) return false;
  // What is out of a wide cone is convex: the way is in that all along if its ends are.
  if (cos_angle < 0) return in_cone(from + span.lo * way, cos_angle) || in_cone(from + span.hi * way, cos_angle);
  span.keep_above(way.z, from.z);
  if (span.empty()) return false;
  const Quadratic length2 = length2_along(from, way);
  const double c2 = cos_angle * cos_angle;
  const Quadratic beyond = {c2 * length2.a - way.z * way.z, c2 * length2.b - 2 * from.z * way.z, c2 * length2.c - from.z * from.z};
  return beyond.least(span) <= 0;
}

}  // namespace

struct PreparedSolid::Prepare {
  Shape operator()(const BallSolid& s) const {
    if (s.angle >= std::numbers::pi) return Ball{s.radius};
    return BallPart{s.radius, std::cos(s.angle)};
  }
  Shape operator()(const EllipsoidSolid& s) const {
    return Ellipsoid{s.half_size, std::min({s.half_size.x, s.half_size.y, s.half_size.z})};
  }
  Shape operator()(const CylinderSolid& s) const { return Cylinder{s.radius, s.height}; }
  Shape operator()(const ConeSolid& s) const {
    const double slope = (s.radius_tip - s.radius_base) / s.height;
    return Cone{s.radius_base, slope, s.height, std::sqrt(1 + slope * slope), s.radius_base > 0, s.radius_tip > 0};
  }
  Shape operator()(const RevolutionSolid& s) const { return Revolution{std::make_shared<const RevolvedStroke>(s.stroke), half_size(s)}; }
  Shape operator()(const MeshSolid& s) const { return Mesh{s.mesh, half_size(s)}; }

  static double half_size(const Solid& solid) {
    const Vec3 size = bounds(solid).size();
    return 0.5 * std::min({size.x, size.y, size.z});
  }
};

PreparedSolid::PreparedSolid(const Solid& solid) : shape_(std::visit(Prepare{}, solid)) {}

struct PreparedSolid::Contains {
  const Vec3& p;

  bool operator()(const Ball& s) const { return glm::dot(p, p) <= s.radius * s.radius; }
  bool operator()(const BallPart& s) const { return glm::dot(p, p) <= s.radius * s.radius && in_cone(p, s.cos_angle); }
  bool operator()(const Ellipsoid& s) const { const Vec3 q = p / s.half_size; return glm::dot(q, q) <= 1; }
  bool operator()(const Cylinder& s) const { return 0 <= p.z && p.z <= s.height && across2(p) <= s.radius * s.radius; }
  bool operator()(const Cone& s) const {
    const double radius = s.radius + s.slope * p.z;
    return 0 <= p.z && p.z <= s.height && across2(p) <= radius * radius;
  }
  bool operator()(const Revolution& s) const { return s.stroke->contains(p); }
  bool operator()(const Mesh& s) const { return s.mesh->contains(p); }
};

bool PreparedSolid::contains(const Vec3& p) const { return std::visit(Contains{p}, shape_); }

struct PreparedSolid::Depth {
  const Vec3& p;

  double operator()(const Ball& s) const { return s.radius - glm::length(p); }
  double operator()(const BallPart& s) const { return s.radius - glm::length(p); }
  double operator()(const Ellipsoid& s) const { return (1 - glm::length(p / s.half_size)) * s.least; }
  double operator()(const Cylinder& s) const { return std::min({p.z, s.height - p.z, s.radius - std::sqrt(across2(p))}); }
  double operator()(const Cone& s) const {
    double d = (s.radius + s.slope * p.z - std::sqrt(across2(p))) / s.steepness;
    if (s.has_base) d = std::min(d, p.z);
    if (s.has_tip) d = std::min(d, s.height - p.z);
    return d;
  }
  double operator()(const Revolution& s) const { return s.stroke->depth(p); }
  double operator()(const Mesh& s) const { return s.mesh->depth(p); }
};

double PreparedSolid::depth(const Vec3& p) const { return std::visit(Depth{p}, shape_); }

struct PreparedSolid::Middleness {
  const Vec3& p;

  double operator()(const Ball& s) const { return 1 - glm::length(p) / s.radius; }
  double operator()(const BallPart& s) const { return 1 - glm::length(p) / s.radius; }
  double operator()(const Ellipsoid& s) const { return 1 - glm::length(p / s.half_size); }
  double operator()(const Cylinder& s) const { return 1 - std::sqrt(across2(p)) / s.radius; }
  double operator()(const Cone& s) const {
    const double radius = s.radius + s.slope * p.z;
    return radius > 0 ? 1 - std::sqrt(across2(p)) / radius : 1.0;
  }
  double operator()(const Revolution& s) const { return s.stroke->depth(p) / s.half_size; }
  double operator()(const Mesh& s) const { return s.mesh->depth(p) / s.half_size; }
};

double PreparedSolid::middleness(const Vec3& p) const { return std::visit(Middleness{p}, shape_); }

struct PreparedSolid::Meets {
  const Vec3 &a, &b;

  bool operator()(const Ball& s) const { return length2_along(a, b - a).least({}) <= s.radius * s.radius; }
  bool operator()(const BallPart& s) const { return meets_ball_part(a, b - a, s.radius, s.cos_angle); }
  bool operator()(const Ellipsoid& s) const { return length2_along(a / s.half_size, (b - a) / s.half_size).least({}) <= 1; }
  bool operator()(const Cylinder& s) const {
    const Span span = span_in_slab(a, b - a, s.height);
    return !span.empty() && across2_along(a, b - a).least(span) <= s.radius * s.radius;
  }
  bool operator()(const Cone& s) const {
    const Vec3 way = b - a;
    const Span span = span_in_slab(a, way, s.height);
    if (span.empty()) return false;
    const Quadratic from_axis2 = across2_along(a, way);
    const double radius = s.radius + s.slope * a.z, step = s.slope * way.z;
    return Quadratic{from_axis2.a - step * step, from_axis2.b - 2 * radius * step, from_axis2.c - radius * radius}.least(span) <= 0;
  }
  bool operator()(const Revolution& s) const { return s.stroke->meets(a, b); }
  bool operator()(const Mesh& s) const { return s.mesh->meets(a, b); }
};

bool PreparedSolid::meets(const Vec3& a, const Vec3& b) const { return std::visit(Meets{a, b}, shape_); }

}  // namespace cambium
