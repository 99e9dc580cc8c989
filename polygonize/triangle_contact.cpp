#include "polygonize/triangle_contact.h"

#include "polygonize/exact_orientation.h"

#include <algorithm>

namespace cambium {
namespace {

// Everything coplanar is asked in all three axis projections: a meeting shows in each, and at least one of them maps the plane
// one to one, so it is there in truth if it shows in all.

bool extents_meet(double a, double b, double c, double d) {
  return std::max(a, b) >= std::min(c, d) && std::max(c, d) >= std::min(a, b);
}

bool segments_meet_2d(const Vec3& p, const Vec3& q, const Vec3& r, const Vec3& s, int axis) {
  const int u = (axis + 1) % 3, v = (axis + 2) % 3;
  if (!extents_meet(p[u], q[u], r[u], s[u]) || !extents_meet(p[v], q[v], r[v], s[v])) return false;
  return orientation_2d(p, q, r, axis) * orientation_2d(p, q, s, axis) <= 0 &&
         orientation_2d(r, s, p, axis) * orientation_2d(r, s, q, axis) <= 0;
}

bool point_in_triangle_2d(const Vec3& p, const TriangleCorners& t, int axis) {
  for (const int k : {(axis + 1) % 3, (axis + 2) % 3}) {
    if (p[k] < std::min({t[0][k], t[1][k], t[2][k]}) || p[k] > std::max({t[0][k], t[1][k], t[2][k]})) return false;
  }
  const int a = orientation_2d(t[0], t[1], p, axis), b = orientation_2d(t[1], t[2], p, axis), c = orientation_2d(t[2], t[0], p, axis);
  return !((a > 0 || b > 0 || c > 0) && (a < 0 || b < 0 || c < 0));
}

bool coplanar_segment_meets(const Vec3& p, const Vec3& q, const TriangleCorners& t) {
  for (int axis = 0; axis < 3; ++axis) {
    if (!point_in_triangle_2d(p, t, axis) && !segments_meet_2d(p, q, t[0], t[1], axis) &&
        !segments_meet_2d(p, q, t[1], t[2], axis) && !segments_meet_2d(p, q, t[2], t[0], axis)) {
      return false;
    }
  }
  return true;
}

bool segments_meet(const Vec3& p, const Vec3& q, const Vec3& r, const Vec3& s) {
  if (orientation_3d(p, q, r, s) != 0) return false;
  for (int axis = 0; axis < 3; ++axis) {
    if (!segments_meet_2d(p, q, r, s, axis)) return false;
  }
  return true;
}

// side_p, side_q: orientation_3d of the triangle and p, q. The triangle has an area.
bool segment_meets(const Vec3& p, const Vec3& q, const TriangleCorners& t, int side_p, int side_q) {
  if (side_p * side_q > 0) return false;
  if (side_p == 0 && side_q == 0) return coplanar_segment_meets(p, q, t);
  const int a = orientation_3d(p, q, t[0], t[1]), b = orientation_3d(p, q, t[1], t[2]), c = orientation_3d(p, q, t[2], t[0]);
  return !((a > 0 || b > 0 || c > 0) && (a < 0 || b < 0 || c < 0));
}

// The triangle may be a segment or a point.
bool segment_meets_any(const Vec3& p, const Vec3& q, const TriangleCorners& t) {
  const int side_p = orientation_3d(t[0], t[1], t[2], p), side_q = orientation_3d(t[0], t[1], t[2], q);
  if (side_p == 0 && side_q == 0 && collinear(t[0], t[1], t[2])) {
    return segments_meet(p, q, t[0], t[1]) || segments_meet(p, q, t[1], t[2]) || segments_meet(p, q, t[2], t[0]);
  }
  return segment_meets(p, q, t, side_p, side_q);
}

// All of t strictly on one side of the plane of s; by rounded arithmetic.
bool clear_of_plane(const TriangleCorners& s, const TriangleCorners& t, int first) {
  const int side = quick_orientation_3d(s[0], s[1], s[2], t[2]);
  if (side == 0) return false;
  for (int k = first; k < 2; ++k) {
    if (quick_orientation_3d(s[0], s[1], s[2], t[static_cast<std::size_t>(k)]) != side) return false;
  }
  return true;
}

int widest_projection(const TriangleCorners& t) {
  const Vec3 n = glm::abs(glm::cross(t[1] - t[0], t[2] - t[0]));
  return n.x >= n.y && n.x >= n.z ? 0 : n.y >= n.z ? 1 : 2;
}

// An edge of s has s on one side and all of t strictly on the other, in one projection; by rounded arithmetic.
bool clear_of_edges(const TriangleCorners& s, const TriangleCorners& t, int axis) {
  for (int i = 0; i < 3; ++i) {
    const Vec3 &a = s[static_cast<std::size_t>(i)], &b = s[static_cast<std::size_t>((i + 1) % 3)];
    const int own = quick_orientation_2d(a, b, s[static_cast<std::size_t>((i + 2) % 3)], axis);
    if (own == 0) continue;
    if (quick_orientation_2d(a, b, t[0], axis) == -own && quick_orientation_2d(a, b, t[1], axis) == -own &&
        quick_orientation_2d(a, b, t[2], axis) == -own) {
      return true;
    }
  }
  return false;
}

// A side of s at its corner s[0] has s on one side and t, but for that corner, strictly on the other.
bool clear_of_sides(const TriangleCorners& s, const TriangleCorners& t, int axis) {
  const int own = quick_orientation_2d(s[0], s[1], s[2], axis);
  if (own == 0) return false;
  const auto beyond = [&](const Vec3& along, int side) {
    return quick_orientation_2d(s[0], along, t[1], axis) == -side && quick_orientation_2d(s[0], along, t[2], axis) == -side;
  };
  return beyond(s[1], own) || beyond(s[2], -own);
}

}  // namespace

bool triangles_meet(const TriangleCorners& s, const TriangleCorners& t) {
  if (clear_of_plane(s, t, 0) || clear_of_plane(t, s, 0)) return false;
  const int axis = widest_projection(s);
  if (clear_of_edges(s, t, axis) || clear_of_edges(t, s, axis)) return false;
  for (std::size_t i = 0; i < 3; ++i) {
    if (segment_meets_any(s[i], s[(i + 1) % 3], t) || segment_meets_any(t[i], t[(i + 1) % 3], s)) return true;
  }
  return false;
}

bool triangles_meet_beyond_corner(const TriangleCorners& s, const TriangleCorners& t) {
  if (clear_of_plane(s, t, 1) || clear_of_plane(t, s, 1)) return false;
  const int axis = widest_projection(s);
  if (clear_of_sides(s, t, axis) || clear_of_sides(t, s, axis)) return false;
  // Two triangles that share more than the corner share a ray from it, and follow it until it leaves one of them through the
  // side that faces the corner.
  return segment_meets_any(s[1], s[2], t) || segment_meets_any(t[1], t[2], s);
}

bool triangles_meet_beyond_edge(const TriangleCorners& s, const TriangleCorners& t) {
  bool same_side = false;
  for (int axis = 0; axis < 3; ++axis) {
    if (quick_orientation_2d(s[0], s[1], s[2], axis) * quick_orientation_2d(s[0], s[1], t[2], axis) < 0) return false;
  }
  if (orientation_3d(s[0], s[1], s[2], t[2]) != 0) return false;
  for (int axis = 0; axis < 3; ++axis) {
    const int side = orientation_2d(s[0], s[1], s[2], axis) * orientation_2d(s[0], s[1], t[2], axis);
    if (side < 0) return false;
    same_side |= side > 0;
  }
  return same_side;
}

bool triangles_meet_wrongly(const std::vector<Vec3>& positions, const std::array<std::uint32_t, 3>& s,
                            const std::array<std::uint32_t, 3>& t) {
  const auto place = [&](const std::array<std::uint32_t, 3>& c, std::size_t first) {   // turned so that corner `first` leads
    return TriangleCorners{positions[c[first]], positions[c[(first + 1) % 3]], positions[c[(first + 2) % 3]]};
  };
  std::size_t shared = 0, at_s = 0, at_t = 0;
  std::array<bool, 3> in_t{};
  for (std::size_t i = 0; i < 3; ++i) {
    for (std::size_t j = 0; j < 3; ++j) {
      if (s[i] != t[j]) continue;
      ++shared;
      in_t[i] = true;
      at_s = i, at_t = j;
    }
  }
  if (shared == 0) return triangles_meet(place(s, 0), place(t, 0));
  if (shared == 1) return triangles_meet_beyond_corner(place(s, at_s), place(t, at_t));
  if (shared > 2) return true;   // the same triangle twice, or one with a corner twice
  const std::size_t far_s = !in_t[0] ? 0 : !in_t[1] ? 1 : 2;
  const std::uint32_t u = s[(far_s + 1) % 3], v = s[(far_s + 2) % 3];
  const std::size_t far_t = t[0] != u && t[0] != v ? 0 : t[1] != u && t[1] != v ? 1 : 2;
  return triangles_meet_beyond_edge({positions[u], positions[v], positions[s[far_s]]},
                                    {positions[u], positions[v], positions[t[far_t]]});
}

}  // namespace cambium
