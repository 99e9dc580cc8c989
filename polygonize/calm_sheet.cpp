#include "polygonize/calm_sheet.h"

#include <tbb/blocked_range.h>
#include <tbb/parallel_for.h>

#include <algorithm>

namespace cambium {
namespace {

constexpr std::size_t kGrain = 4096;
constexpr float kEven = 0.7f;      // cosine between the normals of patches that share a polygon
constexpr double kUpward = 0.5;    // and between those of a triangle and of its corners
constexpr double kRounding = 1e-9;

template <class Body>
void for_each_below(std::size_t n, Body&& body) {
  tbb::parallel_for(tbb::blocked_range<std::size_t>(0, n, kGrain), [&](const auto& range) {
    for (std::size_t i = range.begin(); i < range.end(); ++i) body(static_cast<std::uint32_t>(i));
  });
}

/// Of the way from + t along, t in [0, 1]: what lies in a box. None: its end is below its begin.
struct Way {
  double begin = 0, end = 1;
  bool operator<(const Way& other) const { return begin < other.begin; }
};

Way way_through(const Box& box, const Vec3& from, const Vec3& along) {
  Way way;
  for (int a = 0; a < 3; ++a) {
    if (along[a] == 0) {
      if (from[a] < box.lo[a] || from[a] > box.hi[a]) way.end = -1;
      continue;
    }
    const double s = (box.lo[a] - from[a]) / along[a], t = (box.hi[a] - from[a]) / along[a];
    way.begin = std::max(way.begin, std::min(s, t));
    way.end = std::min(way.end, std::max(s, t));
  }
  return way;
}

}  // namespace

CalmSheet::CalmSheet(const SurfaceOctree& tree, const Contour& contour, const std::vector<Vec3>& positions,
                     const std::vector<std::optional<Split>>& splits, const std::vector<bool>& crowded)
    : tree_(tree), contour_(contour), positions_(positions), splits_(splits), crowded_(crowded), upward_(contour.edges.size()),
      apart_(contour.patches.size()), calm_(contour.patches.size()) {
  for_each_below(upward_.size(), [&](std::uint32_t e) { upward_[e] = upward_split(e); });
  for_each_below(apart_.size(), [&](std::uint32_t p) { apart_[p] = is_apart(p); });
  for_each_below(calm_.size(), [&](std::uint32_t p) {
    const auto ring = contour_.ring(p);
    calm_[p] = is_even(p) && std::all_of(ring.begin(), ring.end(), [&](std::uint32_t e) { return upward_[e].has_value(); });
  });
}

std::vector<Vec3> CalmSheet::points_around(std::uint32_t patch) const {
  std::vector<Vec3> points;
  for (const std::uint32_t e : contour_.ring(patch)) {
    points.push_back(crossing_point(tree_, contour_, e));
    for (const std::uint32_t other : contour_.patch_of_quadrant[e]) points.push_back(positions_[other]);
  }
  return points;
}

// Patches of one leaf stand together.
bool CalmSheet::is_apart(std::uint32_t patch) const {
  if (!crowded_[patch]) return true;
  const auto beside = [&](std::size_t p) { return p < contour_.patches.size() && contour_.patches[p].leaf == contour_.patches[patch].leaf; };
  for (std::uint32_t p = patch; p > 0 && beside(p - 1); --p)
    if (!is_apart_from(patch, p - 1)) return false;
  for (std::uint32_t p = patch + 1; beside(p); ++p)
    if (!is_apart_from(patch, p)) return false;
  return true;
}

bool CalmSheet::is_apart_from(std::uint32_t patch, std::uint32_t other) const {
  const std::vector<Vec3> own = points_around(patch), others = points_around(other);
  const Vec3 n(contour_.vertices[patch].normal), m(contour_.vertices[other].normal);
  const auto parts = [&](const Vec3& direction) {
    double highest = -kInfinity, lowest = kInfinity;
    for (const Vec3& p : own) highest = std::max(highest, glm::dot(direction, p - own[0]));
    for (const Vec3& p : others) lowest = std::min(lowest, glm::dot(direction, p - own[0]));
    return highest < lowest;
  };
  return parts(n - m) || parts(m - n) || parts(n) || parts(-n) || parts(m) || parts(-m);
}

bool CalmSheet::is_even(std::uint32_t patch) const {
  const PatchVertex& vertex = contour_.vertices[patch];
  if (contour_.patches[patch].open) return false;
  const auto is_like = [&](std::uint32_t other) {
    const PatchVertex& there = contour_.vertices[other];
    return apart_[other] && !there.crease && glm::dot(vertex.normal, there.normal) > kEven;
  };
  const auto ring = contour_.ring(patch);
  return std::all_of(ring.begin(), ring.end(), [&](std::uint32_t e) {
    const auto& around = contour_.patch_of_quadrant[e];
    return std::all_of(around.begin(), around.end(), is_like);
  });
}

bool CalmSheet::faces_up(std::uint32_t patch, const std::array<Vec3, 3>& corners) const {
  const Vec3 area = glm::cross(corners[1] - corners[0], corners[2] - corners[0]);
  return glm::dot(area, Vec3(contour_.vertices[patch].normal)) > kUpward * glm::length(area);
}

// Of two that do, the one with the shorter diagonal.
std::optional<Split> CalmSheet::upward_split(std::uint32_t edge) const {
  const std::optional<Split>& measured = splits_[edge];
  const Ring ring = ring_of(contour_.edges[edge], contour_.patch_of_quadrant[edge]);
  const auto& v = ring.patches;
  const auto up = [&](int i, int j, int k) {
    const std::array<Vec3, 3> corners{positions_[v[i]], positions_[v[j]], positions_[v[k]]};
    return faces_up(v[i], corners) && faces_up(v[j], corners) && faces_up(v[k], corners);
  };
  const bool first = (!measured || measured == Split::kFirst) && up(0, 1, 2) && (ring.count == 3 || up(0, 2, 3));
  const bool second = (!measured || measured == Split::kSecond) && ring.count == 4 && up(1, 2, 3) && up(1, 3, 0);
  if (first && second) {
    return glm::distance(positions_[v[0]], positions_[v[2]]) <= glm::distance(positions_[v[1]], positions_[v[3]]) ? Split::kFirst : Split::kSecond;
  }
  if (first) return Split::kFirst;
  return second ? std::optional(Split::kSecond) : std::nullopt;
}

std::optional<Split> CalmSheet::split(std::uint32_t edge) const {
  const auto& around = contour_.patch_of_quadrant[edge];
  const bool calm = std::all_of(around.begin(), around.end(), [&](std::uint32_t patch) { return calm_[patch] != 0; });
  return calm ? upward_[edge] : std::nullopt;
}

bool CalmSheet::keeps_among(const std::array<std::uint32_t, 2>& edges, const std::array<std::uint32_t, 2>& patches) const {
  const Vec3 &from = positions_[patches[0]], along = positions_[patches[1]] - from;
  std::vector<Way> ways;
  for (const std::uint32_t e : edges)
    for_each_leaf(contour_.edges[e], [&](std::uint32_t leaf) { ways.push_back(way_through(tree_.box(tree_.leaves()[leaf]), from, along)); });
  std::sort(ways.begin(), ways.end());
  double reached = 0;
  for (const Way& way : ways) {
    if (way.begin > way.end) continue;
    if (way.begin > reached + kRounding) return false;
    reached = std::max(reached, way.end);
  }
  return reached > 1 - kRounding;
}

}  // namespace cambium
