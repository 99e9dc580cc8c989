#include "skeletons/graph/solids.h"

#include "blobtree/input_error.h"

#include <algorithm>
#include <cmath>

namespace cambium {
namespace {

constexpr double kPi = std::numbers::pi;

template <class... Cases>
struct Match : Cases... { using Cases::operator()...; };
template <class... Cases>
Match(Cases...) -> Match<Cases...>;

double across(const Vec3& p) { return std::hypot(p.x, p.y); }

void require_positive(double value, const char* key) {
  if (!(value > 0) || !std::isfinite(value))
    throw InputError({}, std::string(key) + " = " + std::to_string(value), "a finite " + std::string(key) + " above 0");
}

double cone_radius(const ConeSolid& cone, double z) { return cone.radius_base + (cone.radius_tip - cone.radius_base) * z / cone.height; }

}  // namespace

bool contains(const Solid& solid, const Vec3& p) {
  return std::visit(Match{
    [&](const BallSolid& s) {
      const double length = glm::length(p);
      return length <= s.radius && (s.angle >= kPi || p.z >= length * std::cos(s.angle));
    },
    [&](const EllipsoidSolid& s) { const Vec3 q = p / s.half_size; return glm::dot(q, q) <= 1; },
    [&](const CylinderSolid& s) { return 0 <= p.z && p.z <= s.height && across(p) <= s.radius; },
    [&](const ConeSolid& s) { return 0 <= p.z && p.z <= s.height && across(p) <= cone_radius(s, p.z); },
  }, solid);
}

double depth(const Solid& solid, const Vec3& p) {
  return std::visit(Match{
    [&](const BallSolid& s) { return s.radius - glm::length(p); },
    [&](const EllipsoidSolid& s) {
      return (1 - glm::length(p / s.half_size)) * std::min({s.half_size.x, s.half_size.y, s.half_size.z});
    },
    [&](const CylinderSolid& s) { return std::min({p.z, s.height - p.z, s.radius - across(p)}); },
    [&](const ConeSolid& s) {
      const double slope = (s.radius_base - s.radius_tip) / s.height;
      double d = (cone_radius(s, p.z) - across(p)) / std::hypot(1.0, slope);
      if (s.radius_base > 0) d = std::min(d, p.z);
      if (s.radius_tip > 0) d = std::min(d, s.height - p.z);
      return d;
    },
  }, solid);
}

Box bounds(const Solid& solid) {
  return std::visit(Match{
    [](const BallSolid& s) {
      const double side = s.angle >= 0.5 * kPi ? s.radius : s.radius * std::sin(s.angle);
      const double low = s.angle >= 0.5 * kPi ? s.radius * std::cos(s.angle) : 0.0;
      return Box{{-side, -side, low}, {side, side, s.radius}};
    },
    [](const EllipsoidSolid& s) { return Box{-s.half_size, s.half_size}; },
    [](const CylinderSolid& s) { return Box{{-s.radius, -s.radius, 0}, {s.radius, s.radius, s.height}}; },
    [](const ConeSolid& s) {
      const double side = std::max(s.radius_base, s.radius_tip);
      return Box{{-side, -side, 0}, {side, side, s.height}};
    },
  }, solid);
}

void validate(const Solid& solid) {
  std::visit(Match{
    [](const BallSolid& s) {
      require_positive(s.radius, "radius");
      require_positive(s.angle, "alpha");
      if (s.angle > kPi * (1 + 1e-12)) throw InputError({}, "alpha = " + std::to_string(s.angle / kPi) + " pi", "an alpha of at most pi");
    },
    [](const EllipsoidSolid& s) {
      for (int i = 0; i < 3; ++i) require_positive(s.half_size[i], "half_size");
    },
    [](const CylinderSolid& s) { require_positive(s.radius, "radius"), require_positive(s.height, "height"); },
    [](const ConeSolid& s) {
      require_positive(s.height, "height");
      if (s.radius_base < 0) require_positive(s.radius_base, "radius_base");
      if (s.radius_tip < 0) require_positive(s.radius_tip, "radius_tip");
      require_positive(s.radius_base + s.radius_tip, "radius_base");
    },
  }, solid);
}

}  // namespace cambium
