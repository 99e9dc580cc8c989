// Leaves on the tests' small skeletons.
#pragma once

#include "skeletons/foliage.h"

#include <utility>
#include <vector>

namespace cambium {

/// One diamond, and one of it at each of the places: (node, position).
inline Foliage leaves_at(const std::vector<std::pair<std::int32_t, Vec3>>& places) {
  Foliage foliage;
  foliage.shapes.push_back({"polygon1", {{0, 0, 0}, {0.3, 0.5, 0}, {0, 1, 0}, {-0.3, 0.5, 0}}, {{0, 1, 2}, {0, 2, 3}}});
  for (const auto& [node, position] : places) {
    OrganPlacement organ;
    organ.position = position;
    organ.node = node;
    foliage.organs.push_back(organ);
  }
  return foliage;
}

}  // namespace cambium
