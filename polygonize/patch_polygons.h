// The polygons dual to the crossed minimal edges, as triangles that stay inside their edges' envelopes: the mesh cannot cross
// itself (Ju & Udeshi 2006, Intersection-free contouring on an octree grid).
#pragma once

#include "polygonize/mesh.h"
#include "polygonize/patch_vertices.h"

#include <cstddef>
#include <optional>
#include <vector>

namespace cambium {

/// Where vertices on the surface of a convex twig leave the polygons inside it, moving them outwards by half of that brings both
/// to the same distance: polygons then reach the tolerance with half as many cells.
struct BalancedVertices {
  std::vector<Vec3> positions;              ///< by patch, inside their leaves; creases stay where they are
  std::vector<float> errors;                ///< by minimal edge: of the polygon's plane where the surface crosses the edge, metres
};

/// Moves no vertex by more than half of `tolerance`.
BalancedVertices balance_vertices(const SurfaceOctree& tree, const Contour& contour, double tolerance);

struct DualMesh {
  Mesh mesh;                        ///< positions, normals, triangles, creases; the patches' vertices come first
  std::size_t face_vertices = 0;    ///< added where two leaves' vertices do not see each other through their face
  std::size_t edge_vertices = 0;    ///< added where a polygon would leave its envelope
};

/// Each leaf's vertices are strictly inside it; where every leaf has one patch, no two triangles meet but in what they share.
/// nullopt if cancelled. Cost: linear in the edges.
std::optional<DualMesh> build_polygons(const SurfaceOctree& tree, const SurfaceCover& cover, const Contour& contour,
                                       const std::vector<Vec3>& positions, const RunOptions& run);

}  // namespace cambium
