// Which nodes of a graph are endpoints (Xu and Mould 2012, sections 3.1 and 3.3.1, figures 10 and 12).
#pragma once

#include "skeletons/graph/graph_volume.h"

#include <cstdint>
#include <span>
#include <vector>

namespace cambium {

/// Where endpoints may be drawn.
struct EndpointChoice {
  std::span<const std::uint16_t> parts = {};   ///< the subvolume of each node; empty: all are of one
  std::size_t taken = 1;                  ///< so many first nodes, the root among them, are not for drawing
  double shell = 0;                       ///< > 0: nodes not deeper than this, metres
};

/// `count` nodes, or as many as there are to choose from: each set equally likely, and as many from each subvolume as from the others
/// where it has them.
std::vector<std::uint32_t> draw_endpoints(const GraphVolume& volume, std::span<const Vec3> positions, const EndpointChoice& choice,
                                          std::size_t count, std::uint64_t stream);

/// The same among nodes within `reach` metres of the path, ascending numbers of nodes.
std::vector<std::uint32_t> draw_endpoints_around(std::span<const Vec3> positions, std::span<const std::uint32_t> path, double reach,
                                                 std::size_t count, std::uint64_t stream);

}  // namespace cambium
