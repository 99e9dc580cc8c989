// Finding the place from which the tree fills the picture.
#pragma once

#include "blobtree/surface_cover.h"
#include "raytrace/view.h"

#include <span>
#include <vector>

namespace cambium {

/// An unset eye or target is chosen so that every one of the boxes (or camera.frame) lies in the picture, margin kept, as near
/// as that allows, in every picture of a turntable. Without boxes: a cube of 1 m around the origin. Exact for the boxes' corners, or
/// for the circles they sweep.
View frame(const Camera& camera, std::span<const Box> boxes, int width, int height);

/// Boxes that hold the surface more tightly than the cells' own: each cell is cut into equal parts, finer the fewer cells there
/// are, and parts without surface are left out. In the cells' order, at most one a cell. Cost: at most about 200,000 intervals.
std::vector<Box> surface_boxes(const SurfaceCover& cover);

}  // namespace cambium
