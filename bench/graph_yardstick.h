// A graph of nodes strewn in a volume, and the least-cost paths in it, the straightforward way.
#pragma once

#include <cstddef>
#include <cstdint>

#include "skeletons/graph/graph_volume.h"

namespace cambium::bench {

struct GraphSeconds {
  double nodes = 0, edges = 0, paths = 0;
  double all() const { return nodes + edges + paths; }
};

/// As many nodes as wanted, none nearer than `spacing`, by throwing darts at the volume's bounds and looking for what is near in a hash
/// grid; edges to the nearest node in each octant within three spacings, from a k-d tree (nanoflann); paths by Boost's Dijkstra.
/// One thread. Gives up on a count that does not fit: after two thousand darts for each node.
GraphSeconds straightforward_graph(const GraphVolume& volume, std::size_t count, double spacing, std::uint64_t seed);

}  // namespace cambium::bench
