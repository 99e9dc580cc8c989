#include "raytrace/ray.h"

#include <algorithm>

namespace cambium {

std::optional<RaySegment> clip(const Ray& ray, const Box& box, const RaySegment& segment) {
  RaySegment part = segment;
  for (int axis = 0; axis < 3; ++axis) {
    const double d = ray.direction[axis], o = ray.origin[axis];
    if (d == 0) {
      if (o < box.lo[axis] || o > box.hi[axis]) return std::nullopt;
      continue;
    }
    const double a = (box.lo[axis] - o) / d, b = (box.hi[axis] - o) / d;
    part.begin = std::max(part.begin, std::min(a, b));
    part.end = std::min(part.end, std::max(a, b));
  }
  if (!(part.begin <= part.end)) return std::nullopt;
  return part;
}

}  // namespace cambium
