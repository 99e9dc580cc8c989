// Which of the surface's crossings with a leaf's edges belong together: the closed cycles they form on the leaf's boundary, each
// of which gets one vertex (manifold dual contouring; Schaefer, Ju & Warren 2007, on the leaves themselves). Integers only.
#pragma once

#include "polygonize/minimal_edges.h"

#include <array>
#include <cstdint>
#include <optional>
#include <span>
#include <vector>

namespace cambium {

inline constexpr std::uint32_t kNoPatch = 0xffffffffu;

/// One cycle on the boundary of one leaf.
struct Patch {
  std::uint32_t leaf = 0;
  std::uint32_t first_edge = 0, edge_count = 0;   ///< in SurfacePatches::edges
};

struct SurfacePatches {
  std::vector<Patch> patches;                                   ///< by leaf
  std::vector<std::uint32_t> edges;                             ///< minimal edges of the patches, each cycle in order
  std::vector<std::array<std::uint32_t, 4>> patch_of_quadrant;  ///< by minimal edge and quadrant
  std::vector<std::uint32_t> to_split;                          ///< leaves with a cycle of two edges only, ascending
  std::size_t relinked_faces = 0;                               ///< so that no two patches are joined twice
  std::vector<std::uint32_t> crowded;                           ///< leaves of several patches, ascending

  std::span<const std::uint32_t> edges_of(const Patch& patch) const { return {edges.data() + patch.first_edge, patch.edge_count}; }
};

/// Where to_split is empty, every edge of the mesh dual to the patches lies in two polygons and every vertex in one fan, whatever
/// the signs are. A face that the surface crosses in several lines keeps its inside corners apart; where two of its lines would
/// then join the same two patches, they are linked the other way, which parts both patches, and so never joins others twice.
/// nullopt if cancelled. Cost: linear in the edges.
std::optional<SurfacePatches> find_patches(const SurfaceOctree& tree, const std::vector<MinimalEdge>& edges, const RunOptions& run);

}  // namespace cambium
