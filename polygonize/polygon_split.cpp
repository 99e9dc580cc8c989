#include "polygonize/polygon_split.h"

#include <algorithm>
#include <cmath>

namespace cambium {
namespace {

/// Whether the segment p-q passes between the edge and the vertex v within the triangle that they span.
bool passes(const EdgeFrame& frame, const Vec3& p, const Vec3& q, const Vec3& v) {
  const double side_p = cross2(v, p), side_q = cross2(v, q);
  if (!((side_p > 0 && side_q < 0) || (side_p < 0 && side_q > 0))) return false;
  const Vec3 y = p + (q - p) * (side_p / (side_p - side_q));
  const double s = (y.x * v.x + y.y * v.y) / (v.x * v.x + v.y * v.y);
  if (!(s > 0 && s < 1)) return false;
  return y.z > frame.low + s * (v.z - frame.low) && y.z < frame.high + s * (v.z - frame.high);
}

/// Both triangles that the diagonal p-r makes of the quad p q r s stay inside the quad's envelope.
bool diagonal_fits(const EdgeFrame& frame, const Vec3& p, const Vec3& q, const Vec3& r, const Vec3& s) {
  if (const auto height = pierced_at(p, q, r)) return *height > frame.low && *height < frame.high && passes(frame, p, r, s);
  if (const auto height = pierced_at(p, r, s)) return *height > frame.low && *height < frame.high && passes(frame, p, r, q);
  return false;
}

// How well a pair of triangles does: shape first, then how little it bends across the diagonal.
double diagonal_score(const Vec3& a, const Vec3& b, const Vec3& c, const Vec3& d) {   // diagonal a-c
  const auto quality = [](const Vec3& p, const Vec3& q, const Vec3& r, Vec3& normal) {
    normal = glm::cross(q - p, r - p);
    const double doubled_area = glm::length(normal);
    const double longest = std::max({glm::dot(q - p, q - p), glm::dot(r - q, r - q), glm::dot(p - r, p - r)});
    if (!(doubled_area > 0)) return 0.0;
    normal /= doubled_area;
    return doubled_area / longest;
  };
  Vec3 first, second;
  const double worst = std::min(quality(a, b, c, first), quality(a, c, d, second));
  return worst * (1.1 + glm::dot(first, second));
}

std::array<Vec3, 4> corners_in(const EdgeFrame& frame, const Ring& ring, const std::vector<Vec3>& positions) {
  std::array<Vec3, 4> p;
  for (int k = 0; k < ring.count; ++k) p[k] = frame.local(positions[ring.patches[k]]);
  return p;
}

std::array<bool, 2> fitting(const EdgeFrame& frame, const Ring& ring, const std::array<Vec3, 4>& p) {
  if (ring.count == 4) return {diagonal_fits(frame, p[0], p[1], p[2], p[3]), diagonal_fits(frame, p[1], p[2], p[3], p[0])};
  const auto height = pierced_at(p[0], p[1], p[2]);
  return {height && *height > frame.low && *height < frame.high, false};
}

// Of two diagonals that fit: the one that is closer to the surface where one of them is off (along a crease, say, the other way
// cuts it), else the one with the better triangles.
bool other_is_better(const SurfaceOctree& tree, const Contour& contour, std::uint32_t e, const Ring& ring,
                     const std::vector<Vec3>& positions, double tolerance, const std::array<Vec3, 4>& p) {
  const PolygonFit fit = polygon_fit(ring, positions, crossing_point(tree, contour, e), contour.edges[e].axis);
  if (fit.error[0] > tolerance / 2 && fit.error[1] < fit.error[0]) return true;
  if (fit.error[1] > tolerance / 2 && fit.error[0] < fit.error[1]) return false;
  const auto bow = [&](int k, int j) {   // over the chord, eight times, as the normals tell
    const PatchVertex &a = contour.vertices[ring.patches[k]], &b = contour.vertices[ring.patches[j]];
    return a.crease || b.crease ? 0 : std::abs(glm::dot(Vec3(b.normal - a.normal), b.position - a.position));
  };
  const double one = bow(0, 2), other = bow(1, 3), larger = std::max(one, other);
  if (larger > 0.01 * glm::length(p[2] - p[0]) && std::min(one, other) < 0.75 * larger) return other < one;
  return diagonal_score(p[1], p[2], p[3], p[0]) > diagonal_score(p[0], p[1], p[2], p[3]);
}

}  // namespace

std::array<bool, 2> fitting_splits(const SurfaceOctree& tree, const Contour& contour, std::uint32_t edge, const Ring& ring,
                                   const std::vector<Vec3>& positions) {
  const EdgeFrame frame(tree, contour.edges[edge]);
  return fitting(frame, ring, corners_in(frame, ring, positions));
}

Split split_of(const SurfaceOctree& tree, const Contour& contour, std::uint32_t edge, const Ring& ring,
               const std::vector<Vec3>& positions, double tolerance) {
  const EdgeFrame frame(tree, contour.edges[edge]);
  const std::array<Vec3, 4> p = corners_in(frame, ring, positions);
  const auto [first, second] = fitting(frame, ring, p);
  if (!first && !second) return Split::kFan;
  return !first || (second && other_is_better(tree, contour, edge, ring, positions, tolerance, p)) ? Split::kSecond : Split::kFirst;
}

}  // namespace cambium
