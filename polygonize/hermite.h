// Hermite data: where the surface crosses the octree's minimal edges, and its normals there.
#pragma once

#include "polygonize/minimal_edges.h"

#include <optional>
#include <vector>

namespace cambium {

struct Crossing {
  float t = 0.5f;              ///< along the edge from its low end, strictly within
  glm::vec3 normal{0.0f};      ///< unit, outward; zero where the field has no gradient
};

inline constexpr std::uint32_t kNoEdge = 0xffffffffu;

/// Where each minimal edge was in an earlier list over the same octree, of which some leaves were cut since: the same edge of the
/// same leaf, or kNoEdge. Cost: linear.
std::vector<std::uint32_t> earlier_edges(const SurfaceOctree& tree, const std::vector<MinimalEdge>& edges,
                                         const std::vector<MinimalEdge>& earlier);

/// By minimal edge; those that were there before (`earlier`, by earlier_edges) are taken from `known`. nullopt if cancelled.
/// Accuracy: about 1e-4 of the edge, or 2e-5 in the field.
std::optional<std::vector<Crossing>> find_crossings(const SurfaceOctree& tree, const SurfaceCover& cover,
                                                    const std::vector<MinimalEdge>& edges, const std::vector<std::uint32_t>& earlier,
                                                    const std::vector<Crossing>& known, const RunOptions& run);

/// World point at t along a minimal edge.
Vec3 edge_point(const SurfaceOctree& tree, const MinimalEdge& edge, double t);

}  // namespace cambium
