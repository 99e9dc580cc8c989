// The solid that a stroke sweeps as it turns about the z axis (Xu and Mould 2012, section 3.3.1, figure 14).
#pragma once

#include "blobtree/box_tree.h"
#include "skeletons/graph/settled_cells.h"

#include <span>
#include <vector>

namespace cambium {

/// Errors: InputError (no location) that names the key `stroke` and the point, counted from 1: fewer than 2 points, more than 2^16, one
/// that is not finite or at a negative distance, lines that meet but for neighbours at their common end, no area.
void validate_stroke(std::span<const glm::dvec2> stroke);

/// Made of a valid stroke, (distance from the axis, z) of each point: where an end is off the axis it is joined to it on its own height,
/// unless the stroke ends where it began. Immutable; used by threads at once. Cost of a question: logarithmic in the points, and for most
/// places far from the stroke a look into a grid.
class RevolvedStroke {
 public:
  explicit RevolvedStroke(std::span<const glm::dvec2> stroke);

  bool contains(const Vec3& p) const;
  /// Metres to the surface, exact.
  double depth(const Vec3& p) const;
  /// Whether the straight line from a to b has a point in it; exact to rounding.
  bool meets(const Vec3& a, const Vec3& b) const;

 private:
  struct Line {
    glm::dvec2 a, b;
  };
  bool encloses(double r, double z) const;

  std::vector<Line> lines_;          // of the outline, without those on the axis
  BoxTree tree_;                     // of them, at (r, z, 0)
  SettledCells cells_;               // likewise
};

}  // namespace cambium
