// Smoothing of the ambient light between neighbouring pixels of one surface.
#pragma once

#include "blobtree/geometry.h"
#include "blobtree/run_options.h"

#include <vector>

namespace cambium {

/// One pixel's means over its samples; vec3 in float, the film is large.
struct PixelMean {
  glm::vec3 direct{0.0f};
  glm::vec3 albedo{0.0f};          ///< over all samples, zero where they missed
  glm::vec3 lit{0.0f};             ///< albedo * ambient
  glm::vec3 normal{0.0f};
  float depth = 0;                 ///< mean over the samples that hit; infinity if none did
  float coverage = 0;              ///< share of samples that hit
};

/// For each pixel the ambient part of its light, `lit`, with the sky rays' noise averaged over neighbours that lie on the same
/// surface (plane distance and normal agree): three passes of an edge-avoiding a-trous filter (Dammertz et al. 2010).
/// pixel_angle: radians per pixel. Deterministic. Empty if cancelled.
std::vector<glm::vec3> smooth_ambient(const std::vector<PixelMean>& pixels, int width, int height, double pixel_angle,
                                      const RunOptions& run);

}  // namespace cambium
