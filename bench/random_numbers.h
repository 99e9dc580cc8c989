// Numbers drawn from a seed, the same on every machine and with every standard library.
#pragma once

#include <cmath>
#include <cstdint>

#include "blobtree/geometry.h"

namespace cambium::bench {

/// The splitmix64 sequence (Steele, Lea, Flood 2014).
class RandomNumbers {
 public:
  explicit RandomNumbers(std::uint64_t seed) : state_(seed) {}

  std::uint64_t bits() {
    std::uint64_t z = state_ += 0x9e3779b97f4a7c15u;
    z = (z ^ (z >> 30)) * 0xbf58476d1ce4e5b9u;
    z = (z ^ (z >> 27)) * 0x94d049bb133111ebu;
    return z ^ (z >> 31);
  }
  /// In [0, 1).
  double unit() { return static_cast<double>(bits() >> 11) * 0x1p-53; }
  double between(double lo, double hi) { return lo + (hi - lo) * unit(); }
  std::uint64_t below(std::uint64_t count) { return bits() % count; }
  Vec3 direction() {
    for (;;) {
      const Vec3 v{between(-1, 1), between(-1, 1), between(-1, 1)};  // braces: drawn in this order
      const double size = glm::length(v);
      if (size > 0.1 && size <= 1) return v / size;
    }
  }
  /// A unit vector across a unit vector.
  Vec3 across(const Vec3& axis) {
    for (;;) {
      const Vec3 v = glm::cross(axis, direction());
      const double size = glm::length(v);
      if (size > 0.1) return v / size;
    }
  }

 private:
  std::uint64_t state_;
};

}  // namespace cambium::bench
