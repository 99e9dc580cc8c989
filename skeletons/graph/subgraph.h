// Which way a subgraph points and what volume it has (Xu and Mould 2012, section 3.3.2).
#pragma once

#include "skeletons/graph/plan.h"

namespace cambium {

/// v_g, unit, of a subgraph rooted at `root` whose endpoint's graph was rooted at `from`: oriented, turned, then drawn by the wind.
Vec3 subgraph_direction(const GraphLevel& level, const Vec3& root, const Vec3& from, const std::optional<GraphWind>& wind,
                        std::uint64_t stream);

/// The part of a ball of radius r around the root that is within alpha of v_g, or the level's shape.
GraphVolume subgraph_volume(const GraphLevel& level, const Vec3& root, const Vec3& direction, double radius,
                            const std::shared_ptr<const Obstacles>& obstacles);

}  // namespace cambium
