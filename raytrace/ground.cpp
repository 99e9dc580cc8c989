#include "raytrace/ground.h"

#include "raytrace/bark_noise.h"

#include <algorithm>
#include <cmath>

namespace cambium {

double meet(const Ground& ground, const Ray& ray) {
  if (!(ray.direction.z < 0 && ray.origin.z > ground.height)) return kInfinity;
  return (ground.height - ray.origin.z) / ray.direction.z;
}

double haze(const Ground& ground, double distance) { return 1 - std::exp(-std::pow(distance / ground.fade, 1.5)); }

double mottle(const Vec3& p, double footprint) {
  double sum = 0, amplitude = 0.10;
  for (double size : {0.9, 0.23, 0.06}) {
    const double kept = std::clamp(1.2 - footprint / (0.8 * size), 0.0, 1.0);
    if (kept > 0) sum += amplitude * kept * (2 * bark_noise(p.x / size, p.y / size, 1u << 20, 0x5eed) - 1);
    amplitude *= 0.8;
  }
  return 1 + sum;
}

}  // namespace cambium
