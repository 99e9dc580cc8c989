// How many samples a pixel takes, and where in and around the pixel.
#pragma once

#include <vector>

namespace cambium {

struct Sampling {
  int min = 1, max = 16;       ///< per pixel; a pixel that may show the surface takes at least 8 (if max allows)
  double noise = 0.0175;       ///< standard error of the displayed luminance, [0, 1], at which a pixel is done
  double filter_radius = 1.5;  ///< pixels; of the reconstruction filter (PixelFilter)
};

constexpr int kMostSamples = 65535;   // a pixel counts them in 16 bits
constexpr int kLargestFilter = 8;     // radius in pixels

/// Samples per pixel after each pass: min, then doubled up to max. For (3, 16): 3, 6, 12, 16.
inline std::vector<int> passes(const Sampling& sampling) {
  std::vector<int> counts{sampling.min};
  while (counts.back() < sampling.max) {
    counts.push_back(counts.back() > sampling.max / 2 ? sampling.max : 2 * counts.back());
  }
  return counts;
}

}  // namespace cambium
