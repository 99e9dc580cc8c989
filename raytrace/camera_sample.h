// What one ray of the camera brings back.
#pragma once

#include "blobtree/geometry.h"

namespace cambium {

/// One camera sample. Its light is direct + albedo * ambient; they are kept apart so that the noise of the few sky rays can be
/// smoothed without touching texture or the sun's shadow edges.
struct CameraSample {
  Vec3 direct{0.0};        ///< by sun and lamps, and the sky where nothing was hit
  Vec3 ambient{0.0};       ///< by sky and other surfaces, not yet multiplied by albedo
  Vec3 albedo{0.0};        ///< share of even light around that goes to the camera: the colour, with what a coat mirrors
  Vec3 normal{0.0};        ///< geometric, world; zero on a miss
  Vec3 position{0.0};      ///< world, metres; zero on a miss
  glm::dvec2 uv{0.0};      ///< the covering primitive's own coordinates: turns round it, metres along it
  double depth = kInfinity;
  double branch = -1;      ///< of a leaf, that bears it
  bool leaf = false;
  double order = -1;       ///< branch order, the trunk is 0; -1 off the tree
  double ridge = 0;        ///< weight of the branch bark ridges
  double occlusion = 0;    ///< share of the cosine-weighted hemisphere above the point that something near hides; 1: all of it
  double alpha = 1;        ///< 0 where the background is transparent; light is premultiplied by it
  int rays = 0;

  Vec3 color() const { return direct + albedo * ambient; }
};

}  // namespace cambium
