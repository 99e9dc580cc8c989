// How far the polygons of a contour are from the surface, asked of the field itself.
#pragma once

#include "polygonize/polygon_split.h"

namespace cambium {

/// A polygon as it is cut into triangles.
struct SplitPolygon {
  std::uint32_t edge = 0;
  Split split = Split::kFirst;
};

/// By polygon, metres, to first order (|f - kIso| by its slope): the farthest of the triangles' centroids and of the middles of their
/// sides, those to other polygons where the corners' normals do not tell (chord_known). positions: of the patches' vertices, each in its
/// leaf. Where a point is in no cell of the cover, and where the field has no slope, nothing is known: it counts as 0.
/// False if cancelled. Cost: about four samples a polygon, in dense batches.
bool measure_polygons(const SurfaceOctree& tree, const SurfaceCover& cover, const Contour& contour, const std::vector<Vec3>& positions,
                      const std::vector<SplitPolygon>& polygons, std::vector<float>& distances, const RunOptions& run);

/// Whether the normals of two vertices tell how far the surface is from the chord between them.
inline bool chord_known(const PatchVertex& a, const PatchVertex& b) {
  return !a.crease && !b.crease && glm::dot(a.normal, b.normal) >= 0.5f;
}

}  // namespace cambium
