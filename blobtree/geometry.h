// Small geometric values shared by every folder. Right-handed, z up, metres (field.md section 1).
#pragma once

#include <glm/glm.hpp>

#include <limits>

namespace cambium {

using Vec3 = glm::dvec3;
using Mat3 = glm::dmat3;
using Mat4 = glm::dmat4;

inline constexpr double kInfinity = std::numeric_limits<double>::infinity();

/// Closed axis-aligned box. Default-constructed it is empty (lo > hi).
struct Box {
  Vec3 lo{kInfinity};
  Vec3 hi{-kInfinity};

  bool empty() const { return !(lo.x <= hi.x && lo.y <= hi.y && lo.z <= hi.z); }
  bool bounded() const {
    return !empty() && lo.x > -kInfinity && lo.y > -kInfinity && lo.z > -kInfinity && hi.x < kInfinity &&
           hi.y < kInfinity && hi.z < kInfinity;
  }
  Vec3 center() const { return 0.5 * (lo + hi); }
  Vec3 size() const { return hi - lo; }
  bool contains(const Vec3& p) const {
    return lo.x <= p.x && p.x <= hi.x && lo.y <= p.y && p.y <= hi.y && lo.z <= p.z && p.z <= hi.z;
  }
  bool intersects(const Box& b) const {
    return lo.x <= b.hi.x && b.lo.x <= hi.x && lo.y <= b.hi.y && b.lo.y <= hi.y && lo.z <= b.hi.z && b.lo.z <= hi.z;
  }
  void extend(const Vec3& p) {
    lo = glm::min(lo, p);
    hi = glm::max(hi, p);
  }
  void extend(const Box& b) {
    lo = glm::min(lo, b.lo);
    hi = glm::max(hi, b.hi);
  }
  Box padded(double margin) const { return {lo - margin, hi + margin}; }
  static Box intersection(const Box& a, const Box& b) { return {glm::max(a.lo, b.lo), glm::min(a.hi, b.hi)}; }
};

struct Ball {
  Vec3 center{0.0};
  double radius = 0.0;
};

/// The ball around a box; every interval over a box is taken over it.
inline Ball circumscribed_ball(const Box& box) { return {box.center(), 0.5 * glm::length(box.size())}; }

struct Interval {
  double lo = 0.0;
  double hi = 0.0;
  bool contains(double v) const { return lo <= v && v <= hi; }
};

}  // namespace cambium
