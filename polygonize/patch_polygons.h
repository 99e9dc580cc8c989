// The polygons dual to the crossed minimal edges, as triangles that stay inside their edges' envelopes: the mesh cannot cross
// itself (Ju & Udeshi 2006, Intersection-free contouring on an octree grid).
#pragma once

#include "polygonize/contour.h"
#include "polygonize/mesh.h"
#include "polygonize/polygon_split.h"

#include <cstddef>
#include <optional>
#include <vector>

namespace cambium {

struct DualMesh {
  Mesh mesh;                        ///< positions, normals, triangles, creases; the patches' vertices come first
  std::size_t face_vertices = 0;    ///< added where two leaves' vertices do not see each other through their face
  std::size_t edge_vertices = 0;    ///< added where a polygon would leave its envelope
};

/// Of a compacted contour; positions: of its patches' vertices, each strictly inside its leaf. Where every leaf has one patch, no two
/// triangles meet but in what they share.
/// splits: by edge, one that fits (polygon_split.h), or none where it is to be chosen here.
/// tolerance: a diagonal that is off by more than half of it gives way to a better one. nullopt if cancelled. Cost: linear in the
/// edges.
std::optional<DualMesh> build_polygons(const SurfaceOctree& tree, const SurfaceCover& cover, const Contour& contour,
                                       const std::vector<Vec3>& positions, const std::vector<std::optional<Split>>& splits,
                                       double tolerance, const RunOptions& run);

}  // namespace cambium
