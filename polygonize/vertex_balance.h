// Vertices of a contour moved off the surface by as much as makes their polygons fit best, and how well these fit then.
#pragma once

#include "polygonize/polygon_split.h"

namespace cambium {

inline constexpr double kAim = 0.95;   ///< of the tolerance: what is measured at a few places of a polygon is larger somewhere

/// Where the vertices of a convex twig lie on its surface the polygons lie inside it. Moving the vertices outwards by half of that
/// brings both to the same distance, and polygons reach a tolerance with half as many cells. Follows a contour that is refined.
class VertexBalance {
 public:
  /// Moves no vertex by more than half of `tolerance` (metres), and none on a crease.
  explicit VertexBalance(double tolerance) : tolerance_(tolerance) {}

  /// After new patches, all that they touch. False if cancelled. Cost: linear in those, a look at every edge and patch, and a few
  /// samples of the field for each polygon that may bow by as much as the tolerance.
  bool update(const SurfaceOctree& tree, const SurfaceCover& cover, const Contour& contour, const std::vector<std::uint32_t>& new_patches,
              const RunOptions& run);

  /// Forgets all others, and renumbers these, as a contour does that is compacted.
  void keep(const Living& living);

  /// By patch: strictly inside its leaf; of several in one leaf each is in the middle of its crossings.
  const std::vector<Vec3>& positions() const { return positions_; }
  /// By edge: of the polygon from the surface, metres: where the surface crosses the edge, along its sides and the better of its
  /// diagonals as the normals tell, and where it was measured at all that polygon_distance.h looks at.
  float error(std::uint32_t edge) const { return errors_[edge]; }
  /// By edge: how its polygon is to be cut where that was measured.
  const std::vector<std::optional<Split>>& splits() const { return splits_; }
  /// Whose errors the last update changed, ascending.
  const std::vector<std::uint32_t>& changed_edges() const { return changed_edges_; }

 private:
  bool measure(const SurfaceOctree& tree, const SurfaceCover& cover, const Contour& contour, const RunOptions& run);

  double tolerance_;
  std::vector<Vec3> positions_;
  std::vector<float> heights_, errors_;   // of the surface over the polygon, before and after
  std::vector<std::optional<Split>> splits_;
  std::vector<std::uint32_t> changed_edges_;
};

}  // namespace cambium
