// The camera as rays: a thin lens.
#pragma once

#include "raytrace/camera.h"
#include "raytrace/ray_root.h"

#include <array>

namespace cambium {

struct View {
  Vec3 eye, forward, right, up;            ///< unit and orthogonal; the eye is the middle of the lens
  double tan_x = 0, tan_y = 0;             ///< of half the field of view
  int width = 0, height = 0;
  double lens_radius = 0;                  ///< metres; 0: a pinhole
  double focus_distance = 1;               ///< from the eye along `forward`, metres: the plane that is sharp

  /// Through (x, y) in pixels from the top left and through the middle of the lens.
  Ray ray(double x, double y) const;
  /// The same point of the plane that is sharp, seen from a point of the lens: `sample` in [0, 1)^2, of equal areas (Kolb, Mitchell &
  /// Hanrahan 1995, section 3). Of a pinhole the ray above, to the last bit.
  Ray ray(double x, double y, const std::array<double, 2>& sample) const;
  /// Width of one pixel, radians (in the middle of the picture).
  double pixel_angle() const { return 2 * tan_y / height; }

  /// Looks that way; up is as vertical as it can be. `direction` need not be unit; zero: to the north.
  void look_along(const Vec3& direction);
  /// Turned about the vertical through `center` by `angle` radians, counter-clockwise seen from above.
  View turned(const Vec3& center, double angle) const;
};

/// What the camera says of the lens, for a picture of that many pixels; its place, direction and focus are still to be set.
View lens_of(const Camera& camera, int width, int height);
/// The focus that the camera asks for, or through `otherwise`. At least a hundredth of a millimetre in front of the lens.
void focus(View& view, const Camera& camera, const Vec3& otherwise);

}  // namespace cambium
