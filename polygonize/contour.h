// The surface on an octree: where it crosses minimal edges, the patches these crossings form on the leaves, and their vertices.
#pragma once

#include "polygonize/surface_patches.h"

#include <compare>
#include <optional>

namespace cambium {

/// Where the surface crosses a minimal edge.
struct Crossing {
  float t = 0.5f;              ///< along the edge from its low end, strictly within
  glm::vec3 normal{0.0f};      ///< unit, outward; zero where the field has no gradient
};

/// One cycle on the boundary of one leaf.
struct Patch {
  static constexpr std::uint32_t kDead = 0xffffffffu;
  std::uint32_t leaf = 0;
  std::uint32_t first_edge = 0, edge_count = 0;   ///< in Contour::rings
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
  std::vector<bool> edge_alive;
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

/// The living part, renumbered in order.
Contour compacted(const Contour& contour);

/// Pairs of patches that a crease runs between, lower first, ascending. Of a compacted contour.
std::vector<std::array<std::uint32_t, 2>> crease_edges(const Contour& contour);

/// World point at t along a minimal edge.
Vec3 edge_point(const SurfaceOctree& tree, const MinimalEdge& edge, double t);
inline Vec3 crossing_point(const SurfaceOctree& tree, const Contour& contour, std::uint32_t edge) {
  return edge_point(tree, contour.edges[edge], static_cast<double>(contour.crossings[edge].t));
}

/// A leaf and a crossed edge on its boundary.
struct LeafEdge {
  std::uint32_t leaf = 0, edge = 0;
  auto operator<=>(const LeafEdge&) const = default;
};

/// Keeps a contour on an octree that is being refined: only what a cut changes is found again.
class ContourRefiner {
 public:
  /// nullopt if cancelled; so below: false. The octree is cut where its cells would not make a manifold.
  static std::optional<ContourRefiner> begin(SurfaceOctree tree, const SurfaceCover& cover, const RunOptions& run);

  /// Cuts leaves, and others for as long as the cells would not make a manifold.
  bool split(std::vector<std::uint32_t> leaves, const RunOptions& run);
  /// Crossings and vertices of what is new since the last call.
  bool place(const RunOptions& run);

  const SurfaceOctree& tree() const { return tree_; }
  SurfaceOctree take_tree() && { return std::move(tree_); }
  const Contour& contour() const { return contour_; }
  const std::vector<std::uint32_t>& new_patches() const { return new_patches_; }   ///< of the last place(), ascending
  /// Faces that join their inside corners so that no two patches are joined twice.
  std::size_t relinked_faces() const;

 private:
  ContourRefiner(SurfaceOctree tree, const SurfaceCover& cover) : tree_(std::move(tree)), cover_(&cover) {}
  void append_edge(const MinimalEdge& edge, std::vector<std::uint32_t>& added);
  void retire(std::uint32_t leaf);
  std::vector<std::uint32_t> update(const std::vector<std::uint32_t>& cut, std::size_t first_new);
  std::vector<LeafEdge> around_of(const std::vector<std::uint32_t>& leaves) const;
  std::vector<std::uint32_t> trace(std::vector<LeafEdge> pairs);
  void replace_patches(const LeafEdges& around, const LeafCycles& cycles);

  SurfaceOctree tree_;
  const SurfaceCover* cover_;
  Contour contour_;
  RelinkedFaces relinked_;
  std::vector<std::array<std::uint32_t, 2>> patches_of_leaf_;   // first, count
  std::vector<std::uint32_t> unplaced_edges_, unplaced_patches_, new_patches_;
};

}  // namespace cambium
