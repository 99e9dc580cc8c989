// Joins what node 0 does not reach to what it does.
#pragma once

#include "blobtree/run_options.h"
#include "skeletons/graph/node_graph.h"

#include <algorithm>
#include <cstdint>
#include <span>

namespace cambium {

/// Which pairs of nodes may be joined.
struct JoinRules {
  std::span<const Vec3> positions;
  std::span<const std::uint16_t> parts;   ///< empty: all are of one
  const Obstacles* obstacles;             ///< may be null

  bool allow(std::uint32_t u, std::uint32_t v) const {
    if (!parts.empty() && parts[u] != parts[v] && parts[u] != 0 && parts[v] != 0) return false;
    if (!obstacles || obstacles->empty()) return true;
    return !obstacles->crossed(positions[std::min(u, v)], positions[std::max(u, v)]);   // the same both ways
  }
};

/// Adds the shortest edges, as many as there are components but one, and counts them: of those that the rules allow where one is not
/// longer than eight spacings, else of all. False if cancelled.
/// Cost: linear where all is reached; else n log n for each halving of the components.
bool reach_all(NodeGraph& graph, const JoinRules& rules, double spacing, const RunOptions& run);

}  // namespace cambium
