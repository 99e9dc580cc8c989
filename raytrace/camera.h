// Where a picture is taken from.
#pragma once

#include "blobtree/geometry.h"

#include <optional>

namespace cambium {

struct Camera {
  std::optional<Vec3> eye, target;         ///< unset: framed on the field (or on `frame`)
  std::optional<Box> frame;                ///< what to frame instead of the whole field
  double azimuth = 0.6, elevation = 0.05;  ///< radians, direction from which an automatic camera looks
  double field_of_view = 0.61;             ///< radians, vertical
  double margin = 1.06;                    ///< of automatic framing
};

}  // namespace cambium
