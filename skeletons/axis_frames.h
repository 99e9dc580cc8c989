// The native surface coordinates along axes (field.md section 7): metres from the root and a parallel-transported direction.
#pragma once

#include "skeletons/axes.h"

#include <vector>

namespace cambium {

struct AxisFrame {
  double v = 0;                            ///< metres from the root to the first node, along the path
  Vec3 u{1, 0, 0};                         ///< where u = 0 on the first segment; unit, across it
};

/// One per axis. A lateral takes over its parent's direction where it leaves. Cost: linear.
std::vector<AxisFrame> frames_of(const AxisTree& tree);

/// The direction on every segment, from the one on the first (one entry for an axis without segments).
std::vector<Vec3> directions_along(const Axis& axis, const Vec3& first);

/// Unit direction of a segment; (0, 0, 1) if it has no length.
Vec3 segment_direction(const Axis& axis, std::size_t segment);

}  // namespace cambium
