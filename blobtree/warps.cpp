#include "blobtree/warps.h"

#include <algorithm>
#include <cmath>
#include <numbers>

namespace cambium {
namespace {

Vec3 any_normal(const Vec3& axis) {
  const Vec3 other = std::abs(axis.z) < 0.9 ? Vec3(0, 0, 1) : Vec3(1, 0, 0);
  return glm::normalize(glm::cross(axis, other));
}

Mat3 frame_around(const Vec3& axis) {
  const Vec3 e = any_normal(axis);
  return Mat3(axis, e, glm::cross(axis, e));
}

/// Tangent and radial direction of the arc at angle phi.
Vec3 tangent(const BendWarp& w, double phi) { return std::cos(phi) * w.u - std::sin(phi) * w.d; }
Vec3 radial(const BendWarp& w, double phi) { return std::sin(phi) * w.u + std::cos(phi) * w.d; }

struct Polar {
  double x, y, z, r, phi;
};
Polar polar(const BendWarp& w, const Vec3& p) {
  const Vec3 q = p - w.center;
  const double x = glm::dot(q, w.u), y = glm::dot(q, w.d);
  return {x, y, glm::dot(q, w.n), std::hypot(x, y), std::atan2(x, y)};
}

Vec3 cross_section(const Vec3& q, const Vec3& axis, double height) { return q - height * axis; }

Vec3 rotated(const Vec3& v, const Vec3& axis, double angle) {  // v orthogonal to axis
  return std::cos(angle) * v + std::sin(angle) * glm::cross(axis, v);
}

}  // namespace

Interval TaperWarp::scale_at(double height) const {
  if (height <= from_height) return {from_scale, 0};
  if (height >= to_height) return {to_scale, 0};
  const double slope = (to_scale - from_scale) / (to_height - from_height);
  return {from_scale + slope * (height - from_height), slope};
}

RigidWarp rigid_warp(const Transform& transform) {
  const Mat3 linear(transform.matrix);
  const double scale = std::cbrt(glm::determinant(linear));
  return {Vec3(transform.matrix[3]), linear / scale, scale};
}

Warp bend_warp(const Bend& bend) {
  const double length = glm::length(bend.to - bend.from);
  // Without so small a bend, points move by less than rounding moves them in an arc of so large a radius.
  if (std::abs(bend.angle) < 3e-8) return RigidWarp{};
  BendWarp w;
  w.a = bend.from;
  w.b = bend.to;
  w.u = (bend.to - bend.from) / length;
  const Vec3 across = bend.direction - glm::dot(bend.direction, w.u) * w.u;
  if (!(glm::length(across) > 1e-9 * glm::length(bend.direction)))
    throw InvalidNode("direction", "a bend along its own axis", "a direction that is not parallel to from-to");
  w.d = glm::normalize(across) * (bend.angle < 0 ? -1.0 : 1.0);
  w.n = glm::cross(w.u, w.d);
  w.angle = std::abs(bend.angle);
  w.rho = length / (2 * std::sin(w.angle / 2));
  w.arc = w.rho * w.angle;
  w.center = 0.5 * (w.a + w.b) - w.rho * std::cos(w.angle / 2) * w.d;
  return w;
}

TwistWarp twist_warp(const Twist& twist) { return {twist.point, glm::normalize(twist.axis), twist.rate}; }

TaperWarp taper_warp(const Taper& t) {
  return {t.point, glm::normalize(t.axis), t.from_height, t.from_scale, t.to_height, t.to_scale};
}

// ---- W^-1 ---------------------------------------------------------------------------------------------------------

static Vec3 unwarp_one(const RigidWarp& w, const Vec3& p) { return ((p - w.origin) * w.axes) / w.scale; }

static Vec3 unwarp_one(const BendWarp& w, const Vec3& p) {
  const Polar q = polar(w, p);
  const double half = w.angle / 2;
  double s, y;
  if (std::abs(q.phi) <= half) {
    s = w.rho * (q.phi + half);
    y = q.r - w.rho;
  } else {
    const double end = q.phi > 0 ? half : -half;
    const Vec3 from_end = p - (q.phi > 0 ? w.b : w.a);
    s = (q.phi > 0 ? w.arc : 0.0) + glm::dot(from_end, tangent(w, end));
    y = glm::dot(from_end, radial(w, end));
  }
  return w.a + s * w.u + y * w.d + q.z * w.n;
}

static Vec3 unwarp_one(const TwistWarp& w, const Vec3& p) {
  const Vec3 q = p - w.point;
  const double h = glm::dot(q, w.axis);
  return w.point + h * w.axis + rotated(cross_section(q, w.axis, h), w.axis, -w.rate * h);
}

static Vec3 unwarp_one(const TaperWarp& w, const Vec3& p) {
  const Vec3 q = p - w.point;
  const double h = glm::dot(q, w.axis);
  return w.point + h * w.axis + cross_section(q, w.axis, h) / w.scale_at(h).lo;
}

Vec3 unwarp(const Warp& warp, const Vec3& p) {
  return std::visit([&](const auto& w) { return unwarp_one(w, p); }, warp);
}

// ---- gradients ----------------------------------------------------------------------------------------------------

static Vec3 pull_back_one(const RigidWarp& w, const Vec3&, const Vec3& g) { return (w.axes * g) / w.scale; }

/// What a bend is at a point: it turns the child's axes to these, and is so much longer along the first of them.
struct LocalBend {
  Vec3 tangent, radial;
  double stretch;   // of W^-1
};
static LocalBend local_bend(const BendWarp& w, const Vec3& p) {
  const Polar q = polar(w, p);
  const double half = w.angle / 2, phi = std::clamp(q.phi, -half, half);
  return {tangent(w, phi), radial(w, phi), std::abs(q.phi) <= half && q.r > 0 ? w.rho / q.r : 1.0};
}

static Vec3 pull_back_one(const BendWarp& w, const Vec3& p, const Vec3& g) {
  const LocalBend at = local_bend(w, p);
  return glm::dot(g, w.u) * at.stretch * at.tangent + glm::dot(g, w.d) * at.radial + glm::dot(g, w.n) * w.n;
}

static Vec3 pull_back_one(const TwistWarp& w, const Vec3& p, const Vec3& g) {
  const Vec3 q = p - w.point;
  const double h = glm::dot(q, w.axis);
  const Vec3 child = rotated(cross_section(q, w.axis, h), w.axis, -w.rate * h);
  const double g_axis = glm::dot(g, w.axis);
  const double shear = -w.rate * glm::dot(g, glm::cross(w.axis, child));
  return rotated(g - g_axis * w.axis, w.axis, w.rate * h) + (g_axis + shear) * w.axis;
}

static Vec3 pull_back_one(const TaperWarp& w, const Vec3& p, const Vec3& g) {
  const Vec3 q = p - w.point;
  const double h = glm::dot(q, w.axis);
  const auto [scale, slope] = w.scale_at(h);
  const double g_axis = glm::dot(g, w.axis);
  const double shear = -glm::dot(g, cross_section(q, w.axis, h)) * slope / (scale * scale);
  return (g - g_axis * w.axis) / scale + (g_axis + shear) * w.axis;
}

Vec3 pull_back(const Warp& warp, const Vec3& p, const Vec3& g) {
  return std::visit([&](const auto& w) { return pull_back_one(w, p, g); }, warp);
}

Vec3 push_forward(const BendWarp& w, const Vec3& p, const Vec3& v) {
  const LocalBend at = local_bend(w, p);
  return glm::dot(v, at.tangent) * at.stretch * w.u + glm::dot(v, at.radial) * w.d + glm::dot(v, w.n) * w.n;
}

// The axes turn with phi, which is clamped, so by no more than the ball is wide from the arc's centre; and the stretch changes: outside of
// the arc it is 1.
double turn_in(const BendWarp& w, const Ball& ball, const Vec3& v) {
  const Polar q = polar(w, ball.center);
  const LocalBend at = local_bend(w, ball.center);
  if (!(q.r > ball.radius)) return kInfinity;
  const double half = w.angle / 2, widest = std::asin(ball.radius / q.r), from_end = std::abs(q.phi) - half;
  if (from_end > widest) return 0;
  Interval stretch{w.rho / (q.r + ball.radius), w.rho / (q.r - ball.radius)};
  if (from_end >= -widest) stretch = {std::min(stretch.lo, 1.0), std::max(stretch.hi, 1.0)};
  const double along = glm::dot(v, at.tangent), across = glm::dot(v, at.radial);
  const double change = std::max(stretch.hi - at.stretch, at.stretch - stretch.lo);
  const double turned = 2 * std::sin(0.5 * widest) * std::hypot(along, across) * std::max(1.0, stretch.hi);
  return (turned + change * std::abs(along)) * (1 + 1e-9);
}

// ---- balls --------------------------------------------------------------------------------------------------------

/// {stretch, certain}
struct Stretch {
  double factor;
  bool certain;
};

static Stretch stretch_of(const RigidWarp& w, const Ball&) { return {1 / w.scale, true}; }

static Stretch stretch_of(const BendWarp& w, const Ball& ball) {
  const Polar q = polar(w, ball.center);
  // Opposite the arc the two rigid continuations meet: W^-1 jumps there.
  const double to_cut = q.y < 0 ? std::abs(q.x) : q.r;
  if (to_cut <= ball.radius) return {1, false};
  const double nearest = q.r - ball.radius;
  if (nearest > 0.25 * w.rho) return {std::max(1.0, w.rho / nearest), true};
  // Around the arc's centre a path may be pushed out to w.inner, at most pi/2 longer; inside that the child is 0.
  if (q.r < w.inner) return {1, false};
  double factor = 0.5 * std::numbers::pi * w.rho / w.inner;
  if (nearest > 0) factor = std::min(factor, w.rho / nearest);
  return {std::max(1.0, factor), nearest >= w.inner};
}

static Stretch stretch_of(const TwistWarp& w, const Ball& ball) {
  const Vec3 q = ball.center - w.point;
  const double reach = glm::length(cross_section(q, w.axis, glm::dot(q, w.axis))) + ball.radius;
  const double k = std::abs(w.rate) * reach;
  return {0.5 * (k + std::sqrt(k * k + 4)), true};
}

static Stretch stretch_of(const TaperWarp& w, const Ball& ball) {
  const Vec3 q = ball.center - w.point;
  const double h = glm::dot(q, w.axis);
  const double reach = glm::length(cross_section(q, w.axis, h)) + ball.radius;
  const double smallest = std::min(w.scale_at(h - ball.radius).lo, w.scale_at(h + ball.radius).lo);
  const double slope = std::abs(w.to_scale - w.from_scale) / (w.to_height - w.from_height);
  const bool tapers = h + ball.radius > w.from_height && h - ball.radius < w.to_height;
  return {std::max(1.0, 1 / smallest) + (tapers ? reach * slope / (smallest * smallest) : 0.0), true};
}

UnwarpedBall unwarp(const Warp& warp, const Ball& ball) {
  const Stretch s = std::visit([&](const auto& w) { return stretch_of(w, ball); }, warp);
  return {{unwarp(warp, ball.center), ball.radius * s.factor * (1 + 1e-12)}, s.certain};
}

bool misses_child(const Warp& warp, const Ball& ball) {
  const auto* const bend = std::get_if<BendWarp>(&warp);
  if (!bend) return false;
  const Vec3 q = ball.center - bend->center;
  return std::hypot(glm::dot(q, bend->u), glm::dot(q, bend->d)) + ball.radius < bend->inner * (1 - 1e-9);
}

// ---- boxes --------------------------------------------------------------------------------------------------------

static WarpFrame frame_of(const RigidWarp&) { return {Vec3(0.0), Mat3(1.0)}; }
static WarpFrame frame_of(const BendWarp& w) { return {w.a, Mat3(w.u, w.d, w.n)}; }
static WarpFrame frame_of(const TwistWarp& w) { return {w.point, frame_around(w.axis)}; }
static WarpFrame frame_of(const TaperWarp& w) { return {w.point, frame_around(w.axis)}; }

WarpFrame warp_frame(const Warp& warp) {
  return std::visit([](const auto& w) { return frame_of(w); }, warp);
}

/// Box around anchor + axes * (anything within the extents).
static Box box_of(const Vec3& anchor, const Mat3& axes, const Extents& e) {
  Box box{anchor, anchor};
  for (int i = 0; i < 3; ++i)
    for (int k = 0; k < 3; ++k) {
      if (axes[i][k] == 0) continue;  // also keeps infinity * 0 out
      const double a = axes[i][k] * e[i].lo, b = axes[i][k] * e[i].hi;
      box.lo[k] += std::min(a, b);
      box.hi[k] += std::max(a, b);
    }
  return box;
}

static Box warped(const RigidWarp& w, const Extents& e) { return box_of(w.origin, w.axes * w.scale, e); }

static Box warped(const BendWarp& w, const Extents& e) {
  Box box;
  const double half = w.angle / 2;
  const Interval s = e[0], y = e[1], z = e[2];
  if (s.lo < 0)
    box.extend(box_of(w.a, Mat3(tangent(w, -half), radial(w, -half), w.n), {Interval{s.lo, std::min(s.hi, 0.0)}, y, z}));
  if (s.hi > w.arc)
    box.extend(box_of(w.b, Mat3(tangent(w, half), radial(w, half), w.n),
                      {Interval{std::max(s.lo - w.arc, 0.0), s.hi - w.arc}, y, z}));
  const double phi_lo = std::clamp(s.lo / w.rho - half, -half, half), phi_hi = std::clamp(s.hi / w.rho - half, -half, half);
  if (s.hi < 0 || s.lo > w.arc) return box;
  Box arc;
  for (int k = 0; k < 3; ++k) {
    const double along_u = w.u[k], along_d = w.d[k];
    const double reach = std::hypot(along_u, along_d), peak = std::atan2(along_u, along_d);
    double lo = kInfinity, hi = -kInfinity;
    const auto offer = [&](double phi) {
      const double c = reach * std::cos(phi - peak);
      for (const double r : {w.rho + y.lo, w.rho + y.hi}) {
        lo = std::min(lo, r * c);
        hi = std::max(hi, r * c);
      }
    };
    offer(phi_lo);
    offer(phi_hi);
    for (int turn = -2; turn <= 2; ++turn) {
      const double phi = peak + turn * std::numbers::pi;
      if (phi_lo < phi && phi < phi_hi) offer(phi);
    }
    const double a = z.lo * w.n[k], b = z.hi * w.n[k];
    arc.lo[k] = w.center[k] + lo + std::min(a, b);
    arc.hi[k] = w.center[k] + hi + std::max(a, b);
  }
  box.extend(arc);
  return box;
}

static Box warped(const TwistWarp& w, const Extents& e) {
  const auto largest = [](const Interval& i) { return std::max(std::abs(i.lo), std::abs(i.hi)); };
  const double reach = std::hypot(largest(e[1]), largest(e[2]));
  Box box;
  for (int k = 0; k < 3; ++k) {
    const double a = w.axis[k] * e[0].lo, b = w.axis[k] * e[0].hi;
    const double across = reach * std::sqrt(std::max(0.0, 1 - w.axis[k] * w.axis[k]));
    box.lo[k] = w.point[k] + std::min(a, b) - across;
    box.hi[k] = w.point[k] + std::max(a, b) + across;
  }
  return box;
}

static Box warped(const TaperWarp& w, const Extents& e) {
  const double s0 = w.scale_at(e[0].lo).lo, s1 = w.scale_at(e[0].hi).lo;
  const double small = std::min(s0, s1), large = std::max(s0, s1);
  const auto spread = [&](const Interval& i) {
    return Interval{std::min(i.lo * small, i.lo * large), std::max(i.hi * small, i.hi * large)};
  };
  return box_of(w.point, frame_around(w.axis), {e[0], spread(e[1]), spread(e[2])});
}

Box warped_box(const Warp& warp, const Extents& extents) {
  return std::visit([&](const auto& w) { return warped(w, extents); }, warp);
}

}  // namespace cambium
