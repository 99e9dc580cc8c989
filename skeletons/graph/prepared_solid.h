// Solids made ready for many questions: what is in them, how deep, and what runs through them.
#pragma once

#include "skeletons/graph/solids.h"

#include <memory>
#include <variant>

namespace cambium {

class RevolvedStroke;

/// Immutable, cheap to copy; used by threads at once. Cost of a question: a few nanoseconds, more of a revolution and of a mesh (see
/// RevolvedStroke and ClosedMesh).
class PreparedSolid {
 public:
  /// `solid`: valid. Cost: of a revolution that of its index.
  explicit PreparedSolid(const Solid& solid);

  /// Closed: true on the surface, to rounding.
  bool contains(const Vec3& p) const;
  /// Metres from p, inside, to the surface; of a ball's part to the ball. Not more than the distance where that has no closed form
  /// (ellipsoid).
  double depth(const Vec3& p) const;
  /// How near p, inside, is to the solid's middle: 0 on the surface, 1 in the center of a ball or an ellipsoid and on the axis of a cylinder
  /// or a cone; of the others the depth, in half the least side of their bounds.
  double middleness(const Vec3& p) const;
  /// Whether the straight line from a to b has a point in it: exact, to rounding, of every solid.
  bool meets(const Vec3& a, const Vec3& b) const;

 private:
  struct Ball { double radius; };
  struct BallPart { double radius, cos_angle; };
  struct Ellipsoid { Vec3 half_size; double least; };
  struct Cylinder { double radius, height; };
  struct Cone { double radius, slope, height, steepness; bool has_base, has_tip; };
  struct Revolution { std::shared_ptr<const RevolvedStroke> stroke; double half_size; };
  struct Mesh { std::shared_ptr<const ClosedMesh> mesh; double half_size; };
  using Shape = std::variant<Ball, BallPart, Ellipsoid, Cylinder, Cone, Revolution, Mesh>;

  struct Prepare;
  struct Contains;
  struct Depth;
  struct Middleness;
  struct Meets;

  Shape shape_;
};

}  // namespace cambium
