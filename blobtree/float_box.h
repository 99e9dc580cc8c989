// A box kept in half the memory: floats rounded outwards.
#pragma once

#include "blobtree/geometry.h"

#include <cmath>
#include <limits>

namespace cambium {

struct FloatBox {
  glm::vec3 lo{std::numeric_limits<float>::infinity()};
  glm::vec3 hi{-std::numeric_limits<float>::infinity()};

  FloatBox() = default;
  explicit FloatBox(const Box& box) {
    for (int a = 0; a < 3; ++a) {
      lo[a] = at_most(box.lo[a]);
      hi[a] = -at_most(-box.hi[a]);
    }
  }
  Box box() const { return {Vec3(lo), Vec3(hi)}; }
  bool empty() const { return !(lo.x <= hi.x && lo.y <= hi.y && lo.z <= hi.z); }
  bool intersects(const FloatBox& b) const {   // without branches
    return (lo.x <= b.hi.x) & (b.lo.x <= hi.x) & (lo.y <= b.hi.y) & (b.lo.y <= hi.y) & (lo.z <= b.hi.z) & (b.lo.z <= hi.z);
  }
  bool contains(const FloatBox& b) const {
    return lo.x <= b.lo.x && lo.y <= b.lo.y && lo.z <= b.lo.z && hi.x >= b.hi.x && hi.y >= b.hi.y && hi.z >= b.hi.z;
  }
  void extend(const FloatBox& b) {
    lo = glm::min(lo, b.lo);
    hi = glm::max(hi, b.hi);
  }
  /// To the nearest point of the box, squared; 0 inside.
  double distance2(const Vec3& p) const {
    const Vec3 beyond = glm::max(glm::max(Vec3(lo) - p, p - Vec3(hi)), Vec3(0.0));
    return glm::dot(beyond, beyond);
  }

 private:
  static float at_most(double v) {
    const float f = static_cast<float>(v);
    return static_cast<double>(f) <= v ? f : std::nextafter(f, -std::numeric_limits<float>::infinity());
  }
};

}  // namespace cambium
