// A solid that a closed mesh bounds: a crown that somebody modelled.
#pragma once

#include "blobtree/box_tree.h"
#include "skeletons/graph/settled_cells.h"

#include <array>
#include <cstdint>
#include <vector>

namespace cambium {

/// Immutable; used by threads at once. Memory: about 120 bytes a triangle. Cost of making: a microsecond a triangle and up to 0.1 s. Cost
/// of a question: logarithmic in the triangles, and for most places a look into a grid.
class ClosedMesh {
 public:
  /// Vertices at the same place count as one; triangles with two corners there are left out. Closed is a mesh with as many triangles one
  /// way round each edge as the other way; one that has two triangles at each edge is turned so, part by part, where they
  /// disagree. Inside is what it winds around (a winding number other than 0): parts may overlap, and one that is inside out in
  /// another is a hollow. It may cross itself.
  /// Errors: InputError (no location) for no triangles, indices out of range, positions that are not finite, a mesh that is open (`an
  /// open mesh: 12 edges have one triangle`, and where the first is), one-sided, or without volume.
  ClosedMesh(std::vector<Vec3> positions, std::vector<std::array<std::uint32_t, 3>> triangles);

  const Box& bounds() const { return bounds_; }
  std::size_t triangle_count() const { return triangles_.size(); }
  bool contains(const Vec3& p) const;
  /// Metres to the surface, exact.
  double depth(const Vec3& p) const;
  /// Whether the straight line from a to b has a point in it; exact to rounding.
  bool meets(const Vec3& a, const Vec3& b) const;

 private:
  struct Triangle {
    Vec3 a, b, c;
  };
  int winding(const Vec3& p) const;

  std::vector<Triangle> triangles_;
  Box bounds_;
  BoxTree tree_;
  SettledCells cells_;
};

}  // namespace cambium
