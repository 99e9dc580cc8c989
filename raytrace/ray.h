// Rays, the part of one that counts, and boxes against them.
#pragma once

#include "blobtree/geometry.h"

#include <algorithm>
#include <optional>

namespace cambium {

/// A half line: origin + t direction, t >= 0. direction is a unit vector, so t is metres.
struct Ray {
  Vec3 origin;
  Vec3 direction;
  Vec3 at(double t) const { return origin + t * direction; }
};

struct RaySegment {
  double begin = 0;
  double end = 0;
};

enum class PlaceWanted {
  kFirst,      ///< the first place inside
  kAny,        ///< any: whether there is one
};

/// The part of the ray within [segment] that lies in the box (faces included); nullopt if none does.
std::optional<RaySegment> clip(const Ray& ray, const Box& box, const RaySegment& segment);

/// Clips one ray to many boxes: as clip(), to the last bit the same for every box that shares a face.
class RayClipper {
 public:
  explicit RayClipper(const Ray& ray)
      : origin_(ray.origin), inverse_(1.0 / ray.direction),
        oblique_(ray.direction.x != 0 && ray.direction.y != 0 && ray.direction.z != 0), direction_(ray.direction) {}
  std::optional<RaySegment> clip(const Box& box, const RaySegment& segment) const {
    if (!oblique_) return cambium::clip({origin_, direction_}, box, segment);
    const Vec3 a = (box.lo - origin_) * inverse_, b = (box.hi - origin_) * inverse_;
    const Vec3 enter = glm::min(a, b), leave = glm::max(a, b);
    const RaySegment part{std::max(std::max(segment.begin, enter.x), std::max(enter.y, enter.z)),
                          std::min(std::min(segment.end, leave.x), std::min(leave.y, leave.z))};
    if (!(part.begin <= part.end)) return std::nullopt;
    return part;
  }

 private:
  Vec3 origin_, inverse_;
  bool oblique_;
  Vec3 direction_;
};
}  // namespace cambium
