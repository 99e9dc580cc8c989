// Well-spread sample points per pixel: Owen-scrambled Sobol pairs, a pure function of (seed, pixel, sample, use).
#pragma once

#include "blobtree/place_hash.h"

#include <array>
#include <cstdint>

namespace cambium {

/// What a pair of numbers is for; each use has its own scramble.
enum class Use : std::uint32_t { kPixel, kLens, kOnward, kRoulette, kSun, kSpot, kAround, kLamp };

class PixelSampler {
 public:
  PixelSampler(std::uint64_t seed, int x, int y)
      : base_(hash_of(seed, static_cast<std::uint32_t>(x), static_cast<std::uint32_t>(y))) {}

  /// The sample-th pair in [0, 1)^2. Any aligned power of two of samples, up to 65536, is stratified in both dimensions (a
  /// (0,2)-net); the next 65536 are another such set. Of two uses the pairs are as independent as random ones.
  /// depth and item (the how-manieth on a path, of several of a kind; each < 65536) tell apart what one use takes more than once.
  std::array<double, 2> pair(std::uint32_t sample, Use use, std::uint32_t depth = 0, std::uint32_t item = 0) const;

 private:
  std::uint64_t base_;
};

}  // namespace cambium
