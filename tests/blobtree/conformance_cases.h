// The BlobTrees that the conformance suite runs over: every node by itself, and random nests of all of them.
#pragma once

#include "blobtree/blobtree.h"

#include <cmath>
#include <cstdint>
#include <string>
#include <vector>

namespace cambium {

/// Uniform draws that are the same on every platform (splitmix64).
class Draws {
 public:
  explicit Draws(std::uint64_t seed) : state_(seed) {}
  std::uint64_t next() {
    std::uint64_t z = (state_ += 0x9E3779B97F4A7C15u);
    z = (z ^ (z >> 30)) * 0xBF58476D1CE4E5B9u;
    z = (z ^ (z >> 27)) * 0x94D049BB133111EBu;
    return z ^ (z >> 31);
  }
  double in(double lo, double hi) { return lo + (hi - lo) * (static_cast<double>(next() >> 11) * 0x1.0p-53); }
  int below(int n) { return static_cast<int>(next() % static_cast<std::uint64_t>(n)); }
  bool chance(double p) { return in(0, 1) < p; }
  Vec3 point(const Box& box) { return {in(box.lo.x, box.hi.x), in(box.lo.y, box.hi.y), in(box.lo.z, box.hi.z)}; }
  Vec3 direction() {
    for (;;) {
      const Vec3 v = point({Vec3(-1), Vec3(1)});
      if (const double l = glm::length(v); l > 0.1 && l < 1) return v / l;
    }
  }
  /// A box of random place and size inside (or partly inside) another.
  Box box(const Box& in_box) {
    const Vec3 half = 0.5 * in_box.size() * std::pow(10.0, in(-2, 0)) * in(0.3, 1);
    const Vec3 center = point(in_box);
    return {center - half, center + half};
  }

 private:
  std::uint64_t state_;
};

struct ConformanceCase {
  std::string name;
  BlobTree tree;
};

/// Nested up to `depth` operators; everything within a few metres of the origin. Always legal and bounded.
BlobTree random_blobtree(std::uint64_t seed, int depth);

/// Every alternative of Node at least once, then random nests.
const std::vector<ConformanceCase>& conformance_cases();

}  // namespace cambium
