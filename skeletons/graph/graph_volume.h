// Where graph nodes may be: a union of solids without the obstacles in it (Xu and Mould 2012, sections 3.3.1 and 3.4).
#pragma once

#include "skeletons/graph/prepared_solid.h"

#include <cstdint>
#include <memory>
#include <vector>

namespace cambium {

/// A placed solid ready for questions about places of the world.
class SolidFrame {
 public:
  /// Errors: InputError (no location) as validate(), and for a scale, an axis or an origin that places nothing.
  explicit SolidFrame(const PlacedSolid& placed);

  const Box& world() const { return world_; }
  Vec3 local(const Vec3& p) const { return to_local_ * (p - origin_); }
  /// From the solid's own place to the world's.
  Vec3 placed(const Vec3& local) const { return origin_ + scale_ * scale_ * (local * to_local_); }

  bool contains(const Vec3& p) const { return world_.contains(p) && solid_.contains(local(p)); }
  double depth(const Vec3& p) const { return scale_ * solid_.depth(local(p)); }      ///< metres; p is in it
  double middleness(const Vec3& p) const { return solid_.middleness(local(p)); }     ///< as PreparedSolid::middleness
  bool meets(const Vec3& a, const Vec3& b) const;                                    ///< as PreparedSolid::meets

 private:
  Mat3 to_local_;                    // rotation, divided by the scale
  Vec3 origin_;
  double scale_;
  Box world_;
  PreparedSolid solid_;
};

/// All that the normal points away from.
struct HalfSpaceObstacle { Vec3 point{0.0}, normal{0, 0, 1}; };

/// What nodes and edges keep out of.
class Obstacles {
 public:
  /// Errors: InputError (no location) as validate(), and for a normal of length 0.
  Obstacles() = default;
  Obstacles(const std::vector<PlacedSolid>& solids, std::vector<HalfSpaceObstacle> half_spaces);

  bool empty() const { return solids_.empty() && half_spaces_.empty(); }
  bool holds(const Vec3& p) const;
  /// Whether the straight line from a to b meets an obstacle; exact, to rounding.
  bool crossed(const Vec3& a, const Vec3& b) const;

 private:
  std::vector<SolidFrame> solids_;
  std::vector<HalfSpaceObstacle> half_spaces_;
};

/// Immutable; used by threads at once. Cost of a question: one look at each solid's box, and the solid where p is in it.
class GraphVolume {
 public:
  /// Errors: InputError (no location) for no solid at all, and as validate().
  GraphVolume(std::vector<PlacedSolid> solids, std::shared_ptr<const Obstacles> obstacles = nullptr);

  const Box& bounds() const { return bounds_; }
  const std::vector<PlacedSolid>& solids() const { return solids_; }
  const std::vector<SolidFrame>& frames() const { return frames_; }   ///< of the solids, in their order
  const std::shared_ptr<const Obstacles>& obstacles() const { return obstacles_; }
  std::size_t parts() const { return parts_; }             ///< subvolumes, the common one (0) included

  bool contains(const Vec3& p) const;
  /// In a solid that bears endpoints, and in no obstacle.
  bool bears_endpoints(const Vec3& p) const;
  /// Of a place that bears endpoints: metres to the surface of the union of what bears them; at least that far where solids overlap
  /// it is the deepest of them.
  double depth(const Vec3& p) const;
  /// The subvolume that p is in; where several overlap, the one whose solid p is most in the middle of, so that none of two cones that
  /// run into each other, or of a cone and the ball in its way, is cut through.
  std::uint16_t part_of(const Vec3& p) const;
  /// Cubic metres, by 2^18 places spread evenly: to about 0.5 % where the bounds are a quarter full.
  double volume() const;

 private:
  bool blocked(const Vec3& p) const { return obstacles_ && obstacles_->holds(p); }

  std::vector<PlacedSolid> solids_;
  std::vector<SolidFrame> frames_;
  std::shared_ptr<const Obstacles> obstacles_;
  Box bounds_;
  std::size_t parts_ = 1;
};

}  // namespace cambium
