// What the branch ids of a field's coordinates (Attributes::branch) stand for: where each branch leaves the one that bears it.
#pragma once

#include "blobtree/geometry.h"

#include <cstdint>

namespace cambium {

struct BranchInfo {
  std::int32_t parent = -1;        ///< id of the branch that bears it; -1: none
  Vec3 pivot{0.0};                 ///< where its axis leaves its parent's, or stands on the ground
  Vec3 axis{0, 0, 1};              ///< unit: its direction there
};

}  // namespace cambium
