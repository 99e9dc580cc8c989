// Smoothing of the ambient light between neighbouring pixels of one surface.
#pragma once

#include "blobtree/geometry.h"

#include <vector>

namespace cambium {

/// One pixel's ambient light and the surface that it falls on; vec3 in float, the film is large.
struct AmbientPixel {
  glm::vec3 albedo{0.0f};          ///< mean over all samples, zero where they missed
  glm::vec3 lit{0.0f};             ///< the same of albedo * ambient
  glm::vec3 normal{0.0f};          ///< unit, mean over the samples that hit
  glm::vec3 from_eye{0.0f};        ///< mean place of the hits, metres
  float light = 0, light_squared = 0;  ///< sums over the hits of the ambient light's luminance and its square
  float hits = 0;                  ///< how many samples hit; 0: there is no surface here
  float covered = 0;               ///< share of the samples that hit
};

/// The farthest pixel that one pixel's result depends on, in each direction.
constexpr int kSmoothingReach = 2 + 2 * (1 + 2 + 4 + 8);

/// For each pixel the ambient part of its light, `lit`, with the noise of its few rays averaged over neighbours that lie on the
/// same surface: passes of an edge-avoiding a-trous filter (Dammertz et al. 2010). Neighbours count by how many samples they have,
/// and not where the light differs by more than its noise explains (Schied et al. 2017), so that the shade in a crotch stays.
/// pixel_angle: radians per pixel. Deterministic.
std::vector<glm::vec3> smooth_ambient(const std::vector<AmbientPixel>& pixels, int width, int height, double pixel_angle);

}  // namespace cambium
