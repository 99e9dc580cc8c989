// The surface on an octree: where it crosses minimal edges, the patches these crossings form on the leaves, and their vertices.
#pragma once

#include "polygonize/surface_patches.h"

#include <compare>

namespace cambium {

/// Where the surface crosses a minimal edge.
struct Crossing {
  float t = 0.5f;              ///< along the edge from its low end, strictly within
  glm::vec3 normal{0.0f};      ///< unit, outward; zero where the field has no gradient
};

/// One cycle on the boundary of one leaf, or part of one that ends beside nothing (a tube).
struct Patch {
  static constexpr std::uint32_t kDead = 0xffffffffu;
  std::uint32_t leaf = 0;
  std::uint32_t first_edge = 0, edge_count = 0;   ///< in Contour::rings
  bool open = false;           ///< the surface ends here
  bool alive() const { return leaf != kDead; }
};

struct PatchVertex {
  Vec3 position{0.0};          ///< strictly inside its leaf
  glm::vec3 normal{0.0f};      ///< unit, outward; the mean of the sides' on a crease
  bool crease = false;
};

/// A crease leaves a patch's leaf through the face that two neighbouring edges of the patch bound.
struct CreaseExit {
  std::uint32_t patch = 0, edge = 0, next_edge = 0;
  auto operator<=>(const CreaseExit&) const = default;
};

struct Contour {
  // By minimal edge. One whose owner is dead (edge_alive) was divided or moved to other leaves.
  std::vector<MinimalEdge> edges;
  std::vector<std::uint8_t> edge_alive;
  std::vector<Crossing> crossings;
  std::vector<std::array<std::uint32_t, 4>> patch_of_quadrant;
  // By patch.
  std::vector<Patch> patches;
  std::vector<PatchVertex> vertices;
  std::vector<std::uint32_t> rings;               ///< minimal edges of the patches, each cycle in order
  std::vector<CreaseExit> exits;                  ///< ascending once compacted

  std::span<const std::uint32_t> ring(std::uint32_t patch) const {
    return {rings.data() + patches[patch].first_edge, patches[patch].edge_count};
  }
};

/// The numbers of what lives, ascending.
struct Living {
  std::vector<std::uint32_t> edges, patches;
};
Living living_part(const Contour& contour);

/// Only what lives, renumbered in order.
void compact(Contour& contour, const Living& living);

/// By old number the new one, where only those listed, ascending, are kept of n; kNoPatch for the others.
std::vector<std::uint32_t> numbers_among(const std::vector<std::uint32_t>& kept, std::size_t n);

/// Only those listed, ascending.
template <class T>
void keep_listed(std::vector<T>& items, const std::vector<std::uint32_t>& kept) {
  for (std::size_t i = 0; i < kept.size(); ++i) items[i] = items[kept[i]];
  items.resize(kept.size());
  items.shrink_to_fit();
}

/// Pairs of patches that a crease runs between, lower first, ascending. Of a compacted contour.
std::vector<std::array<std::uint32_t, 2>> crease_edges(const Contour& contour);

/// World point at t along a minimal edge.
inline Vec3 edge_point(const SurfaceOctree& tree, const MinimalEdge& edge, double t) {
  const OctreeLeaf& owner = tree.leaves()[edge.owner()];
  const int corner = edge_low_corner(edge.edge_of_owner());
  CellPlace place = owner.place;
  for (int a = 0; a < 3; ++a) place[a] += static_cast<std::uint32_t>(corner >> a & 1) << owner.level;
  Vec3 p = tree.point(place);
  if (t > 0) {
    place[edge.axis] += 1u << owner.level;
    p[edge.axis] += t * (tree.point(place)[edge.axis] - p[edge.axis]);
  }
  return p;
}
inline Vec3 crossing_point(const SurfaceOctree& tree, const Contour& contour, std::uint32_t edge) {
  return edge_point(tree, contour.edges[edge], static_cast<double>(contour.crossings[edge].t));
}

}  // namespace cambium
