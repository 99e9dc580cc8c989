#include "lsystem/generalized_cylinder.h"

#include <algorithm>
#include <cmath>
#include <numbers>

namespace cambium {
namespace {

constexpr double kMostTurn = 8 * std::numbers::pi / 180;
constexpr int kMostChords = 64;
constexpr double kSamePlace = 1e-9;  // of a chord's ends' distance, beside their coordinates

/// c[0] + c[1] t + c[2] t^2 + c[3] t^3, t from 0 to 1.
struct Cubic {
  Vec3 c[4];

  Vec3 at(double t) const { return ((c[3] * t + c[2]) * t + c[1]) * t + c[0]; }
  Vec3 tangent(double t) const { return (3 * t * c[3] + 2.0 * c[2]) * t + c[1]; }
};

Cubic hermite(const ControlPoint& from, const ControlPoint& to) {
  const Vec3 chord = to.position - from.position;
  const double length = glm::length(chord);
  const Vec3 out = length * from.tangent_out * from.heading, in = length * to.tangent_in * to.heading;
  return {{from.position, out, 3.0 * chord - 2.0 * out - in, out + in - 2.0 * chord}};
}

Cubic b_spline(const std::vector<ControlPoint>& before, const ControlPoint& last) {
  const Vec3 a = before[0].position, b = before[1].position, c = before[2].position, d = last.position;
  return {{(a + 4.0 * b + c) / 6.0, (c - a) / 2.0, (a - 2.0 * b + c) / 2.0, (d - a + 3.0 * (b - c)) / 6.0}};
}

/// 0 where one of the two has no direction.
double angle_between(const Vec3& a, const Vec3& b) { return std::atan2(glm::length(glm::cross(a, b)), glm::dot(a, b)); }

/// The most by which a chord turns from the one before it; beside a stretch's ends, where another chord will do the same,
/// from half way.
double most_turn(const Cubic& curve, int chords) {
  double most = 0;
  Vec3 before(0.0), last = curve.at(0);
  for (int i = 1; i <= chords; ++i) {
    const Vec3 next = curve.at(static_cast<double>(i) / chords);
    const Vec3 chord = next - last;
    most = std::max(most, i == 1 ? 2 * angle_between(curve.tangent(0), chord) : angle_between(before, chord));
    before = chord;
    last = next;
  }
  return std::max(most, 2 * angle_between(before, curve.tangent(1)));
}

AxisStretch sampled(const Cubic& curve, double from_radius, double to_radius) {
  if (glm::distance(curve.at(0), curve.at(1)) <= kSamePlace * (1.0 + glm::length(curve.at(0)))) return {};
  int chords = 1;
  while (chords < kMostChords && most_turn(curve, chords) > kMostTurn) chords *= 2;
  AxisStretch out;
  for (int i = 0; i <= chords; ++i) {
    const double t = static_cast<double>(i) / chords;
    out.push_back({curve.at(t), from_radius + t * (to_radius - from_radius)});
  }
  return out;
}

}  // namespace

AxisStretch GeneralizedCylinder::pass(const ControlPoint& point) {
  if (closed_ && first_.size() < reach()) first_.push_back(point);
  if (recent_.size() < reach()) {
    recent_.push_back(point);
    return {};
  }
  AxisStretch out;
  if (curve_ == Curve::kHermite) {
    out = sampled(hermite(recent_[0], point), recent_[0].radius, point.radius);
    if (!out.empty()) out.back().position = point.position;  // to the last bit: where branches go on from
  } else {
    out = sampled(b_spline(recent_, point), recent_[1].radius, recent_[2].radius);
  }
  std::rotate(recent_.begin(), recent_.begin() + 1, recent_.end());
  recent_.back() = point;
  return out;
}

std::vector<AxisStretch> GeneralizedCylinder::close() {
  std::vector<AxisStretch> out;
  for (const ControlPoint& point : std::vector<ControlPoint>(std::move(first_))) out.push_back(pass(point));
  first_.clear();
  return out;
}

}  // namespace cambium
