// How far light is followed.
#pragma once

#include "blobtree/geometry.h"

namespace cambium {

inline constexpr int kMostBounces = 1000;

struct PathOptions {
  /// Surfaces that light may touch between the one seen and its source. 0: sun, sky and lamps by shadow rays alone.
  int bounces = 1;
  /// How far an obstacle may be to count for a sample's occlusion, metres.
  double occlusion_distance = 1;
  /// Most luminance that one sample may bring from around, by sky rays and bounces. A finite value keeps rare bright paths from
  /// speckling the picture, and makes it darker than it should be.
  double clamp = kInfinity;
  /// The bark's relief as shading: tilted normals, and cracks that see less of the sky.
  bool relief = true;
};

}  // namespace cambium
