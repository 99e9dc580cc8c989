// The polygon dual to a minimal edge: its corners, and how well it stands for the surface.
#pragma once

#include "polygonize/minimal_edges.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <optional>
#include <vector>

namespace cambium {

/// The polygon's patches in ring order, counter-clockwise seen from outside, each once; quadrant: where each was found first.
struct Ring {
  std::array<std::uint32_t, 4> patches{};
  std::array<std::array<int, 2>, 4> across{};   ///< the quadrants on both sides of the face to the next
  int count = 0;
};

inline Ring ring_of(const MinimalEdge& edge, const std::array<std::uint32_t, 4>& patch_of) {
  Ring ring;
  for (int k = 0; k < 4; ++k) {
    const int q = edge.low_inside ? kRing[k] : kRing[3 - k];
    const int next = edge.low_inside ? kRing[(k + 1) % 4] : kRing[(6 - k) % 4];
    if (edge.leaves[q] == edge.leaves[next]) continue;
    ring.patches[ring.count] = patch_of[q];
    ring.across[ring.count] = {q, next};
    ++ring.count;
  }
  return ring;
}

inline double cross2(const Vec3& p, const Vec3& q) { return p.x * q.y - p.y * q.x; }

/// Height at which the third axis meets a triangle, or none.
inline std::optional<double> pierced_at(const Vec3& p, const Vec3& q, const Vec3& r) {
  const double u = cross2(q, r), v = cross2(r, p), w = cross2(p, q);
  if (!((u > 0 && v > 0 && w > 0) || (u < 0 && v < 0 && w < 0))) return std::nullopt;
  return (u * p.z + v * q.z + w * r.z) / (u + v + w);
}

/// How far the triangles of a polygon are from the surface where that crosses the edge: by the diagonal from corner 0, and by the
/// one from corner 1; infinite where the edge misses them. A triangle has only the first.
struct PolygonFit {
  std::array<double, 2> error{kInfinity, kInfinity};
  double best() const { return std::min(error[0], error[1]); }
};

/// x: where the surface crosses the edge, which runs along `axis`.
inline PolygonFit polygon_fit(const Ring& ring, const std::vector<Vec3>& positions, const Vec3& x, int axis) {
  std::array<Vec3, 4> p;
  for (int k = 0; k < ring.count; ++k) {
    const Vec3 d = positions[ring.patches[k]] - x;
    p[k] = {d[(axis + 1) % 3], d[(axis + 2) % 3], d[axis]};
  }
  const auto distance = [](const Vec3& a, const Vec3& b, const Vec3& c) -> std::optional<double> {
    const auto height = pierced_at(a, b, c);
    if (!height) return std::nullopt;
    const Vec3 area = glm::cross(b - a, c - a);
    return std::abs(*height * area.z) / glm::length(area);
  };
  PolygonFit fit;
  if (ring.count == 3) {
    fit.error[0] = distance(p[0], p[1], p[2]).value_or(kInfinity);
    return fit;
  }
  for (int k = 0; k < 2; ++k) {
    const Vec3 &a = p[k], &b = p[k + 1], &c = p[k + 2], &d = p[(k + 3) % 4];
    if (const auto first = distance(a, b, c)) {
      fit.error[k] = *first;
    } else if (const auto second = distance(a, c, d)) {
      fit.error[k] = *second;
    }
  }
  return fit;
}

}  // namespace cambium
