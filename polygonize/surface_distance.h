// How far a point is from the implicit surface {f = kIso}.
#pragma once

#include "blobtree/field.h"

#include <optional>

namespace cambium {

/// Scratch, one per thread.
class SurfaceDistance {
 public:
  explicit SurfaceDistance(const Field& field) : field_(field) {}

  struct Foot {
    Vec3 point{0.0};         ///< on the surface
    double distance = 0;     ///< from there, metres
  };
  /// The nearest point of the surface as steps along the gradient find it (Newton; a bracket as soon as the sign changes, so
  /// that creases do no harm), then moved along the surface as long as that brings it nearer. Its distance is never less than the
  /// true one, but for 1e-9 m and a thousandth. On smooth surface, and from nearer than its radius of curvature, it is the
  /// true one; where the nearest point lies on a crease it may be 3 % more. nullopt where the gradient leads nowhere: it
  /// vanishes, or the surface is far. `near` must be exact where its box says; outside of that the field itself is asked, at ten
  /// times the cost. Cost: two or three samples.
  std::optional<Foot> nearest(const PrunedField& near, const Vec3& p);

  /// The nearest point of the surface within `reach` as 26 straight ways from p show it: where one of them comes to the other kind,
  /// inside or outside, the surface is between; then moved as above. For where features far smaller than `reach` lead
  /// gradients past what is near. Never less than the true distance; nullopt where no way shows the surface. Cost: up to 260 values.
  std::optional<Foot> around(const PrunedField& near, const Vec3& p, double reach);

  /// The same from a point that is known to lie on the surface; never farther than that.
  Foot slide(const PrunedField& near, const Vec3& p, const Vec3& on_surface);

 private:
  struct Landing {
    Vec3 point{0.0}, gradient{0.0};
  };
  Sample sample(const PrunedField& near, const Vec3& p) {
    return near.box().contains(p) ? evaluator_.sample(near, p) : field_.sample(p);
  }
  std::optional<Landing> land(const PrunedField& near, const Vec3& from, double longest_step, double precision);
  Landing between(const PrunedField& near, Vec3 a, Sample at_a, Vec3 b, Sample at_b, double precision);
  Foot slide(const PrunedField& near, const Vec3& p, Landing foot);

  const Field& field_;
  Evaluator evaluator_;
};

}  // namespace cambium
