// Random BlobTrees for property tests: any node in any nest, the same on every platform.
#pragma once

#include "blobtree/blobtree.h"

#include <cmath>
#include <cstdint>
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
    const double scale = std::pow(10.0, in(-2, 0));
    const Vec3 half = 0.5 * in_box.size() * scale * in(0.3, 1);
    const Vec3 center = point(in_box);
    return {center - half, center + half};
  }

 private:
  std::uint64_t state_;
};

/// Grows legal, bounded nests of any nodes within a few metres of the origin. The same seed grows the same nodes.
class BlobTreeGrower {
 public:
  static constexpr int kPrimitives = 8;   ///< those that are bounded by themselves
  static constexpr int kOperators = 12;   ///< warps included

  /// decades: primitives are smaller than usual by up to 10^decades, each by its own factor.
  /// flared: every other primitive is a flare; without it none is, and seeds give what they gave before there were any.
  explicit BlobTreeGrower(std::uint64_t seed, double decades = 0, bool flared = false)
      : draws_(seed), decades_(decades), flared_(flared) {}

  NodeId any(int depth);                  ///< at most `depth` operators above each other
  NodeId primitive(int kind);             ///< kind in [0, kPrimitives)
  NodeId flare();
  NodeId op(int kind, int depth);         ///< kind in [0, kOperators), over children grown by any(depth - 1)
  NodeId half_space();                    ///< sometimes under a twist; for an operator that bounds it

  NodeId add(Node node) { return builder_.add(std::move(node)); }
  BlobTree finish(NodeId root) { return builder_.build(root); }
  Draws& draws() { return draws_; }

 private:
  Chain chain(Vec3 p, double strength, double thinness);
  std::vector<NodeId> several(int depth);
  NodeId fork(int depth);
  NodeId transform(int depth);
  NodeId bend();

  Draws draws_;
  double decades_;
  bool flared_;
  BlobTreeBuilder builder_;
};

/// Nested up to `depth` operators; everything within a few metres of the origin. Always legal and bounded.
BlobTree random_blobtree(std::uint64_t seed, int depth);
/// The same with flares.
BlobTree random_flared_blobtree(std::uint64_t seed, int depth);

/// A trunk of three metres along an axis from a base, that leans a little; prongs at uneven angles and of uneven lengths.
Flare flared_trunk(std::size_t prongs, double sharpness, FlareSection section = FlareSection::kEnvelope, const Vec3& base = Vec3(0.0),
                   const Vec3& axis = {0, 0, 1});

}  // namespace cambium
