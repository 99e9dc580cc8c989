// What one ray of the camera brings back.
#pragma once

#include "blobtree/geometry.h"

namespace cambium {

/// One camera sample. Its light is direct + albedo * ambient; they are kept apart so that the noise of the few sky rays can be
/// smoothed without touching texture or the sun's shadow edges.
struct CameraSample {
  Vec3 direct{0.0};        ///< sun, and the sky where nothing was hit
  Vec3 ambient{0.0};       ///< light from sky and surroundings, not yet multiplied by albedo
  Vec3 albedo{0.0};
  Vec3 normal{0.0};        ///< geometric, world; zero on a miss
  double depth = kInfinity;
  double branch = -1;
  int rays = 0;

  Vec3 color() const { return direct + albedo * ambient; }
};

}  // namespace cambium
