// The ground a tree stands on: a level plane.
#pragma once

#include "raytrace/ray_root.h"

namespace cambium {

struct Ground {
  double height = 0;
  double fade = 1;         ///< metres from the camera over which it goes into the horizon
};

/// Where the ray comes down on it from above, metres along the ray; infinity if it does not.
double meet(const Ground& ground, const Ray& ray);
/// How far the ground has gone into the horizon at that distance, [0, 1).
double haze(const Ground& ground, double distance);
/// Trampled soil and grass: a factor on the ground's colour, around 1. Mottling smaller than the footprint (metres) fades out.
double mottle(const Vec3& p, double footprint);

}  // namespace cambium
