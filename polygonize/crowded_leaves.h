// Leaves that hold several patches: two sheets of the surface in one cell.
#pragma once

#include "polygonize/contour.h"

#include <vector>

namespace cambium {

/// Whether a living patch's leaf has others.
bool is_crowded(const Contour& contour, std::uint32_t patch);

/// By patch of a compacted contour: whether its leaf has others. Cost: linear.
std::vector<bool> crowded_patches(const Contour& contour);

/// The middles of crowded leaves in which no plane that was tried keeps the patches' crossings apart, so that their sheets may
/// touch, or pass through each other where the true ones do not.
std::vector<Vec3> entangled_leaves(const SurfaceOctree& tree, const Contour& contour);

/// Where a crowded patch has its vertex: amid its own crossings, so that those of parallel sheets are apart, and strictly inside its leaf
/// even where all of them are on one face.
Vec3 crowded_position(const SurfaceOctree& tree, const Contour& contour, std::uint32_t patch);

}  // namespace cambium
