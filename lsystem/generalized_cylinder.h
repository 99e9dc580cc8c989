// Axes of generalized cylinders: smooth curves along control points, as in cpfg (@Gs @Gc @Ge, and `{(n)` to `}`).
#pragma once

#include <vector>

#include "lsystem/skeleton_pen.h"

namespace cambium {

/// The turtle where it passed a control point.
struct ControlPoint {
  Vec3 position{0.0};
  Vec3 heading{0, 0, 1};  ///< unit
  double radius = 0;
  double tangent_in = 1.2;  ///< of the curve towards the point and away from it: the tangents' lengths, in chords
  double tangent_out = 1.2;
};

/// What a control point adds to the axis: at least two samples, or none. Neighbouring chords differ by no more than 8
/// degrees, where 64 chords are enough for that.
using AxisStretch = std::vector<AxisSample>;

/// An axis as it grows from point to point.
class GeneralizedCylinder {
 public:
  enum class Curve { kHermite, kBSpline };

  explicit GeneralizedCylinder(Curve curve = Curve::kHermite, bool closed = false) : curve_(curve), closed_(closed) {}

  bool passes_its_points() const { return curve_ == Curve::kHermite; }
  /// A Hermite curve goes through all points, along their headings, from the second on; a uniform cubic B-spline begins with
  /// the fourth. Radii change evenly from one point to the next.
  AxisStretch pass(const ControlPoint& point);
  /// Of a closed curve, what leads back to where it began.
  std::vector<AxisStretch> close();

 private:
  std::size_t reach() const { return curve_ == Curve::kHermite ? 1 : 3; }  // points behind the one that completes a stretch

  Curve curve_;
  bool closed_;
  std::vector<ControlPoint> first_;   // of a closed curve
  std::vector<ControlPoint> recent_;  // the last reach()
};

}  // namespace cambium
