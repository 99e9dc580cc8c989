// Hermite data: where the surface crosses the octree's minimal edges, and its normals there.
#pragma once

#include "polygonize/contour.h"

namespace cambium {

/// Of the edges listed, into contour.crossings. False if cancelled. Accuracy: 1e-4 of the edge, or as near to kIso as float batches
/// tell (1e-4, where values are about 1); nearer to an end than 1e-3 of the edge, that.
bool find_crossings(const SurfaceOctree& tree, const SurfaceCover& cover, const std::vector<std::uint32_t>& edges,
                    Contour& contour, const RunOptions& run);

}  // namespace cambium
