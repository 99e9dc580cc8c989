// Texture coordinates from the places of vertices on branches.
#pragma once

#include "polygonize/surface_places.h"

namespace cambium {

/// Fills in uvs, uv_triangles, unrolled, triangle_order and tile. Runs in the current arena. False if cancelled.
/// Every triangle takes the coordinates of one primitive for its three corners: of those that contribute at all three the one
/// that weighs most, else of one branch; where not even that is found, the corners that lack it get their neighbour's.
/// Cost: some 0.1 microseconds a triangle.
bool lay_out_texture(const Mesh& mesh, const SurfacePlaces& places, const MeshAttributeOptions& options, MeshAttributes& out,
                     const RunOptions& run);

}  // namespace cambium
