// Random numbers that are a function of what they are for: the same at any thread count and in any order. Private to polygonize/.
#pragma once

#include <cstdint>

namespace cambium {

inline std::uint64_t mixed(std::uint64_t x) {   // splitmix64's finisher
  x = (x ^ (x >> 30)) * 0xbf58476d1ce4e5b9u;
  x = (x ^ (x >> 27)) * 0x94d049bb133111ebu;
  return x ^ (x >> 31);
}

/// [0, 1)
inline double chance(std::uint64_t a, std::uint64_t b, std::uint64_t c, std::uint64_t d) {
  const std::uint64_t bits = mixed(mixed(mixed(mixed(a + 0x9e3779b97f4a7c15u) + b) + c) + d);
  return static_cast<double>(bits >> 11) * 0x1p-53;
}

}  // namespace cambium
