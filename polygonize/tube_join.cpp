#include "polygonize/tube_join.h"

#include "polygonize/triangle_contact.h"

#include <algorithm>
#include <cmath>
#include <numbers>

namespace cambium {
namespace {

using Triangle = std::array<std::uint32_t, 3>;
constexpr double kTurn = 2 * std::numbers::pi;
constexpr double kMostTurns = 0.42;      // that a triangle may reach around
constexpr double kClear = 0.05;          // in radii: of an open end from the plane of the ring
constexpr double kHardlyBent = 0.9999;   // cosine between neighbouring segments
constexpr double kChordShares[] = {0.75, 0.2, 0.05};   // of the tolerance: what the surface may stand out over a chord
constexpr double kFarthest = 1.25;       // in tolerances: what is farther from the surface is no use, as in late rounds of refinement

}  // namespace

TubeJoin::TubeJoin(const ChainPath& path, const TubeRing& ring, bool at_end, const Mesh& mesh, const MeshBorder& border,
                   std::uint32_t loop, double tolerance)
    : path_(path), ring_(ring), at_end_(at_end), mesh_(mesh), loop_(border.loops[loop]), triangles_(border.triangles[loop]),
      radius_(path.radius(ring.at)), tolerance_(tolerance) {
  if (at_end) ring_.along = -ring.along;
}

double TubeJoin::nearest(const Vec3& p) const {
  const double reach = 4 * radius_ + glm::distance(p, ring_.center);
  return path_.nearest(p, path_.segment_at(ring_.at - reach), path_.segment_at(ring_.at + reach));
}

TubeJoin::Unrolled TubeJoin::unrolled(const Vec3& p) const {
  const double s = nearest(p);
  const Vec3 out = p - path_.point(s);
  return {std::atan2(glm::dot(out, glm::cross(ring_.along, ring_.side)), glm::dot(out, ring_.side)), at_end_ ? ring_.at - s : s - ring_.at, out};
}

ChainPath::SurfacePoint TubeJoin::rolled(const glm::dvec2& point) const {
  const double angle = point.x / radius_, s = ring_.at + (at_end_ ? -point.y : point.y);
  const Vec3 direction = std::cos(angle) * ring_.side + std::sin(angle) * glm::cross(ring_.along, ring_.side), along = path_.tangent(s);
  return path_.surface(s, glm::normalize(direction - glm::dot(direction, along) * along));
}

// Seen from outside, with the ring above, the sides of triangles run clockwise there: the line is followed the other way.
bool TubeJoin::unroll_line(std::vector<glm::dvec2>& line, std::vector<std::uint32_t>& names) const {
  names.assign(loop_.rbegin(), loop_.rend());
  double angle = 0;
  for (const std::uint32_t vertex : names) {
    const Vec3& p = mesh_.positions[vertex];
    if (glm::dot(p - ring_.center, ring_.along) > -kClear * radius_) return false;
    const Unrolled at = unrolled(p);
    angle = line.empty() ? at.angle : angle + std::remainder(at.angle - angle, kTurn);
    line.emplace_back(radius_ * angle, at.z);
  }
  const double first = line.front().x / radius_, around = angle + std::remainder(first - angle, kTurn) - first;
  return std::abs(around - kTurn) < 1;
}

// Where a triangle is off or in the way of another, shorter chords keep nearer to the surface.
bool TubeJoin::add_to(Tube& tube, std::uint32_t first) const {
  const std::size_t positions = tube.positions.size(), triangles = tube.triangles.size();
  for (const double share : kChordShares) {
    if (add_with_chords(tube, first, share)) return true;
    tube.positions.resize(positions);
    tube.normals.resize(positions);
    tube.triangles.resize(triangles);
  }
  return false;
}

bool TubeJoin::add_with_chords(Tube& tube, std::uint32_t first, double chord_share) const {
  std::vector<glm::dvec2> lower, upper;
  std::vector<std::uint32_t> names;
  if (!unroll_line(lower, names)) return false;
  for (std::uint32_t k = 0; k < ring_.sides; ++k) {
    upper.emplace_back(radius_ * kTurn * k / ring_.sides, 0);
    names.push_back(first + (at_end_ ? (ring_.sides - k) % ring_.sides : k));
  }
  double lowest = 0;
  for (const glm::dvec2& point : lower) lowest = std::min(lowest, point.y);
  const auto found = triangulate_annulus(lower, upper, kTurn * radius_, chord_excess(lowest, chord_share));
  if (!found) return false;
  std::vector<glm::dvec2> points = lower;
  points.insert(points.end(), upper.begin(), upper.end());
  for (const glm::dvec2& point : found->added) {
    points.push_back(point);
    names.push_back(tube.add(rolled(point)));
  }
  const std::size_t begin = tube.triangles.size();
  for (const Triangle& corners : found->triangles) {
    for (int k = 0; k < 3; ++k) {
      const double around = points[corners[k]].x - points[corners[(k + 1) % 3]].x;
      if (std::abs(std::remainder(around, kTurn * radius_)) > kMostTurns * kTurn * radius_) return false;
    }
    tube.triangles.push_back({names[corners[0]], names[corners[1]], names[corners[2]]});
  }
  return keeps_to_surface(tube, begin) && ((is_straight(lowest) && is_graph()) || !crosses(tube, begin, first));
}

// From the ring to the farthest place of the open end.
bool TubeJoin::is_straight(double lowest) const {
  const double other = ring_.at + (at_end_ ? -lowest : lowest);
  const std::size_t first = path_.segment_at(std::min(ring_.at, other)), last = path_.segment_at(std::max(ring_.at, other));
  bool straight = true;
  for (std::size_t k = first; k < last; ++k) straight = straight && glm::dot(path_.direction(k), path_.direction(k + 1)) > kHardlyBent;
  return straight;
}

// What stands out over a chord is to be no more than the tolerance, nor may it reach much farther around than a ring's sides. On a
// straight stretch it is known from how far around it reaches.
ChordExcess TubeJoin::chord_excess(double lowest, double chord_share) const {
  const double most = chord_share * tolerance_, bow = std::min(most / radius_, 1.0);
  const double widest = radius_ * std::min(2 * std::acos(1 - bow), 1.5 * kTurn / ring_.sides);
  const auto around = [widest](const glm::dvec2& a, const glm::dvec2& b) { return std::abs(a.x - b.x) / widest; };
  if (is_straight(lowest)) return around;
  return [this, around, most](const glm::dvec2& a, const glm::dvec2& b) {
    const Vec3 middle = (rolled(a).position + rolled(b).position) / 2.0;
    const double s = ring_.at + (at_end_ ? -1 : 1) * (a.y + b.y) / 2;
    return std::max(around(a, b), std::abs(path_.distance(s, middle)) / most);
  };
}

bool TubeJoin::keeps_to_surface(const Tube& tube, std::size_t begin) const {
  return std::all_of(tube.triangles.begin() + static_cast<std::ptrdiff_t>(begin), tube.triangles.end(), [&](const Triangle& corners) {
    return path_.distance_of(tube.position(mesh_, corners[0]), tube.position(mesh_, corners[1]), tube.position(mesh_, corners[2]), ring_.at) <=
           kFarthest * tolerance_;
  });
}

// Triangles at the open end face away from the axis at every corner: seen from a straight axis none hides another, and the lines between
// what does not cross unrolled do not either.
bool TubeJoin::is_graph() const {
  return std::all_of(triangles_.begin(), triangles_.end(), [&](std::uint32_t t) {
    const Triangle& corners = mesh_.triangles[t];
    const Vec3& a = mesh_.positions[corners[0]];
    const Vec3 normal = glm::cross(mesh_.positions[corners[1]] - a, mesh_.positions[corners[2]] - a);
    return std::all_of(corners.begin(), corners.end(), [&](std::uint32_t v) {
      return glm::dot(normal, unrolled(mesh_.positions[v]).outwards) > 0;
    });
  });
}

std::vector<TubeJoin::Eased> TubeJoin::eased() const {
  std::vector<std::uint32_t> vertices;
  const auto touches = [](const Triangle& triangle, std::uint32_t v) { return std::find(triangle.begin(), triangle.end(), v) != triangle.end(); };
  for (const std::uint32_t t : triangles_) {
    const Triangle& triangle = mesh_.triangles[t];
    if (std::any_of(loop_.begin(), loop_.end(), [&](std::uint32_t v) { return touches(triangle, v); })) {
      vertices.insert(vertices.end(), triangle.begin(), triangle.end());
    }
  }
  std::sort(vertices.begin(), vertices.end());
  vertices.erase(std::unique(vertices.begin(), vertices.end()), vertices.end());
  std::vector<Eased> result;
  for (const std::uint32_t vertex : vertices) {
    Vec3 sum(0.0);
    double corners = 0;
    for (const std::uint32_t t : triangles_) {
      if (!touches(mesh_.triangles[t], vertex)) continue;
      for (const std::uint32_t v : mesh_.triangles[t]) sum += mesh_.positions[v], ++corners;
    }
    const Vec3 middle = sum / corners;
    const double s = nearest(middle);
    result.push_back({vertex, path_.surface(s, glm::normalize(middle - path_.point(s)))});
  }
  return result;
}

bool TubeJoin::is_untangled() const {
  for (std::size_t i = 0; i < triangles_.size(); ++i)
    for (std::size_t j = i + 1; j < triangles_.size(); ++j)
      if (triangles_meet_wrongly(mesh_.positions, mesh_.triangles[triangles_[i]], mesh_.triangles[triangles_[j]])) return false;
  return true;
}

// Exactly: what was added against itself, against the mesh at the open end, and against the tube's walls at the ring, which begins
// with `first`.
bool TubeJoin::crosses(const Tube& tube, std::size_t begin, std::uint32_t first) const {
  std::vector<Vec3> positions;
  std::vector<std::uint32_t> names;   // of these
  std::vector<Triangle> triangles;
  std::vector<Box> boxes;
  const auto add = [&](const Triangle& corners) {
    Triangle renamed;
    Box box;
    for (int k = 0; k < 3; ++k) {
      const auto known = std::find(names.begin(), names.end(), corners[k]);
      renamed[k] = static_cast<std::uint32_t>(known - names.begin());
      if (known == names.end()) {
        names.push_back(corners[k]);
        positions.push_back(tube.position(mesh_, corners[k]));
      }
      box.extend(positions[renamed[k]]);
    }
    triangles.push_back(renamed);
    boxes.push_back(box);
  };
  for (std::size_t t = begin; t < tube.triangles.size(); ++t) add(tube.triangles[t]);
  const std::size_t added = triangles.size();
  for (const std::uint32_t t : triangles_) add(mesh_.triangles[t]);
  const auto is_of_ring = [&](std::uint32_t vertex) { return vertex >= first && vertex - first < ring_.sides; };
  for (std::size_t t = 0; t < begin; ++t)
    if (std::any_of(tube.triangles[t].begin(), tube.triangles[t].end(), is_of_ring)) add(tube.triangles[t]);
  for (std::size_t s = 0; s < added; ++s)
    for (std::size_t t = s + 1; t < triangles.size(); ++t)
      if (boxes[s].intersects(boxes[t]) && triangles_meet_wrongly(positions, triangles[s], triangles[t])) return true;
  return false;
}

}  // namespace cambium
