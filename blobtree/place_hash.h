// Counter-based random numbers: a pure function of (seed, place), so any thread may draw any of them in any order.
#pragma once

#include <cstdint>

namespace cambium {

inline std::uint64_t mix_bits(std::uint64_t x) {
  x ^= x >> 32;
  x *= 0xd6e8feb86659fd93ull;
  x ^= x >> 32;
  x *= 0xd6e8feb86659fd93ull;
  x ^= x >> 32;
  return x;
}

inline std::uint64_t hash_of(std::uint64_t seed, std::uint64_t a, std::uint64_t b = 0) {
  return mix_bits(mix_bits(seed + 0x9e3779b97f4a7c15ull * (a + 1)) + 0xc2b2ae3d27d4eb4full * (b + 1));
}

/// [0, 1)
inline double unit_of(std::uint64_t bits) { return static_cast<double>(bits >> 11) * 0x1p-53; }

/// One draw after another from the stream that a number names.
class StreamDraws {
 public:
  explicit StreamDraws(std::uint64_t stream) : stream_(stream) {}

  std::uint64_t bits() { return hash_of(stream_, count_++); }
  double uniform() { return unit_of(bits()); }                                                     ///< [0, 1)
  double between(double low, double high) { return low + (high - low) * uniform(); }
  std::uint64_t below(std::uint64_t n) { return static_cast<std::uint64_t>(uniform() * static_cast<double>(n)); }  ///< 0 .. n - 1; n < 2^53

 private:
  std::uint64_t stream_, count_ = 0;
};

}  // namespace cambium
