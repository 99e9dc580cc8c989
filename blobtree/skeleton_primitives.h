// Distance to each skeleton primitive, with its gradient (field.md section 3). Templated on the number type: double for points,
// float for batches, where positions are relative to the origin of the pruned box.
#pragma once

#include "blobtree/falloff.h"

#include <algorithm>
#include <cmath>
#include <variant>

namespace cambium {

template <class T>
using Vec = glm::vec<3, T>;

/// Distance and the unit vector in which it grows (zero on the skeleton).
template <class T>
struct Distance {
  T value;
  Vec<T> gradient;
};

template <class T>
inline Distance<T> distance_along(const Vec<T>& v) {
  const T d = std::sqrt(glm::dot(v, v));
  return {d, d > T(0) ? v / d : Vec<T>(T(0))};
}

template <class T>
struct PointSkeleton {
  Vec<T> center;
};
template <class T>
struct SegmentSkeleton {
  Vec<T> a, axis;  // unit axis
  T begin, end;    // the segment is a + s axis, s in [begin, end]
};
/// Solid cone: disc of `disc_radius` at base, apex at base + height * axis.
template <class T>
struct ConeSkeleton {
  Vec<T> base, axis;
  T height, disc_radius;
};
template <class T>
struct DiscSkeleton {
  Vec<T> center, normal;
  T disc_radius;
};
template <class T>
struct CircleSkeleton {
  Vec<T> center, normal;
  T ring_radius;
};
template <class T>
struct BoxSkeleton {
  Vec<T> center, half_size;
  glm::mat<3, 3, T> world_from_box;
};

template <class T>
inline Distance<T> distance(const PointSkeleton<T>& k, const Vec<T>& p) {
  return distance_along<T>(p - k.center);
}

template <class T>
inline Distance<T> distance(const SegmentSkeleton<T>& k, const Vec<T>& p) {
  const Vec<T> q = p - k.a;
  const T s = std::clamp(glm::dot(q, k.axis), k.begin, k.end);
  return distance_along<T>(q - s * k.axis);
}

/// Of a point at distance rho from an axis and height h along it; grad = (d/drho, d/dh) back in space.
template <class T>
inline Distance<T> from_profile(const Vec<T>& axis, const Vec<T>& radial, T rho, T e_rho, T e_h) {
  const T d = std::sqrt(e_rho * e_rho + e_h * e_h);
  if (d <= T(0)) return {T(0), Vec<T>(T(0))};
  const Vec<T> out = rho > T(0) ? radial / rho : Vec<T>(T(0));
  return {d, (e_rho * out + e_h * axis) / d};
}

template <class T>
inline Distance<T> distance(const ConeSkeleton<T>& k, const Vec<T>& p) {
  const Vec<T> q = p - k.base;
  const T h = glm::dot(q, k.axis);
  const Vec<T> radial = q - h * k.axis;
  const T rho = std::sqrt(glm::dot(radial, radial));
  if (h >= T(0) && rho * k.height + h * k.disc_radius <= k.disc_radius * k.height) return {T(0), Vec<T>(T(0))};
  if (h < T(0) && rho <= k.disc_radius) return {-h, -k.axis};
  const T dr = rho - k.disc_radius;
  const T t = std::clamp((h * k.height - dr * k.disc_radius) / (k.disc_radius * k.disc_radius + k.height * k.height), T(0), T(1));
  return from_profile<T>(k.axis, radial, rho, dr + t * k.disc_radius, h - t * k.height);
}

template <class T>
inline Distance<T> distance(const DiscSkeleton<T>& k, const Vec<T>& p) {
  const Vec<T> q = p - k.center;
  const T h = glm::dot(q, k.normal);
  const Vec<T> radial = q - h * k.normal;
  const T rho = std::sqrt(glm::dot(radial, radial));
  return from_profile<T>(k.normal, radial, rho, std::max(rho - k.disc_radius, T(0)), h);
}

template <class T>
inline Distance<T> distance(const CircleSkeleton<T>& k, const Vec<T>& p) {
  const Vec<T> q = p - k.center;
  const T h = glm::dot(q, k.normal);
  const Vec<T> radial = q - h * k.normal;
  const T rho = std::sqrt(glm::dot(radial, radial));
  return from_profile<T>(k.normal, radial, rho, rho - k.ring_radius, h);
}

template <class T>
inline Distance<T> distance(const BoxSkeleton<T>& k, const Vec<T>& p) {
  const Vec<T> local = (p - k.center) * k.world_from_box;  // v * M = transpose(M) v
  const Vec<T> e = local - glm::clamp(local, -k.half_size, k.half_size);
  const Distance<T> d = distance_along<T>(e);
  return {d.value, k.world_from_box * d.gradient};
}

/// One segment of a sphere-swept polyline: a + s axis with radius `radius + slope s`, s in [begin, end].
template <class T>
struct SweptSegment {
  Vec<T> a, axis;
  T begin, end, radius, slope;

  T radius_at(T s) const { return radius + slope * s; }
};

/// The parameter s* at which |q - s axis| / r(s) is smallest (field.md, `chain`). Denominator <= 0: the thicker end.
template <class T>
inline T closest_parameter(const SweptSegment<T>& k, const Vec<T>& q) {
  const T h = glm::dot(q, k.axis);
  const T denominator = k.radius + h * k.slope;
  const T thicker = k.slope > T(0) ? k.end : k.begin;
  const T s = (h * k.radius + glm::dot(q, q) * k.slope) / denominator;
  return denominator > T(0) ? std::clamp(s, k.begin, k.end) : thicker;
}

/// x = distance over local radius: 1 on the surface of the swept volume.
template <class T>
inline T swept_ratio(const SweptSegment<T>& k, const Vec<T>& p) {
  const Vec<T> q = p - k.a;
  const T s = closest_parameter(k, q);
  const Vec<T> v = q - s * k.axis;
  return std::sqrt(glm::dot(v, v)) / k.radius_at(s);
}

template <class T>
inline Distance<T> swept_ratio_gradient(const SweptSegment<T>& k, const Vec<T>& p) {
  const Vec<T> q = p - k.a;
  const T s = closest_parameter(k, q);
  const T r = k.radius_at(s);
  const Distance<T> d = distance_along<T>(q - s * k.axis);
  return {d.value / r, d.gradient / r};
}

/// Bounds of swept_ratio over a ball. The lower one solves min over s of (|q - s axis| - rho) / r(s) in closed form.
inline Interval swept_ratio_interval(const SweptSegment<double>& k, const Ball& ball) {
  const Vec3 q = ball.center - k.a;
  const double h = glm::dot(q, k.axis), rho = ball.radius;
  const double s = closest_parameter(k, q);
  const double at_center = glm::length(q - s * k.axis) / k.radius_at(s);
  const double hi = at_center + rho / k.radius_at(s);

  const double nearest = std::clamp(h, k.begin, k.end);
  const double r_max = std::max(k.radius_at(k.begin), k.radius_at(k.end));
  double lo = (glm::length(q - nearest * k.axis) - rho) / r_max;
  const double r_m = k.radius_at(h);
  const Vec3 across = q - h * k.axis;   // not |q|^2 - h^2, which cancels beside a long thin segment
  const double e2 = glm::dot(across, across);
  if (r_m > 0 && e2 > rho * rho) {
    const double a = r_m * r_m + e2 * k.slope * k.slope;
    const double x = (-rho * r_m + std::sqrt(rho * rho * r_m * r_m + a * (e2 - rho * rho))) / a;
    const double xk = x * k.slope;
    if (xk * xk < 1) {
      const double unclamped = h + xk * std::sqrt(e2 / (1 - xk * xk));
      const double best = std::clamp(unclamped, k.begin, k.end);
      lo = std::max(lo, best == unclamped ? x : (glm::length(q - best * k.axis) - rho) / k.radius_at(best));
    }
  }
  return {std::min(at_center, std::max(0.0, lo)), hi};
}

}  // namespace cambium
