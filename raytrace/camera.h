// Where a picture is taken from, and through which lens.
#pragma once

#include "blobtree/geometry.h"

#include <optional>

namespace cambium {

/// One picture of a walk around the tree: the camera, wherever it would stand, is turned by frame/frames of a full circle, counter-clockwise
/// seen from above, about the vertical through its target (or the middle of what is framed). An automatic camera stands back so
/// far that nothing leaves any picture of any walk.
struct Turntable {
  int frame = 0, frames = 1;
};

struct Camera {
  std::optional<Vec3> eye, target;         ///< unset: framed on the field (or on `frame`)
  std::optional<Box> frame;                ///< what to frame instead of the whole field
  double azimuth = 0.6, elevation = 0.05;  ///< radians, direction from which an automatic camera looks
  double field_of_view = 0.61;             ///< radians, vertical
  double margin = 1.06;                    ///< of automatic framing
  std::optional<Turntable> turntable;

  /// Metres; set, it takes the place of field_of_view: the picture's longer side is 36 mm of film.
  std::optional<double> focal_length;
  double f_number = kInfinity;             ///< focal length over the lens's diameter; infinite: a pinhole, all is sharp
  /// What is sharp: the plane through a point, or at metres from the eye along the view. Neither: through the target, or the middle of
  /// what is framed.
  std::optional<Vec3> focus;
  std::optional<double> focus_distance;
};

}  // namespace cambium
