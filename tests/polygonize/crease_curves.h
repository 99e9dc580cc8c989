// Solids whose creases are known curves.
#pragma once

#include "blobtree/field.h"

#include <algorithm>
#include <functional>
#include <numbers>
#include <string>
#include <vector>

namespace cambium::testing {

struct CreasedSolid {
  std::string name;
  Field field;
  std::function<double(const Vec3&)> from_crease;                     ///< metres to the nearest crease
  std::function<std::vector<Vec3>(const Vec3&)> sheet_normals;        ///< outward, of the sheets that meet in a point of a crease
  double length = 0;                                                  ///< of all creases, metres
  double radius = 0;                                                  ///< of the most curved sheet
};

inline double from_circle(const Vec3& p, const Vec3& center, const Vec3& axis, double radius) {
  const double along = glm::dot(p - center, axis);
  return std::hypot(glm::length(p - center - along * axis) - radius, along);
}

/// The cap x n <= d that a half-space leaves of a sphere: one circle.
inline CreasedSolid cut_sphere() {
  const Vec3 center(0.02, -0.01, 0.03), n = glm::normalize(Vec3(0.3, -0.5, 0.8));
  const double r = 1, d = 0.35;
  BlobTreeBuilder b;
  const NodeId ball = b.add(Sphere{center, r, 1}), half = b.add(HalfSpace{center + d * n, -n, 0.2});
  const double circle = std::sqrt(r * r - d * d);
  return {"cut sphere", Field(b.build(b.add(Difference{{ball, half}}))),
          [=](const Vec3& p) { return from_circle(p, center + d * n, n, circle); },
          [=](const Vec3& p) { return std::vector<Vec3>{glm::normalize(p - center), n}; }, 2 * std::numbers::pi * circle, r};
}

/// Two spheres of one size, united: a concave circle between them.
inline CreasedSolid united_spheres() {
  const Vec3 p(-0.31, 0.02, 0.05), q(0.35, 0.21, -0.11);
  const double r = 0.6;
  BlobTreeBuilder b;
  const NodeId one = b.add(Sphere{p, r, 1}), other = b.add(Sphere{q, r, 1});
  const Vec3 middle = (p + q) / 2.0, n = glm::normalize(q - p);
  const double circle = std::sqrt(r * r - glm::dot(q - p, q - p) / 4);
  return {"united spheres", Field(b.build(b.add(Union{{one, other}}))),
          [=](const Vec3& x) { return from_circle(x, middle, n, circle); },
          [=](const Vec3& x) { return std::vector<Vec3>{glm::normalize(x - p), glm::normalize(x - q)}; },
          2 * std::numbers::pi * circle, r};
}

/// An eighth of a sphere that three half-spaces leave: three straight creases into a corner, and three quarters of circles.
inline CreasedSolid octant() {
  const Vec3 corner(0.013, 0.027, -0.019);
  const double r = 1;
  const Mat3 axes = Mat3(glm::normalize(Vec3(2, 1, 2)), glm::normalize(Vec3(1, 2, -2)), glm::normalize(Vec3(-2, 2, 1)));   // orthonormal
  BlobTreeBuilder b;
  std::vector<NodeId> children{b.add(Sphere{corner, r, 1})};
  for (int a = 0; a < 3; ++a) children.push_back(b.add(HalfSpace{corner, -axes[a], 0.2}));   // what is kept is ahead of the plane
  const auto from_crease = [=](const Vec3& x) {
    const Vec3 local = glm::transpose(axes) * (x - corner);
    double nearest = kInfinity;
    for (int a = 0; a < 3; ++a) {
      Vec3 straight(0.0), arc = local;
      straight[a] = std::clamp(local[a], 0.0, r);
      nearest = std::min(nearest, glm::length(local - straight));
      arc[a] = 0;
      arc = glm::max(arc, Vec3(0.0));
      if (const double l = glm::length(arc); l > 0) nearest = std::min(nearest, glm::length(local - arc * (r / l)));
    }
    return nearest;
  };
  const auto normals = [=](const Vec3& x) {
    const Vec3 local = glm::transpose(axes) * (x - corner);
    std::vector<Vec3> sheets;
    if (std::abs(glm::length(local) - r) < 1e-3) sheets.push_back(glm::normalize(x - corner));
    for (int a = 0; a < 3; ++a)
      if (std::abs(local[a]) < 1e-3) sheets.push_back(-axes[a]);
    return sheets;
  };
  return {"octant", Field(b.build(b.add(Intersection{std::move(children)}))), from_crease, normals, 3 * r + 1.5 * std::numbers::pi * r, r};
}

inline std::vector<CreasedSolid> creased_solids() { return {cut_sphere(), united_spheres(), octant()}; }

}  // namespace cambium::testing
