// The camera as rays, and finding the place from which the tree fills the picture.
#pragma once

#include "raytrace/ray_root.h"
#include "raytrace/render.h"

#include <span>

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

}  // namespace cambium
