// A contour on an octree that is being refined.
#pragma once

#include "polygonize/contour.h"
#include "polygonize/marks.h"

#include <optional>

namespace cambium {

/// Keeps a contour on an octree that is being refined: only what a cut changes is found again.
class ContourRefiner {
 public:
  /// nullopt if cancelled; so below: false. The octree is cut where its cells would not make a manifold.
  static std::optional<ContourRefiner> begin(SurfaceOctree tree, const SurfaceCover& cover, const RunOptions& run);

  /// Cuts leaves, and others for as long as the cells would not make a manifold.
  bool split(std::vector<std::uint32_t> leaves, const RunOptions& run);
  /// Crossings and vertices of what is new since the last call.
  bool place(const RunOptions& run);
  /// What became leaves where the octree's tubes run no longer.
  bool fill(const RunOptions& run);
  /// Lets go of what is dead, and renumbers the rest in order. living: of this contour. Only once all is placed.
  void compact(const Living& living);

  const SurfaceOctree& tree() const { return tree_; }
  const Contour& contour() const { return contour_; }
  const std::vector<std::uint32_t>& new_patches() const { return new_patches_; }   ///< of the last place(), ascending
  /// Faces that join their inside corners so that no two patches are joined twice.
  std::size_t relinked_faces() const;

 private:
  ContourRefiner(SurfaceOctree tree, const SurfaceCover& cover) : tree_(std::move(tree)), cover_(&cover) {}
  bool add_leaves(std::size_t first_new, const RunOptions& run);
  void resize_by_leaf();
  void retire(std::uint32_t leaf);
  std::vector<std::uint32_t> update(const std::vector<std::uint32_t>& cut, std::size_t first_new);
  std::vector<MinimalEdge> take_away(const std::vector<std::uint32_t>& cut);
  std::vector<MinimalEdge> edges_of_new(std::size_t first_new) const;
  std::vector<std::uint32_t> add_edges(std::vector<MinimalEdge> added);
  LeafEdges around_of(std::vector<std::uint32_t> leaves, std::size_t first_added);
  std::vector<std::uint32_t> trace(std::size_t first_added);
  void replace_patches(const LeafEdges& around, const LeafCycles& cycles);
  bool is_alive(const std::vector<std::array<std::uint32_t, 2>>& lines) const;

  SurfaceOctree tree_;
  const SurfaceCover* cover_;
  Contour contour_;
  RelinkedFaces relinked_;
  std::vector<std::array<std::uint32_t, 2>> patches_of_leaf_;   // first, count
  Marks touched_;                           // leaves to be traced again
  std::vector<std::uint32_t> place_in_list_;   // of leaves, in that which around_of is at
  std::vector<std::uint32_t> unplaced_edges_, unplaced_patches_, new_patches_;
};

}  // namespace cambium
