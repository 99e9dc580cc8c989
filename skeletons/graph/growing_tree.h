// The tree as it grows level by level: nodes on paths, and the endpoints that may bear more.
#pragma once

#include "skeletons/graph/graph_paths.h"

namespace cambium {

/// An endpoint, and what it passes on to a subgraph around it.
struct GrowthTip {
  std::uint32_t node = 0;
  Vec3 from{0.0};                    ///< the root of the graph that it is an endpoint of
  double lifespan = 0;
  std::uint64_t stream = 0;          ///< names the way of endpoints that leads here
};

struct GrowingTree {
  std::vector<Vec3> positions;
  std::vector<std::uint32_t> parents;                ///< the root's is itself
  std::vector<std::vector<GrowthTip>> tips;          ///< by level, level 1 first

  /// Joins a graph's paths to the tree at the node that is their root. Its endpoints' nodes, in their order.
  std::vector<std::uint32_t> join(const GraphPaths& paths, std::uint32_t root) {
    const auto offset = static_cast<std::uint32_t>(positions.size()) - 1;
    const auto index = [&](std::uint32_t local) { return local == 0 ? root : local + offset; };
    positions.insert(positions.end(), paths.positions.begin() + 1, paths.positions.end());
    for (std::size_t i = 1; i < paths.parents.size(); ++i) parents.push_back(index(paths.parents[i]));
    std::vector<std::uint32_t> endpoints;
    for (const std::uint32_t endpoint : paths.endpoints) endpoints.push_back(index(endpoint));
    return endpoints;
  }
};

}  // namespace cambium
