// Foliage goes where the wood goes that bears it: see AxisRider.
#pragma once

#include "skeletons/axes.h"
#include "skeletons/surface.h"

#include <vector>

namespace cambium {

/// By organ: the node to take hold of, for decompose_axes.
std::vector<std::int32_t> nodes_ridden(const Foliage& foliage);

/// Sets made.foliage, made.organ_branches and the count of organs whose wood is gone. The tree's riders are the organs, in their order.
void follow_wood(const Foliage& foliage, const Skeleton& before, const AxisTree& after, Surfaced& made);

}  // namespace cambium
