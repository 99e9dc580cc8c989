// The edges of an octree's leaves that no finer leaf divides and that the surface crosses, each with the leaves around it
// (Ju, Losasso, Schaefer & Warren 2002). Integers only.
#pragma once

#include "polygonize/surface_octree.h"

#include <array>
#include <cstdint>
#include <optional>
#include <vector>

namespace cambium {

/// Quadrant q around an edge along axis a lies at (q & 1, q >> 1) on axes a + 1 and a + 2 (modulo 3).
struct MinimalEdge {
  std::array<std::uint32_t, 4> leaves{};   ///< by quadrant; one that spans two neighbouring quadrants is there twice
  std::uint8_t axis = 0;
  std::uint8_t finest = 0;                 ///< the quadrant of the (first) smallest leaf: the edge is one of its own
  bool low_inside = false;                 ///< at its low end

  std::uint32_t owner() const { return leaves[finest]; }
  /// Number of the edge in its owner (cube_edges.h).
  int edge_of_owner() const { return 4 * axis + (3 - finest); }
};

/// Quadrants in counter-clockwise order seen from the edge's high end.
inline constexpr std::array<int, 4> kRing{0, 1, 3, 2};

/// visit(leaf) for each leaf around an edge, once.
template <class Visit>
void for_each_leaf(const MinimalEdge& edge, Visit&& visit) {
  for (int k = 0; k < 4; ++k) {
    const std::uint32_t leaf = edge.leaves[kRing[k]];
    if (leaf != edge.leaves[kRing[(k + 3) % 4]]) visit(leaf);
  }
}

struct MinimalEdges {
  std::vector<MinimalEdge> edges;           ///< all of them, in an order that depends on the octree only
  /// Leaves with a crossed edge beside a leaf of less than half their size, or that the surface crosses one of their edges twice
  /// of, ascending: cells dual to the edges would not make a manifold before they are cut.
  std::vector<std::uint32_t> to_split;
};

/// nullopt if cancelled. Cost: linear in the octree's nodes.
std::optional<MinimalEdges> crossed_minimal_edges(const SurfaceOctree& tree, const RunOptions& run);

/// The minimal edge that edge `e` (cube_edges.h) of a leaf is, if it is crossed and no finer leaf divides it.
std::optional<MinimalEdge> minimal_edge_of(const SurfaceOctree& tree, std::uint32_t leaf, int e);
/// Appends the leaves around an edge that must be split.
void append_unsettled(const SurfaceOctree& tree, const MinimalEdge& edge, std::vector<std::uint32_t>& to_split);

}  // namespace cambium
