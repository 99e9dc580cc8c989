// The plant skeleton: what an L-system, a scan or a file says a tree is, before it has a surface.
#pragma once

#include "blobtree/geometry.h"

#include <cstdint>
#include <optional>
#include <vector>

namespace cambium {

/// One node, and the internode that runs to it from its parent. Metres.
struct SkeletonNode {
  Vec3 position{0.0};
  double radius = 0;                       ///< at the node (the internode's tip)
  std::int32_t parent = -1;                ///< -1 at a root; else an index below this node's own
  /// Radius where the internode leaves its parent; unset: the parent's radius on an axis, the node's own on a lateral.
  std::optional<double> base_radius;
  /// Whether the internode continues its parent's axis (L-system: not in brackets) or starts a lateral; unset: decided by
  /// thickness, then straightness (field.md section 6).
  std::optional<bool> lateral;
};

/// Nodes in an order in which parents stand first. Several roots are several trees.
struct Skeleton {
  std::vector<SkeletonNode> nodes;
};

}  // namespace cambium
