// How thick paths are (Xu and Mould 2012, section 3.2), or by the pipe model (Shinozaki et al. 1964).
#pragma once

#include "skeletons/graph/plan.h"

#include <span>

namespace cambium {

/// A tree of paths: node 0 is the root, parents stand first.
struct PathNodes {
  std::span<const Vec3> positions;
  std::span<const std::uint32_t> parents;          ///< the root's is itself
  std::span<const std::uint32_t> endpoints;        ///< nodes
  std::span<const std::uint8_t> endpoint_levels;   ///< of each: 1, 2, ...
};

/// Metres, by node.
struct PathRadii {
  std::vector<double> tip;           ///< at the node; trunk_radius at the root unless there is no path
  std::vector<double> base;          ///< where the edge to the node begins: of its own way, so not more than its parent's
};

/// zetas: by level, the last goes on. Cost: linear in the nodes for each different zeta.
PathRadii path_radii(const PathNodes& nodes, const GraphThickness& thickness, std::span<const double> zetas);

}  // namespace cambium
