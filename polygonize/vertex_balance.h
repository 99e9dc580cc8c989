// Vertices of a contour moved off the surface by as much as makes their polygons fit best, and how well these fit then.
#pragma once

#include "polygonize/contour.h"

namespace cambium {

/// Where the vertices of a convex twig lie on its surface the polygons lie inside it. Moving the vertices outwards by half of that
/// brings both to the same distance, and polygons reach a tolerance with half as many cells. Follows a contour that is refined.
class VertexBalance {
 public:
  /// Moves no vertex by more than half of `tolerance` (metres), and none on a crease.
  explicit VertexBalance(double tolerance) : tolerance_(tolerance) {}

  /// After new patches, all that they touch. Cost: linear in those, and a look at every edge and patch.
  void update(const SurfaceOctree& tree, const Contour& contour, const std::vector<std::uint32_t>& new_patches);

  /// By patch: strictly inside its leaf.
  const std::vector<Vec3>& positions() const { return positions_; }
  /// By edge: of the polygon from the surface, metres: its mean plane where the surface crosses the edge, its sides, and the better
  /// of its diagonals.
  float error(std::uint32_t edge) const { return errors_[edge]; }
  /// Whose errors the last update changed, ascending.
  const std::vector<std::uint32_t>& changed_edges() const { return changed_edges_; }

 private:
  double tolerance_;
  std::vector<Vec3> on_surface_, positions_;
  std::vector<float> heights_, errors_;   // of the surface over the polygon, before and after
  std::vector<std::uint32_t> changed_edges_;
};

}  // namespace cambium
