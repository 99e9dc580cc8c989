// Which of the surface's crossings with a leaf's edges belong together: the closed cycles they form on the leaf's boundary, each
// of which gets one vertex (manifold dual contouring; Schaefer, Ju & Warren 2007, on the leaves themselves). Integers only.
#pragma once

#include "polygonize/minimal_edges.h"

#include <array>
#include <cstdint>
#include <span>
#include <unordered_map>
#include <vector>

namespace cambium {

inline constexpr std::uint32_t kNoPatch = 0xffffffffu;

/// Leaves, ascending, and the crossed minimal edges around each, ascending.
struct LeafEdges {
  std::vector<std::uint32_t> leaves;
  std::vector<std::uint32_t> first{0};      ///< one more than leaves
  std::vector<std::uint32_t> edges;

  std::span<const std::uint32_t> of(std::size_t i) const { return {edges.data() + first[i], first[i + 1] - first[i]}; }
};

/// By two leaves that a face lies between: the lines in which the surface crosses it (pairs of edges), where they are not those
/// that the corners' rule gives.
using RelinkedFaces = std::unordered_map<std::uint64_t, std::vector<std::array<std::uint32_t, 2>>>;

struct LeafCycles {
  std::vector<std::uint32_t> counts;        ///< of cycles, by place in LeafEdges::leaves
  std::vector<std::uint32_t> lengths;       ///< of cycles
  std::vector<std::uint32_t> edges;         ///< of the cycles, each in order
  std::vector<std::uint8_t> open;           ///< by cycle: only a part of one, from one end to the other
  std::vector<std::uint32_t> to_split;      ///< leaves with a cycle of two edges only, ascending
};

/// Leaves, ascending, that share a face which the surface crosses in several lines with one that is listed, but are not: whoever
/// traces the one must trace the other. Cost: linear in the edges.
std::vector<std::uint32_t> leaves_across_many_lines(const SurfaceOctree& tree, const std::vector<MinimalEdge>& edges,
                                                    const LeafEdges& around);

/// The cycles of the leaves listed, which have none across many lines. A face that the surface crosses in several lines keeps its inside corners apart; where two of
/// its lines would then join the same two cycles, they are linked the other way, which parts both cycles, and so never joins
/// others twice. Every edge of the mesh dual to the cycles is then in two polygons and every vertex in one fan, whatever the
/// signs are (but where cycles are open, beside nothing), unless to_split tells of leaves. Cost: linear in the edges.
LeafCycles trace_cycles(const SurfaceOctree& tree, const std::vector<MinimalEdge>& edges, const LeafEdges& around,
                        RelinkedFaces& relinked);

}  // namespace cambium
