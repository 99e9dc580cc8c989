// How far a point is from a mesh.
#pragma once

#include "polygonize/box_tree.h"
#include "polygonize/mesh.h"

namespace cambium {

/// In double, to rounding. A triangle without area counts as the segment or point that it is.
double distance2_to_triangle(const Vec3& p, const Vec3& a, const Vec3& b, const Vec3& c);

/// Shared by threads; keeps a reference to the mesh. Cost of making: half a microsecond a triangle.
class MeshDistance {
 public:
  explicit MeshDistance(const Mesh& mesh);
  /// To the nearest triangle, metres; infinite if there is none. A `hint` that is at least the distance saves time. Cost: about a
  /// microsecond near the mesh.
  double operator()(const Vec3& p, double hint = kInfinity) const;
  const BoxTree& tree() const { return tree_; }

 private:
  const Mesh& mesh_;
  BoxTree tree_;
};

}  // namespace cambium
