// Takes the zigzag of the graph's edges out of paths.
#pragma once

#include "skeletons/graph/graph_volume.h"

#include <cstdint>
#include <span>
#include <vector>

namespace cambium {

/// In each pass every node goes half the way to the middle of its neighbours on its axis: the node before and the one behind on the
/// longest way. Nodes that `fixed` marks stay, roots and ends of paths too, and so does a node that would move into an obstacle.
/// parents[i] < i, but for roots, which are their own. Cost: linear for each pass.
void smooth_paths(std::vector<Vec3>& positions, std::span<const std::uint32_t> parents, const std::vector<bool>& fixed,
                  const Obstacles* obstacles, int passes);

}  // namespace cambium
