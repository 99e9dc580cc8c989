// Which nodes of a graph are joined by edges: the Yao graph, or all pairs nearer than a distance.
#pragma once

#include "blobtree/run_options.h"
#include "skeletons/graph/graph_volume.h"

#include <cstdint>
#include <optional>
#include <span>
#include <vector>

namespace cambium {

/// Undirected, each edge stored at both of its ends.
struct NodeGraph {
  std::vector<std::uint32_t> first;  ///< nodes + 1 numbers: the edges of node n are to[first[n]] .. to[first[n + 1]]
  std::vector<std::uint32_t> to;     ///< ascending for each node
  std::size_t repaired = 0;          ///< edges that were added so that every node reaches the root

  std::size_t nodes() const { return first.size() - 1; }
  std::size_t edges() const { return to.size() / 2; }
  std::span<const std::uint32_t> of(std::uint32_t node) const { return {to.data() + first[node], first[node + 1] - first[node]}; }
};

enum class EdgeRule { kYao, kThreshold };

struct EdgeOptions {
  EdgeRule rule = EdgeRule::kYao;
  int sectors = 8;                   ///< kYao: space around a node is divided into that many, 4 to 64 (yao_directions)
  double threshold = 1.8;            ///< kThreshold: the longest edge, in spacings of the nodes; > 1
};

/// The directions whose nearest neighbours on the sphere are the sectors (Yao 1982; orthants are Germer and Strothotte 2007): the
/// corners of a tetrahedron (4), faces (6) and corners (8) of a cube, corners of an icosahedron (12) and a dodecahedron (20), else a
/// Fibonacci spiral. Unit.
std::vector<Vec3> yao_directions(int sectors);
/// The sector that v, not 0, points into; the lower of two at the same angle.
int yao_sector(std::span<const Vec3> directions, const Vec3& v);

/// Of eight sectors: which coordinates are negative, x in bit 0.
inline std::size_t yao_octant(const Vec3& v) { return std::size_t(v.x < 0) | std::size_t(v.y < 0) << 1 | std::size_t(v.z < 0) << 2; }

/// How long an edge of kYao may be, metres: three spacings with eight sectors, with more as much farther as makes up for sectors being
/// narrower. Where nodes are farther apart than `spacing` says, in spacings of as many that fill the same room. Without a bound, nodes
/// on the surface would be joined across hollows.
double longest_yao_edge(std::span<const Vec3> positions, double spacing, int sectors);

/// Joins the nodes. `spacing`: the least distance between them, which is what neighbours are looked for by. Edges that would join two
/// subvolumes or cross an obstacle are left out: of a sector, the nearest node that may be joined is. `parts`: the subvolume of each
/// node; empty: all are of one. Then, what node 0 does not reach is joined to it by the shortest edges there are (also across
/// subvolumes or obstacles if nothing else will do), and counted.
/// The same at any thread count; nullopt if cancelled. Cost: linear in the nodes for nodes spread as poisson_disc spreads them, about a
/// microsecond each; while it runs 4 bytes for each node and sector besides the graph's own.
/// Errors: InputError (no location) that names the setting by its key in a recipe.
std::optional<NodeGraph> join_nodes(std::span<const Vec3> positions, double spacing, std::span<const std::uint16_t> parts,
                                    const Obstacles* obstacles, const EdgeOptions& options, const RunOptions& run);

}  // namespace cambium
