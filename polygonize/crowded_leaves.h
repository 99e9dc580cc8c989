// Leaves that hold several patches: two sheets of the surface in one cell.
#pragma once

#include "polygonize/contour.h"

#include <vector>

namespace cambium {

/// By patch of a compacted contour: whether its leaf has others. Cost: linear.
std::vector<bool> crowded_patches(const Contour& contour);

/// The middles of crowded leaves in which no plane that was tried keeps the patches' crossings apart, so that their sheets may
/// touch, or pass through each other where the true ones do not.
std::vector<Vec3> entangled_leaves(const SurfaceOctree& tree, const Contour& contour);

}  // namespace cambium
