#include "polygonize/vertex_balance.h"

#include "polygonize/patch_vertices.h"
#include "polygonize/polygon_ring.h"

#include <tbb/blocked_range.h>
#include <tbb/parallel_for.h>

#include <algorithm>
#include <cmath>

namespace cambium {
namespace {

constexpr std::size_t kGrain = 4096;
constexpr float kSharpCare = 1.6f;   // where the surface turns, it may be farther off elsewhere than where that is measured

/// How far outside of a polygon's mean plane the surface is where it crosses the polygon's edge, metres. Of a polygon that is folded
/// flat, the distance to the nearest corner.
double height_over(const Ring& ring, const std::vector<Vec3>& positions, const Vec3& x) {
  std::array<Vec3, 4> p;
  Vec3 mean(0.0);
  double nearest = kInfinity;
  for (int k = 0; k < ring.count; ++k) {
    p[k] = positions[ring.patches[k]] - x;
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
  if (a.crease || b.crease || glm::dot(a.normal, b.normal) < 0.5f) return 0;
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

/// Whether the surface turns by more than 60 degrees from a corner to the next.
bool is_sharp(const Ring& ring, const Contour& contour) {
  for (int k = 0; k < ring.count; ++k) {
    const std::uint32_t p = ring.patches[k], q = ring.patches[(k + 1) % ring.count];
    if (glm::dot(contour.vertices[p].normal, contour.vertices[q].normal) < 0.5f) return true;
  }
  return false;
}

/// Between corners whose normals differ too much for that, none of them on a crease: an eighth of length times angle, the arrow of an
/// arc, metres. 0 where there are none.
float across_a_bend(const Ring& ring, const Contour& contour, const std::vector<Vec3>& positions) {
  double most = 0;
  for (int k = 0; k < ring.count; ++k) {
    const std::uint32_t p = ring.patches[k], q = ring.patches[(k + 1) % ring.count];
    const PatchVertex &a = contour.vertices[p], &b = contour.vertices[q];
    const double cosine = static_cast<double>(glm::dot(a.normal, b.normal));
    if (a.crease || b.crease || cosine >= 0.5) continue;
    most = std::max(most, std::acos(std::max(cosine, -1.0)) * glm::length(positions[p] - positions[q]) / 8);
  }
  return static_cast<float>(most);
}

class Marks {
 public:
  explicit Marks(std::size_t n) : marked_(n, 0) {}
  void mark(std::uint32_t i) { marked_[i] = 1; }
  std::vector<std::uint32_t> ascending() const {
    std::vector<std::uint32_t> list;
    for (std::uint32_t i = 0; i < marked_.size(); ++i)
      if (marked_[i]) list.push_back(i);
    return list;
  }

 private:
  std::vector<std::uint8_t> marked_;
};

std::vector<std::uint32_t> edges_of(const Contour& contour, const std::vector<std::uint32_t>& patches) {
  Marks marks(contour.edges.size());
  for (const std::uint32_t p : patches)
    for (const std::uint32_t e : contour.ring(p)) marks.mark(e);
  return marks.ascending();
}

std::vector<std::uint32_t> patches_around(const Contour& contour, const std::vector<std::uint32_t>& edges) {
  Marks marks(contour.patches.size());
  for (const std::uint32_t e : edges)
    for (const std::uint32_t p : contour.patch_of_quadrant[e]) marks.mark(p);
  return marks.ascending();
}

template <class Body>
void for_each(const std::vector<std::uint32_t>& list, Body&& body) {
  tbb::parallel_for(tbb::blocked_range<std::size_t>(0, list.size(), kGrain), [&](const auto& range) {
    for (std::size_t i = range.begin(); i < range.end(); ++i) body(list[i]);
  });
}

}  // namespace

void VertexBalance::update(const SurfaceOctree& tree, const Contour& contour, const std::vector<std::uint32_t>& new_patches) {
  on_surface_.resize(contour.patches.size());
  positions_.resize(contour.patches.size());
  heights_.resize(contour.edges.size());
  errors_.resize(contour.edges.size());
  for (const std::uint32_t p : new_patches) on_surface_[p] = contour.vertices[p].position;
  const auto height = [&](std::uint32_t e, const std::vector<Vec3>& positions) {
    return static_cast<float>(
        height_over(ring_of(contour.edges[e], contour.patch_of_quadrant[e]), positions, crossing_point(tree, contour, e)));
  };
  const std::vector<std::uint32_t> edges = edges_of(contour, new_patches);
  for_each(edges, [&](std::uint32_t e) { heights_[e] = height(e, on_surface_); });
  const std::vector<std::uint32_t> patches = patches_around(contour, edges);
  for_each(patches, [&](std::uint32_t p) {
    positions_[p] = on_surface_[p];
    if (contour.vertices[p].crease) return;
    double sum = 0;
    for (const std::uint32_t e : contour.ring(p)) {
      if (!bends(contour, e)) sum += static_cast<double>(heights_[e]);
    }
    const double outwards = std::clamp(0.5 * sum / contour.patches[p].edge_count, -0.5 * tolerance_, 0.5 * tolerance_);
    const OctreeLeaf& leaf = tree.leaves()[contour.patches[p].leaf];
    const Box box = tree.box(leaf);
    const double margin = kVertexMargin * tree.edge(leaf);
    positions_[p] = glm::clamp(on_surface_[p] + outwards * Vec3(contour.vertices[p].normal), box.lo + margin, box.hi - margin);
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
    float error = std::abs(height(e, positions_)) + 0.1f * static_cast<float>(glm::length(positions_[v[0]] - positions_[v[2 % ring.count]]));
    if (ring.count == 4) {
      error = std::min({error, std::max(static_cast<float>(fit.error[0]), off_between(v[0], v[2])),
                        std::max(static_cast<float>(fit.error[1]), off_between(v[1], v[3]))});
    } else {
      error = std::min(error, static_cast<float>(fit.error[0]));
    }
    for (int k = 0; k < ring.count; ++k) error = std::max(error, off_between(v[k], v[(k + 1) % ring.count]));
    if (is_sharp(ring, contour)) error *= kSharpCare;
    errors_[e] = std::max(error, across_a_bend(ring, contour, positions_));
  });
}

}  // namespace cambium
