// Hermite data: where the surface crosses the octree's minimal edges, and its normals there.
#pragma once

#include "polygonize/contour.h"

namespace cambium {

/// Of the edges listed, into contour.crossings. False if cancelled. Accuracy: about 1e-4 of the edge, or 2e-5 in the field.
bool find_crossings(const SurfaceOctree& tree, const SurfaceCover& cover, const std::vector<std::uint32_t>& edges,
                    Contour& contour, const RunOptions& run);

}  // namespace cambium
