#include "skeletons/graph/closed_mesh.h"

#include "blobtree/triangle_distance.h"
#include "skeletons/graph/mesh_closing.h"
#include "skeletons/graph/quadratic.h"

#include <algorithm>
#include <cmath>

namespace cambium {
namespace {

constexpr std::size_t kFewestCells = std::size_t{1} << 12, kMostCells = std::size_t{1} << 18;

/// Whether the way from p in the direction of x crosses the edge from a to b: 1 where that goes up, -1 where it goes down. Both triangles
/// of an edge get the same answer, so none of them is missed or met twice between.
int crossing(const Vec3& p, const Vec3& a, const Vec3& b) {
  const bool up = a.y <= p.y;
  if (up == (b.y <= p.y)) return 0;
  const Vec3 &low = up ? a : b, &high = up ? b : a;
  const double x = low.x + (high.x - low.x) * ((p.y - low.y) / (high.y - low.y));
  return x > p.x ? (up ? 1 : -1) : 0;
}

/// On the triangle's plane above or below p, within the triangle's own height.
double height_at(const Vec3& p, const Vec3& a, const Vec3& b, const Vec3& c) {
  const Vec3 n = glm::cross(b - a, c - a);
  const auto [low, high] = std::minmax({a.z, b.z, c.z});
  const double z = a.z - ((p.x - a.x) * n.x + (p.y - a.y) * n.y) / n.z;
  return z > low ? std::min(z, high) : low;   // also where it is upright, which makes z no number
}

/// Möller and Trumbore 1997; edges count.
bool meets_triangle(const Vec3& from, const Vec3& way, const Vec3& a, const Vec3& b, const Vec3& c) {
  const Vec3 ab = b - a, ac = c - a, across = glm::cross(way, ac), to = from - a;
  const double determinant = glm::dot(ab, across);
  if (determinant == 0) return false;
  const double u = glm::dot(to, across) / determinant;
  const Vec3 turn = glm::cross(to, ab);
  const double v = glm::dot(way, turn) / determinant, t = glm::dot(ac, turn) / determinant;
  return u >= 0 && v >= 0 && u + v <= 1 && t >= 0 && t <= 1;
}

bool meets_box(const Vec3& from, const Vec3& way, const FloatBox& box) {
  Span span;
  for (int i = 0; i < 3; ++i) span.keep_above(way[i], from[i] - box.lo[i]), span.keep_above(-way[i], box.hi[i] - from[i]);
  return span.lo <= span.hi + 1e-12;
}

}  // namespace

ClosedMesh::ClosedMesh(std::vector<Vec3> positions, std::vector<std::array<std::uint32_t, 3>> triangles) {
  for (const auto& [a, b, c] : closed_triangles(positions, triangles)) triangles_.push_back({a, b, c});
  const auto box_of = [this](std::size_t i) {
    Box box;
    box.extend(triangles_[i].a), box.extend(triangles_[i].b), box.extend(triangles_[i].c);
    return box;
  };
  for (std::size_t i = 0; i < triangles_.size(); ++i) bounds_.extend(box_of(i));
  tree_ = BoxTree(triangles_.size(), box_of);
  cells_ = SettledCells(bounds_, std::clamp(8 * triangles_.size(), kFewestCells, kMostCells), triangles_.size(), box_of,
                        [this](const Vec3& p) { return winding(p) != 0; });
}

bool ClosedMesh::contains(const Vec3& p) const {
  const SettledCells::Kind kind = cells_.at(p);
  return kind == SettledCells::Kind::kUnknown ? winding(p) != 0 : kind == SettledCells::Kind::kInside;
}

/// Triangles above p, by the side that they turn to it.
int ClosedMesh::winding(const Vec3& p) const {
  int around = 0;
  tree_.search(
      [&](const FloatBox& box) {
        return box.lo.x <= p.x && p.x <= box.hi.x && box.lo.y <= p.y && p.y <= box.hi.y && p.z <= box.hi.z;
      },
      [&](std::uint32_t i) {
        const auto& [a, b, c] = triangles_[i];
        const int turn = crossing(p, a, b) + crossing(p, b, c) + crossing(p, c, a);
        if (turn != 0 && height_at(p, a, b, c) >= p.z) around += turn;
      });
  return around;
}

double ClosedMesh::depth(const Vec3& p) const {
  return std::sqrt(tree_.nearest2(
      p, kInfinity, [&](std::uint32_t i) { return distance2_to_triangle(p, triangles_[i].a, triangles_[i].b, triangles_[i].c); }));
}

bool ClosedMesh::meets(const Vec3& a, const Vec3& b) const {
  if (contains(a) || contains(b)) return true;
  bool met = false;
  const Vec3 way = b - a;
  tree_.search([&](const FloatBox& box) { return !met && meets_box(a, way, box); },
               [&](std::uint32_t i) { met = met || meets_triangle(a, way, triangles_[i].a, triangles_[i].b, triangles_[i].c); });
  return met;
}

}  // namespace cambium
