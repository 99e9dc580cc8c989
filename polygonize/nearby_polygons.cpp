#include "polygonize/nearby_polygons.h"

#include "polygonize/mesh_distance.h"

#include <algorithm>
#include <cmath>

namespace cambium {

PatchesOfLeaves::PatchesOfLeaves(const Contour& contour, std::size_t leaves) : first_(leaves + 1, 0) {
  for (const Patch& patch : contour.patches)
    if (patch.alive()) ++first_[patch.leaf + 1];
  for (std::size_t i = 0; i < leaves; ++i) first_[i + 1] += first_[i];
  patches_.resize(first_.back());
  std::vector<std::uint32_t> next(first_.begin(), first_.end() - 1);
  for (std::uint32_t p = 0; p < contour.patches.size(); ++p)
    if (contour.patches[p].alive()) patches_[next[contour.patches[p].leaf]++] = p;
}

namespace {

/// From a point in a box to its boundary.
double clearance(const Vec3& p, const Box& box) {
  return std::min({p.x - box.lo.x, p.y - box.lo.y, p.z - box.lo.z, box.hi.x - p.x, box.hi.y - p.y, box.hi.z - p.z});
}

}  // namespace

double NearbyPolygons::distance(const Vec3& p, double enough) {
  double least = distance_here(p, enough);
  while (least > enough && widen()) least = distance_here(p, enough);
  return least;
}

double NearbyPolygons::distance_to_vertex(const Vec3& p, const Box& in) {
  double least = distance_to_vertex_here(p, in);
  while (least > clearance(p, box_) && !(box_.contains(in.lo) && box_.contains(in.hi)) && widen()) least = distance_to_vertex_here(p, in);
  return least;
}

double NearbyPolygons::distance_here(const Vec3& p, double enough) {
  const Box everywhere{Vec3(-kInfinity), Vec3(kInfinity)};
  double least = distance_to_vertex_here(p, everywhere);
  if (least <= enough) return least;
  if (!knows_triangles_) find_triangles();
  for (const Triangle& t : triangles_) {
    const double possible = least + t.around.radius;
    const Vec3 away = p - t.around.center;
    if (glm::dot(away, away) < possible * possible) least = std::min(least, std::sqrt(distance2_to_triangle(p, t.a, t.b, t.c)));
  }
  return least;
}

double NearbyPolygons::distance_to_vertex_here(const Vec3& p, const Box& in) {
  if (!knows_patches_) find_patches();
  double least = kInfinity;
  for (const std::uint32_t patch : near_)
    if (const Vec3& v = positions_[patch]; in.contains(v)) least = std::min(least, glm::dot(v - p, v - p));
  return std::sqrt(least);
}

void NearbyPolygons::find_patches() {
  knows_patches_ = true;
  near_.clear();
  SurfaceOctree::Node node = tree_.root();
  GridCube cube{{0, 0, 0}, tree_.root_level()};
  while (node.has_children()) {   // down to where the box lies in several
    const Vec3 middle = tree_.grid().box(cube.place, cube.level).center();
    std::uint32_t child = 0;
    bool lies_in_one = true;
    for (int a = 0; a < 3; ++a) {
      if (box_.lo[a] > middle[a]) child |= 1u << a;
      lies_in_one = lies_in_one && (box_.lo[a] > middle[a] || box_.hi[a] < middle[a]);
    }
    if (!lies_in_one) break;
    node = tree_.child(node, static_cast<int>(child));
    cube = cube.part(child);
  }
  append_patches(node, cube);
}

void NearbyPolygons::append_patches(SurfaceOctree::Node node, const GridCube& cube) {
  if (node.is_void() || !tree_.grid().box(cube.place, cube.level).intersects(box_)) return;
  if (node.has_children()) {
    for (std::uint32_t c = 0; c < 8; ++c) append_patches(tree_.child(node, static_cast<int>(c)), cube.part(c));
    return;
  }
  const auto patches = patches_of_.of(node.leaf());
  near_.insert(near_.end(), patches.begin(), patches.end());
}

void NearbyPolygons::find_triangles() {
  if (!knows_patches_) find_patches();
  knows_triangles_ = true;
  edges_.clear();
  triangles_.clear();
  for (const std::uint32_t p : near_) {
    const auto ring = contour_.ring(p);
    edges_.insert(edges_.end(), ring.begin(), ring.end());
  }
  std::sort(edges_.begin(), edges_.end());
  edges_.erase(std::unique(edges_.begin(), edges_.end()), edges_.end());
  for (const std::uint32_t e : edges_) {
    const Polygon& polygon = polygon_of(e);
    triangles_.insert(triangles_.end(), polygon.triangles.begin(), polygon.triangles.begin() + static_cast<std::ptrdiff_t>(polygon.count));
  }
}

void NearbyPolygons::Polygon::add(const Vec3& a, const Vec3& b, const Vec3& c) {
  const Vec3 middle = (a + b + c) / 3.0;
  const double farthest2 = std::max({glm::dot(a - middle, a - middle), glm::dot(b - middle, b - middle), glm::dot(c - middle, c - middle)});
  triangles[count++] = {a, b, c, {middle, std::sqrt(farthest2)}};
}

// Each is near several leaves, which come one after another.
const NearbyPolygons::Polygon& NearbyPolygons::polygon_of(std::uint32_t edge) {
  Polygon& kept = kept_[edge % kept_.size()];
  if (kept.edge != edge) {
    kept.edge = edge;
    kept.count = 0;
    cut(edge, kept);
  }
  return kept;
}

void NearbyPolygons::cut(std::uint32_t edge, Polygon& polygon) const {
  const auto& patches = contour_.patch_of_quadrant[edge];
  if (std::find(patches.begin(), patches.end(), kNoPatch) != patches.end()) return;   // the surface ends here
  const Ring ring = ring_of(contour_.edges[edge], patches);
  const auto corner = [&](int k) { return positions_[ring.patches[k % ring.count]]; };
  const Split split =
      placed_.splits[edge] ? *placed_.splits[edge] : split_of(tree_, contour_, edge, ring, positions_, placed_.tolerance);
  if (split == Split::kFan) {
    const Vec3 center = crossing_point(tree_, contour_, edge);
    for (int k = 0; k < ring.count; ++k) polygon.add(center, corner(k), corner(k + 1));
  } else {
    const int first = split == Split::kSecond ? 1 : 0;
    for (int k = 2; k < ring.count; ++k) polygon.add(corner(first), corner(first + k - 1), corner(first + k));
  }
}

}  // namespace cambium
