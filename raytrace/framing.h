// The camera as rays, and finding the place from which the tree fills the picture.
#pragma once

#include "blobtree/surface_cover.h"
#include "raytrace/camera.h"
#include "raytrace/ray_root.h"

#include <span>
#include <vector>

namespace cambium {

struct View {
  Vec3 eye, forward, right, up;   ///< unit and orthogonal
  double tan_x = 0, tan_y = 0;    ///< of half the field of view
  int width = 0, height = 0;

  /// Through (x, y) in pixels from the top left.
  Ray ray(double x, double y) const;
  /// Width of one pixel, radians (in the middle of the picture).
  double pixel_angle() const { return 2 * tan_y / height; }
};

/// An unset eye or target is chosen so that every one of the boxes (or camera.frame) lies in the picture, margin kept, as near
/// as that allows. Without boxes: a cube of 1 m around the origin. Exact for the boxes' corners.
View frame(const Camera& camera, std::span<const Box> boxes, int width, int height);

/// Boxes that hold the surface more tightly than the cells' own: each cell is cut into equal parts, finer the fewer cells there
/// are, and parts without surface are left out. In the cells' order, at most one a cell. Cost: at most about 200,000 intervals.
std::vector<Box> surface_boxes(const SurfaceCover& cover);

}  // namespace cambium
