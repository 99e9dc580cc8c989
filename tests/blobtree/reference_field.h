// The field written out from its specification, as plainly as possible: one recursive function per rule, doubles, no bounds,
// no pruning. It shares nothing with the kernel but the authored BlobTree, so that neither can hide the other's mistakes.
#pragma once

#include "blobtree/blobtree.h"

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <numbers>
#include <vector>

namespace cambium::reference {

// Surface radius over support radius, from the definition: g(kRatio) = 0.5.
inline const double kRatio = std::sqrt(1 - std::cbrt(0.5));

inline double falloff(double x) { return x < 1 ? std::pow(1 - x * x, 3) : 0.0; }
inline double primitive(double distance, double radius, double strength) {
  return strength * falloff(kRatio * distance / radius);
}

inline double distance_to_segment(const Vec3& p, const Vec3& a, const Vec3& b) {
  const Vec3 d = b - a;
  const double dd = glm::dot(d, d);
  const double t = dd > 0 ? std::clamp(glm::dot(p - a, d) / dd, 0.0, 1.0) : 0.0;
  return glm::length(p - (a + t * d));
}

// ---- primitives ------------------------------------------------------------------------------------------------
inline double distance_to_solid_cone(const Vec3& p, const Vec3& base, const Vec3& tip, double base_disc) {
  const double length = glm::length(tip - base);
  if (length == 0) return glm::length(p - base);
  const Vec3 axis = (tip - base) / length;
  const double h = glm::dot(p - base, axis);
  const double r = glm::length((p - base) - h * axis);
  if (h >= 0 && h <= length && r <= base_disc * (1 - h / length)) return 0;
  const Vec3 q(r, h, 0);
  return std::min(distance_to_segment(q, Vec3(0, 0, 0), Vec3(base_disc, 0, 0)),
                  distance_to_segment(q, Vec3(base_disc, 0, 0), Vec3(0, length, 0)));
}

inline double value(const Cone& n, const Vec3& p) {
  const bool turned = n.radius_tip > n.radius_base;
  const Vec3 base = turned ? n.tip : n.base, tip = turned ? n.base : n.tip;
  const double thick = std::max(n.radius_base, n.radius_tip), thin = std::min(n.radius_base, n.radius_tip);
  return primitive(distance_to_solid_cone(p, base, tip, thick - thin), thin, n.strength);
}

inline double segment_ratio(const ChainNode& from, const ChainNode& to, const Vec3& p) {
  const Vec3 q = p - from.position, d = to.position - from.position;
  const double r = from.radius, growth = to.radius - from.radius;
  const double numerator = glm::dot(q, d) * r + glm::dot(q, q) * growth;
  const double denominator = glm::dot(d, d) * r + glm::dot(q, d) * growth;
  const double t = denominator <= 0 ? (growth > 0 ? 1.0 : 0.0) : std::clamp(numerator / denominator, 0.0, 1.0);
  return glm::length(q - t * d) / (r + t * growth);
}

inline double chain_ratio(const std::vector<ChainNode>& nodes, const Vec3& p) {
  if (nodes.size() == 1) return segment_ratio(nodes.front(), nodes.front(), p);
  double ratio = kInfinity;
  for (std::size_t i = 1; i < nodes.size(); ++i) ratio = std::min(ratio, segment_ratio(nodes[i - 1], nodes[i], p));
  return ratio;
}

inline double value(const Chain& n, const Vec3& p) { return n.strength * falloff(kRatio * chain_ratio(n.nodes, p)); }

inline double flare_section(FlareSection section, double q, double tau) {
  switch (section) {
    case FlareSection::kEnvelope: {
      q = std::min(q, 0.999999);
      const double x = std::clamp(std::tanh(std::atanh(q) / 3), -tau, tau);
      return (1 - x * x) / std::sqrt(1 + x * x - 2 * x * q);
    }
    case FlareSection::kQuadrifolium: return std::hypot(1.0, std::sqrt((1 + tau) * (1 + tau) - 1) * q);
    case FlareSection::kCircle: {   // where the ray from the origin at angle 2 acos(q) leaves the circle
      const double angle = 2 * std::acos(q), radius = 1 + tau / 2, middle = tau / 2;
      return middle * std::cos(angle) + std::sqrt(std::max(0.0, radius * radius - std::pow(middle * std::sin(angle), 2)));
    }
  }
  return 0;
}

inline double value(const Flare& n, const Vec3& p) {
  const Vec3 axis = glm::normalize(n.axis);
  const Vec3 to = glm::length(glm::cross(axis, Vec3(1, 0, 0))) > 1e-6 ? Vec3(1, 0, 0) : Vec3(0, 1, 0);
  const Vec3 x = glm::normalize(to - glm::dot(to, axis) * axis), y = glm::cross(axis, x), from = p - n.base;
  const double turn = 2 * std::numbers::pi, azimuth = std::atan2(glm::dot(from, y), glm::dot(from, x));
  const auto ahead = [&](double from_angle, double to_angle) {   // counterclockwise, in (0, 2 pi]
    const double a = std::fmod(to_angle - from_angle, turn);
    return a <= 0 ? a + turn : a;
  };
  // The nearest prong, the next one on the point's side of it.
  std::size_t nearest = 0;
  double away = kInfinity;
  bool beyond = false;
  for (std::size_t i = 0; i < n.prongs.size(); ++i) {
    const double over = std::fmod(ahead(n.prongs[i].angle, azimuth), turn), under = turn - over;
    if (std::min(over, under) >= away) continue;
    away = std::min(over, under);
    beyond = over <= under;
    nearest = i;
  }
  std::size_t next = nearest;
  double gap = turn;
  for (std::size_t j = 0; j < n.prongs.size(); ++j) {
    if (j == nearest) continue;
    const double between = beyond ? ahead(n.prongs[nearest].angle, n.prongs[j].angle) : ahead(n.prongs[j].angle, n.prongs[nearest].angle);
    if (between >= gap) continue;
    gap = between;
    next = j;
  }
  const double k = std::pow(std::clamp(1 - glm::dot(from, axis) / n.height, 0.0, 1.0), 3);
  const double t = std::clamp(2 * away / gap, 0.0, 1.0), q = std::cos(t * std::numbers::pi / 2);
  const double length = n.prongs[nearest].length * (1 - t * t / 2) + n.prongs[next].length * t * t / 2;
  const double tau = std::min(0.95, n.sharpness * k * length);
  const double widened = flare_section(n.section, q, tau) * (1 + n.spread * k);
  return n.strength * falloff(kRatio * chain_ratio(n.nodes, p) / widened);
}

inline double value(const RoundCone& n, const Vec3& p) {
  return value(Chain{{{n.base, n.radius_base}, {n.tip, n.radius_tip}}, n.strength}, p);
}

inline double value(const Sphere& n, const Vec3& p) { return primitive(glm::length(p - n.center), n.radius, n.strength); }

inline double value(const Capsule& n, const Vec3& p) {
  return primitive(distance_to_segment(p, n.a, n.b), n.radius, n.strength);
}

inline double value(const Disc& n, const Vec3& p) {
  const Vec3 normal = glm::normalize(n.normal);
  const double h = glm::dot(p - n.center, normal);
  const double r = glm::length((p - n.center) - h * normal);
  return primitive(std::hypot(h, std::max(r - n.disc_radius, 0.0)), n.radius, n.strength);
}

inline double value(const Torus& n, const Vec3& p) {
  const Vec3 normal = glm::normalize(n.normal);
  const double h = glm::dot(p - n.center, normal);
  const double r = glm::length((p - n.center) - h * normal);
  return primitive(std::hypot(h, r - n.ring_radius), n.radius, n.strength);
}

inline double value(const RotatedBox& n, const Vec3& p) {
  const glm::dvec4 q = glm::normalize(n.rotation);  // w, x, y, z
  const double w = q[0];
  const Vec3 axis(-q[1], -q[2], -q[3]);             // the inverse turn
  const Vec3 v = p - n.center;
  const Vec3 local = v + 2.0 * glm::cross(axis, glm::cross(axis, v) + w * v);
  return primitive(glm::length(glm::max(glm::abs(local) - n.half_size, Vec3(0.0))), n.radius, n.strength);
}

inline double value(const HalfSpace& n, const Vec3& p) {
  return std::clamp(0.5 - glm::dot(p - n.point, glm::normalize(n.normal)) / (2 * n.width), 0.0, 1.0);
}

// ---- contact ---------------------------------------------------------------------------------------------------
inline double pushed(double f, double w, double a) {
  if (f >= 0.5) return 0.5 - f;
  if (f <= 0.5 - w) return 0;
  const double u = (0.5 - f) / w;
  return w * (u * (1 - u) * (1 - u) + a * u * u * (1 - u) * (1 - u));
}

inline double contact(std::vector<double> f, double w, double a) {
  std::sort(f.begin(), f.end(), std::greater<>());
  if (f.size() == 1) return f[0];
  if (f[1] >= 0.5) return f[0];
  return std::max(f[0] + pushed(f[1], w, a), f[1] + pushed(f[0], w, a));
}

// ---- operators and warps ---------------------------------------------------------------------------------------
class Evaluation {
 public:
  explicit Evaluation(const BlobTree& tree) : tree_(tree) {}
  double at(NodeId id, const Vec3& p) const {
    return std::visit([&](const auto& n) { return of(n, p); }, tree_.node(id));
  }

 private:
  template <class Primitive>
  double of(const Primitive& n, const Vec3& p) const { return value(n, p); }

  std::vector<double> all(const std::vector<NodeId>& children, const Vec3& p) const {
    std::vector<double> f;
    for (const NodeId child : children) f.push_back(at(child, p));
    return f;
  }

  double of(const Sum& n, const Vec3& p) const {
    double sum = 0;
    for (const double f : all(n.children, p)) sum += f;
    return sum;
  }
  double of(const Union& n, const Vec3& p) const {
    const auto f = all(n.children, p);
    return *std::max_element(f.begin(), f.end());
  }
  double of(const Intersection& n, const Vec3& p) const {
    const auto f = all(n.children, p);
    return *std::min_element(f.begin(), f.end());
  }
  double of(const Difference& n, const Vec3& p) const {
    auto f = all(n.children, p);
    for (std::size_t i = 1; i < f.size(); ++i) f[i] = 1.0 - f[i];
    return *std::min_element(f.begin(), f.end());
  }
  double of(const Ricci& n, const Vec3& p) const {
    double sum = 0;
    for (const double f : all(n.children, p)) sum += std::pow(std::max(f, 0.0), n.exponent);
    return std::pow(sum, 1 / n.exponent);
  }
  double of(const Contact& n, const Vec3& p) const { return contact(all(n.children, p), n.width, n.lip); }

  double of(const Fork& n, const Vec3& p) const {
    const double a = at(n.axis, p);
    std::vector<double> f;
    double weighted = 0, total = 0;
    bool any_positive = false;
    for (const Lateral& k : n.laterals) {
      f.push_back(at(k.child, p));
      const auto smooth = [](double t) {
        t = std::clamp(t, 0.0, 1.0);
        return t * t * (3 - 2 * t);
      };
      const double below = smooth(0.5 + glm::dot(p - k.point, glm::normalize(k.direction)) / (2 * k.softness));
      const double beyond = smooth((glm::length(p - k.point) - k.reach) / k.reach);
      weighted += std::max(f.back(), 0.0) * (1 - (1 - below) * (1 - beyond));
      total += std::max(f.back(), 0.0);
      any_positive = any_positive || f.back() > 0;
    }
    if (!any_positive) return a;
    const double c = contact(f, n.width, n.lip);
    const double l = total > 0 ? weighted / total : 0;
    return (1 - l) * (a + c) + l * (contact({std::max(a, 0.0), c}, n.width, n.lip) + std::min(a, 0.0));
  }

  double of(const ScaleField& n, const Vec3& p) const { return n.factor * at(n.child, p); }
  double of(const Transform& n, const Vec3& p) const {
    const Vec3 q(glm::inverse(n.matrix) * glm::dvec4(p, 1.0));
    return at(n.child, q);
  }

  double of(const Bend& n, const Vec3& p) const {
    if (n.angle == 0) return at(n.child, p);
    const Vec3 u = glm::normalize(n.to - n.from);
    // A negative angle bends as much the other way.
    Vec3 d = n.angle > 0 ? n.direction : -n.direction;
    d = glm::normalize(d - glm::dot(d, u) * u);
    const Vec3 side = glm::cross(u, d);
    const double theta = std::abs(n.angle), length = glm::length(n.to - n.from);
    const double rho = length / (2 * std::sin(theta / 2)), arc = rho * theta;
    const Vec3 centre = 0.5 * (n.from + n.to) - rho * std::cos(theta / 2) * d;
    const double x = glm::dot(p - centre, u), y = glm::dot(p - centre, d), z = glm::dot(p - centre, side);
    const double phi = std::atan2(x, y);
    if (std::abs(phi) <= theta / 2)
      return at(n.child, n.from + rho * (phi + theta / 2) * u + (std::hypot(x, y) - rho) * d + z * side);
    const double end = phi > 0 ? theta / 2 : -theta / 2;
    const Vec3 anchor = phi > 0 ? n.to : n.from;
    const Vec3 tangent = std::cos(end) * u - std::sin(end) * d, outward = std::sin(end) * u + std::cos(end) * d;
    return at(n.child, n.from + (phi > 0 ? arc : 0.0) * u + glm::dot(p - anchor, tangent) * u +
                           glm::dot(p - anchor, outward) * d + z * side);
  }

  double of(const Twist& n, const Vec3& p) const {
    const Vec3 axis = glm::normalize(n.axis);
    const double h = glm::dot(p - n.point, axis);
    const Vec3 v = (p - n.point) - h * axis;
    const double angle = -n.rate * h;  // W turns by +rate * height; this is its inverse
    return at(n.child, n.point + h * axis + std::cos(angle) * v + std::sin(angle) * glm::cross(axis, v));
  }

  double of(const Taper& n, const Vec3& p) const {
    const Vec3 axis = glm::normalize(n.axis);
    const double h = glm::dot(p - n.point, axis);
    const double t = std::clamp((h - n.from_height) / (n.to_height - n.from_height), 0.0, 1.0);
    const double scale = n.from_scale + t * (n.to_scale - n.from_scale);
    return at(n.child, n.point + h * axis + ((p - n.point) - h * axis) / scale);
  }

  const BlobTree& tree_;
};

inline double value(const BlobTree& tree, const Vec3& p) { return Evaluation(tree).at(tree.root(), p); }

}  // namespace cambium::reference
