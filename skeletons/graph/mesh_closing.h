// Whether triangles bound a solid.
#pragma once

#include "blobtree/geometry.h"

#include <array>
#include <cstdint>
#include <vector>

namespace cambium {

/// Triangles by their corners' places, so that each edge has as many one way round as the other. See ClosedMesh for what is accepted,
/// turned and refused. Cost: n log n.
std::vector<std::array<Vec3, 3>> closed_triangles(const std::vector<Vec3>& positions,
                                                  const std::vector<std::array<std::uint32_t, 3>>& triangles);

}  // namespace cambium
