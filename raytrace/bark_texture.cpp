#include "raytrace/bark_texture.h"

#include "raytrace/bark_number.h"

#include <algorithm>
#include <cmath>
#include <numbers>

namespace cambium {

// The images go round a whole number of times, and that number may not jump along a tapering branch: the two neighbouring powers of
// two are faded over.
MappedBark BarkMaps::at(double u, double v, double radius, double footprint) const {
  const double turns = 2 * std::numbers::pi * radius / (std::max(1e-6, size) * color.aspect());
  const double level = std::log2(std::clamp(turns, 1.0, 1024.0));
  const double whole = std::floor(level), weight = smooth(0.35, 0.65, level - whole);
  const MappedBark few = wound(std::exp2(whole), u, v, footprint);
  if (weight <= 0) return few;
  const MappedBark many = wound(std::exp2(whole + 1), u, v, footprint);
  return {glm::mix(few.albedo, many.albedo, weight), std::lerp(few.roughness, many.roughness, weight),
          glm::mix(few.slope, many.slope, weight)};
}

MappedBark BarkMaps::wound(double turns, double u, double v, double footprint) const {
  const double metres = std::max(1e-6, size), s = u * turns, t = v / metres, pixels = footprint / metres;
  MappedBark out;
  out.albedo = color.lookup(s, t, pixels);
  if (normals) out.slope = normals->lookup(s, t, pixels);
  if (roughness) out.roughness = roughness->lookup(s, t, pixels).x;
  return out;
}

}  // namespace cambium
