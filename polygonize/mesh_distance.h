// How far a point is from a mesh.
#pragma once

#include "blobtree/box_tree.h"
#include "blobtree/triangle_distance.h"
#include "polygonize/mesh.h"

namespace cambium {

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
