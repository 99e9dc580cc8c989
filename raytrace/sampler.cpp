#include "raytrace/sampler.h"

namespace cambium {
namespace {

std::uint32_t reversed(std::uint32_t x) {
  x = (x >> 16) | (x << 16);
  x = ((x & 0x00ff00ffu) << 8) | ((x & 0xff00ff00u) >> 8);
  x = ((x & 0x0f0f0f0fu) << 4) | ((x & 0xf0f0f0f0u) >> 4);
  x = ((x & 0x33333333u) << 2) | ((x & 0xccccccccu) >> 2);
  return ((x & 0x55555555u) << 1) | ((x & 0xaaaaaaaau) >> 1);
}

/// Owen's nested scramble: each bit is flipped by a hash of the bits above it. On reversed bits, a product with an even number
/// carries only from below, which is just that (Laine and Karras 2011).
std::uint32_t scrambled(std::uint32_t x, std::uint32_t seed) {
  x = reversed(x) + seed;
  x ^= x * 0x6c50b47cu;
  x ^= x * ((seed >> 7) & ~1u);
  x ^= x * 0xb82f1e52u;
  x ^= x * 0xc7afe638u;
  return reversed(x);
}

}  // namespace

std::array<double, 2> PixelSampler::pair(std::uint32_t sample, Use use, std::uint32_t depth, std::uint32_t item) const {
  const std::uint64_t set = sample >> 16;
  const std::uint64_t purpose = (set << 48) + (std::uint64_t(item) << 32) + (depth << 4) + static_cast<std::uint32_t>(use) + 1;
  const std::uint64_t bits = mix_bits(base_ + 0x9e3779b97f4a7c15ull * purpose);
  // Another order for each use, itself an Owen scramble so that aligned powers of two stay together (Burley 2020): else the pixel's
  // bits would go hand in hand with the lens's and the light's, and more samples would not fill what they span together.
  const std::uint32_t index = scrambled(sample << 16, static_cast<std::uint32_t>(mix_bits(bits))) >> 16;
  std::uint32_t second = 0;
  for (std::uint32_t rest = index, column = 0x80000000u; rest; rest >>= 1, column ^= column >> 1) {
    if (rest & 1u) second ^= column;
  }
  const std::uint32_t a = scrambled(reversed(index), static_cast<std::uint32_t>(bits >> 8));
  const std::uint32_t b = scrambled(second, static_cast<std::uint32_t>(bits >> 32));
  return {a * 0x1p-32, b * 0x1p-32};
}

}  // namespace cambium
