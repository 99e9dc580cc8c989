#include "polygonize/vertex_balance.h"

#include "polygonize/crowded_leaves.h"
#include "polygonize/marks.h"
#include "polygonize/patch_vertices.h"
#include "polygonize/polygon_distance.h"

#include <tbb/blocked_range.h>
#include <tbb/parallel_for.h>

#include <algorithm>
#include <cmath>

namespace cambium {
namespace {

constexpr std::size_t kGrain = 4096;
// Polygons that may bow by more than this share of the tolerance are measured. On the poplar at 1 mm 0.5 measures a third of them and
// leaves no sample beyond 1.34 tolerances, 0.7 a sixth and no other; 1 leaves some beyond 2.
constexpr double kDoubt = 0.7;

/// How far outside of a polygon's mean plane the surface is where it crosses the polygon's edge, metres. Of a polygon that is folded
/// flat, the distance to the nearest corner.
template <class PositionOf>
double height_over(const Ring& ring, PositionOf&& position_of, const Vec3& x) {
  std::array<Vec3, 4> p;
  Vec3 mean(0.0);
  double nearest = kInfinity;
  for (int k = 0; k < ring.count; ++k) {
    p[k] = position_of(ring.patches[k]) - x;
    mean += p[k];
    nearest = std::min(nearest, glm::length(p[k]));
  }
  mean /= static_cast<double>(ring.count);
  const Vec3 area = ring.count == 3 ? glm::cross(p[1] - p[0], p[2] - p[0]) : glm::cross(p[2] - p[0], p[3] - p[1]);
  const double length = glm::length(area);
  const double height = length > 0 ? -glm::dot(mean, area) / length : kInfinity;
  return std::abs(height) < nearest ? height : std::copysign(nearest, height);
}

/// How far the surface is from the middle of the chord between two vertices, metres, as their normals tell; 0 where they do not, on
/// creases. p and q: where the vertices are now.
double chord_error(const PatchVertex& a, const PatchVertex& b, const Vec3& p, const Vec3& q) {
  if (!chord_known(a, b)) return 0;
  const Vec3 n(a.normal), m(b.normal);
  const double outwards = (glm::dot(p - a.position, n) + glm::dot(q - b.position, m)) / 2;
  return std::abs(glm::dot(m - n, b.position - a.position) / 8 - outwards);
}

/// A polygon over a crease that its vertices are not on: it lies across the edge, and moving them out would bulge the sheets.
bool bends(const Contour& contour, std::uint32_t edge) {
  constexpr float kBent = 0.5f;   // cosine; a twig of six sides turns by 30 degrees from a vertex to its edges
  for (const std::uint32_t patch : contour.patch_of_quadrant[edge]) {
    const PatchVertex& vertex = contour.vertices[patch];
    if (!vertex.crease && glm::dot(vertex.normal, contour.crossings[edge].normal) < kBent) return true;
  }
  return false;
}

/// How far the surface may be from where it is known between corners, metres: an eighth of length times angle, the arrow of an arc.
/// Infinite where the normals tell nothing.
double bow_of(const Ring& ring, const Contour& contour, std::uint32_t edge, const std::vector<Vec3>& positions) {
  float turn = 0;
  double size = 0;
  for (int k = 0; k < ring.count; ++k) {
    const PatchVertex& vertex = contour.vertices[ring.patches[k]];
    if (!chord_known(vertex, contour.vertices[ring.patches[(k + 1) % ring.count]])) return kInfinity;
    turn = std::max(turn, glm::length(vertex.normal - contour.crossings[edge].normal));
    for (int j = 0; j < k; ++j) {
      turn = std::max(turn, glm::length(vertex.normal - contour.vertices[ring.patches[j]].normal));
      size = std::max(size, glm::length(positions[ring.patches[k]] - positions[ring.patches[j]]));
    }
  }
  return static_cast<double>(turn) * size / 8;
}

/// What to try after a split that is off: the other diagonal first, if it fits, then the fan.
std::optional<Split> next_split(Split split, const std::array<bool, 2>& fitting, int turn) {
  if (split == Split::kFan) return std::nullopt;
  if (turn == 0 && fitting[split == Split::kFirst]) return split == Split::kFirst ? Split::kSecond : Split::kFirst;
  return Split::kFan;
}

template <class Body>
void for_each(const std::vector<std::uint32_t>& list, Body&& body) {
  tbb::parallel_for(tbb::blocked_range<std::size_t>(0, list.size(), kGrain), [&](const auto& range) {
    for (std::size_t i = range.begin(); i < range.end(); ++i) body(list[i]);
  });
}

std::vector<std::uint32_t> edges_of(const Contour& contour, const std::vector<std::uint32_t>& patches) {
  Marks marks(contour.edges.size());
  for_each(patches, [&](std::uint32_t p) {
    for (const std::uint32_t e : contour.ring(p)) marks.add(e);
  });
  return marks.ascending();
}

std::vector<std::uint32_t> patches_around(const Contour& contour, const std::vector<std::uint32_t>& edges) {
  Marks marks(contour.patches.size());
  for_each(edges, [&](std::uint32_t e) {
    for (const std::uint32_t p : contour.patch_of_quadrant[e]) marks.add(p);
  });
  return marks.ascending();
}

}  // namespace

bool VertexBalance::update(const SurfaceOctree& tree, const SurfaceCover& cover, const Contour& contour,
                           const std::vector<std::uint32_t>& new_patches, const RunOptions& run) {
  positions_.resize(contour.patches.size());
  heights_.resize(contour.edges.size());
  errors_.resize(contour.edges.size());
  splits_.resize(contour.edges.size());
  const auto on_surface = [&](std::uint32_t p) {
    return is_crowded(contour, p) ? crowded_position(tree, contour, p) : contour.vertices[p].position;
  };
  const auto moved = [&](std::uint32_t p) { return positions_[p]; };
  const auto height = [&](std::uint32_t e, const auto& position_of) {
    return static_cast<float>(
        height_over(ring_of(contour.edges[e], contour.patch_of_quadrant[e]), position_of, crossing_point(tree, contour, e)));
  };
  const std::vector<std::uint32_t> edges = edges_of(contour, new_patches);
  for_each(edges, [&](std::uint32_t e) { heights_[e] = height(e, on_surface); });
  const std::vector<std::uint32_t> patches = patches_around(contour, edges);
  for_each(patches, [&](std::uint32_t p) {
    positions_[p] = on_surface(p);
    if (contour.vertices[p].crease || is_crowded(contour, p)) return;
    double sum = 0;
    for (const std::uint32_t e : contour.ring(p)) {
      if (!bends(contour, e)) sum += static_cast<double>(heights_[e]);
    }
    const double outwards = std::clamp(0.5 * sum / contour.patches[p].edge_count, -0.5 * tolerance_, 0.5 * tolerance_);
    const OctreeLeaf& leaf = tree.leaves()[contour.patches[p].leaf];
    const Box box = tree.box(leaf);
    const double margin = kVertexMargin * tree.edge(leaf);
    positions_[p] = glm::clamp(positions_[p] + outwards * Vec3(contour.vertices[p].normal), box.lo + margin, box.hi - margin);
  });
  changed_edges_ = edges_of(contour, patches);
  // On a saddle the middle of a polygon may be on the surface while its sides are off on either hand.
  const auto off_between = [&](std::uint32_t p, std::uint32_t q) {
    return static_cast<float>(chord_error(contour.vertices[p], contour.vertices[q], positions_[p], positions_[q]));
  };
  for_each(changed_edges_, [&](std::uint32_t e) {
    const Ring ring = ring_of(contour.edges[e], contour.patch_of_quadrant[e]);
    const auto& v = ring.patches;
    const PolygonFit fit = polygon_fit(ring, positions_, crossing_point(tree, contour, e), contour.edges[e].axis);
    // Of a polygon that its edge misses only the plane is known, and it may be off by a part of its size more.
    float error = std::abs(height(e, moved)) + 0.1f * static_cast<float>(glm::length(positions_[v[0]] - positions_[v[2 % ring.count]]));
    if (ring.count == 4) {
      error = std::min({error, std::max(static_cast<float>(fit.error[0]), off_between(v[0], v[2])),
                        std::max(static_cast<float>(fit.error[1]), off_between(v[1], v[3]))});
    } else {
      error = std::min(error, static_cast<float>(fit.error[0]));
    }
    for (int k = 0; k < ring.count; ++k) error = std::max(error, off_between(v[k], v[(k + 1) % ring.count]));
    errors_[e] = error;
  });
  return measure(tree, cover, contour, run);
}

void VertexBalance::keep(const Living& living) {
  keep_listed(positions_, living.patches);
  keep_listed(heights_, living.edges);
  keep_listed(errors_, living.edges);
  keep_listed(splits_, living.edges);
  changed_edges_ = {};
}

// Polygons that the surface may leave between the places where it is known are measured as they will be cut: by the diagonal that
// suits best, then by the other one, and at last as a fan, until one is within the tolerance.
bool VertexBalance::measure(const SurfaceOctree& tree, const SurfaceCover& cover, const Contour& contour, const RunOptions& run) {
  const auto ring_at = [&](std::uint32_t e) { return ring_of(contour.edges[e], contour.patch_of_quadrant[e]); };
  for_each(changed_edges_, [&](std::uint32_t e) {
    splits_[e].reset();
    const Ring ring = ring_at(e);
    if (!(static_cast<double>(errors_[e]) < kAim * tolerance_ && bow_of(ring, contour, e, positions_) > kDoubt * tolerance_)) return;
    const auto end = ring.patches.begin() + ring.count;
    const bool fan = std::any_of(ring.patches.begin(), end, [&](std::uint32_t p) { return is_crowded(contour, p); });
    splits_[e] = fan ? Split::kFan : split_of(tree, contour, e, ring, positions_, tolerance_);
  });
  std::vector<SplitPolygon> polygons;
  std::vector<float> distances, best;
  for (const std::uint32_t e : changed_edges_)
    if (splits_[e]) polygons.push_back({e, *splits_[e]});
  for (int turn = 0; !polygons.empty(); ++turn) {
    if (!measure_polygons(tree, cover, contour, positions_, polygons, distances, run)) return false;
    std::size_t kept = 0;
    for (std::size_t i = 0; i < polygons.size(); ++i) {
      const auto [e, split] = polygons[i];
      float off = std::max(distances[i], errors_[e]);
      std::optional<Split> next;
      if (static_cast<double>(off) > kAim * tolerance_) {
        next = next_split(split, fitting_splits(tree, contour, e, ring_at(e), positions_), turn);
      }
      if (turn == 0 || off < best[i]) {
        splits_[e] = split;
      } else {
        off = best[i];
      }
      if (!next) {
        errors_[e] = off;
        continue;
      }
      polygons[kept] = {e, *next};
      distances[kept++] = off;
    }
    polygons.resize(kept);
    best.assign(distances.begin(), distances.begin() + static_cast<std::ptrdiff_t>(kept));
  }
  return true;
}

}  // namespace cambium
