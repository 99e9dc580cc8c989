// A mesh's vertices in small groups of neighbours that face alike, for what varies slowly from one to the next.
// Private to polygonize/.
#pragma once

#include "blobtree/run_options.h"
#include "polygonize/mesh.h"

#include <array>
#include <cstdint>
#include <vector>

namespace cambium {

struct VertexClusters {
  std::vector<std::uint32_t> of_vertex;                    ///< the cluster of each vertex
  std::vector<std::uint32_t> middle;                       ///< the vertex of each cluster that is nearest to its mean
  std::vector<std::array<std::uint32_t, 3>> triangles;     ///< the mesh's, by cluster: those between three of them
};

/// No two vertices of a cluster are farther apart than `spacing` (metres) or, where vertices are dense, some edges; none is turned
/// more than 38 degrees from the first, so that a twig keeps its sides. With spacing 0 each vertex is its own cluster.
/// Clusters are numbered along the vertices and take them from runs of neighbouring numbers: a mesh whose numbers jump about in space
/// gets more of them. The mesh needs normals. Empty if cancelled. In the current arena; the same at any thread count. Cost: linear,
/// some 50 ns a vertex.
VertexClusters cluster_vertices(const Mesh& mesh, double spacing, const RunOptions& run);

}  // namespace cambium
