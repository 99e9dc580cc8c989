// What lights a picture.
#pragma once

#include "blobtree/geometry.h"

#include <optional>

namespace cambium {

struct Light {
  double sun_azimuth = -0.7, sun_elevation = 0.75;  ///< radians
  double sun_size = 0.01;                           ///< angular radius, radians
  Vec3 sun_color{2.7, 2.45, 2.05};                   ///< linear
  Vec3 sky_zenith{0.24, 0.42, 0.80}, sky_horizon{0.72, 0.80, 0.90};
  Vec3 ground_color{0.20, 0.185, 0.135};
  bool ground = true;                               ///< a plane that takes shadow at ground_height
  std::optional<double> ground_height;              ///< unset: the axis end of the lowest primitive (a trunk's root)
};

}  // namespace cambium
