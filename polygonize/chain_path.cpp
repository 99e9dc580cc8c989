#include "polygonize/chain_path.h"

#include "blobtree/skeleton_primitives.h"

#include <algorithm>
#include <cmath>

namespace cambium {
namespace {

constexpr double kNearRadii = 3;   // parts of a chain farther along it than this are not its surface here, unless it bends sharply

}  // namespace

ChainPath::ChainPath(std::span<const ChainNode> nodes) : nodes_(nodes), at_(nodes.size(), 0), directions_(nodes.size() - 1, Vec3(0.0)) {
  const Vec3* known = nullptr;
  for (std::size_t k = 0; k + 1 < nodes.size(); ++k) {
    const Vec3 along = nodes[k + 1].position - nodes[k].position;
    const double length = glm::length(along);
    at_[k + 1] = at_[k] + length;
    if (length > 0) {
      directions_[k] = along / length;
      if (!known) std::fill_n(directions_.begin(), k, directions_[k]);
      known = &directions_[k];
    } else if (known) {
      directions_[k] = *known;
    }
  }
}

std::size_t ChainPath::segment_at(double s) const {
  const auto after = std::upper_bound(at_.begin(), at_.end(), s);
  return std::min(static_cast<std::size_t>(std::max<std::ptrdiff_t>(after - at_.begin() - 1, 0)), segment_count() - 1);
}

Vec3 ChainPath::point(double s) const {
  const std::size_t k = segment_at(s);
  return nodes_[k].position + (s - at_[k]) * directions_[k];
}

double ChainPath::radius(double s) const {
  const std::size_t k = segment_at(s);
  const double length = at_[k + 1] - at_[k];
  const double t = length > 0 ? std::clamp((s - at_[k]) / length, 0.0, 1.0) : 0.0;
  return nodes_[k].radius + t * (nodes_[k + 1].radius - nodes_[k].radius);
}

Vec3 ChainPath::tangent(double s) const {
  const std::size_t k = segment_at(s);
  if (k == 0 || s > at_[k]) return directions_[k];
  const Vec3 sum = directions_[k] + directions_[k - 1];
  const double length = glm::length(sum);
  return length > 0 ? sum / length : directions_[k];
}

double ChainPath::nearest(const Vec3& p, std::size_t first, std::size_t last) const {
  double best = kInfinity, at = at_[first];
  for (std::size_t k = first; k <= last; ++k) {
    const double length = at_[k + 1] - at_[k];
    const Vec3 q = p - nodes_[k].position;
    const double t = std::clamp(glm::dot(q, directions_[k]), 0.0, length);
    const Vec3 off = q - t * directions_[k];
    const double squared = glm::dot(off, off);
    if (squared < best) best = squared, at = at_[k] + t;
  }
  return at;
}

// The discs across it that may meet the box: those whose own boxes do. The round ends belong to the nodes.
std::optional<Stretch> reaching(const ChainNode& from, const ChainNode& to, const Box& box) {
  constexpr double kMore = 1.02;   // for the slant of a surface that tapers
  const double radius = kMore * std::max(from.radius, to.radius), length = glm::distance(from.position, to.position);
  const Vec3 direction = length > 0 ? (to.position - from.position) / length : Vec3(0, 0, 1);
  double begin = -radius, end = length + radius;
  for (int a = 0; a < 3; ++a) {
    const double d = direction[a], reach = radius * std::sqrt(std::max(0.0, 1 - d * d));
    const double low = box.lo[a] - reach - from.position[a], high = box.hi[a] + reach - from.position[a];
    if (std::abs(d) < 1e-9) {
      if (low > 0 || high < 0) return std::nullopt;
      continue;
    }
    begin = std::max(begin, std::min(low / d, high / d));
    end = std::min(end, std::max(low / d, high / d));
  }
  if (begin > end) return std::nullopt;
  return Stretch{std::clamp(begin, 0.0, length), std::clamp(end, 0.0, length)};
}

std::optional<Stretch> ChainPath::reaching(const Box& box, std::size_t first, std::size_t last) const {
  std::optional<Stretch> found;
  for (std::size_t k = first; k <= last; ++k) {
    const auto part = cambium::reaching(nodes_[k], nodes_[k + 1], box);
    if (!part) continue;
    if (!found) found = Stretch{kInfinity, -kInfinity};
    found->begin = std::min(found->begin, at_[k] + part->begin);
    found->end = std::max(found->end, at_[k] + part->end);
  }
  return found;
}

ChainPath::Segments ChainPath::near(double s) const {
  const double reach = kNearRadii * radius(s);
  return {segment_at(s - reach), segment_at(s + reach)};
}

ChainPath::Ratio ChainPath::swept_ratio(const Segments& segments, const Vec3& p) const {
  Ratio best{kInfinity, 0, Vec3(0.0)};
  for (std::size_t k = segments.first; k <= segments.last; ++k) {
    const double length = at_[k + 1] - at_[k];
    const double slope = length > 0 ? (nodes_[k + 1].radius - nodes_[k].radius) / length : 0;
    const SweptSegment<double> swept{nodes_[k].position, directions_[k], 0, length, nodes_[k].radius, slope};
    const Vec3 q = p - swept.a;
    const double t = closest_parameter(swept, q), radius = swept.radius_at(t);
    const Vec3 away = q - t * swept.axis;
    const double value = glm::length(away) / radius;
    if (value < best.value) best = {value, radius, away};
  }
  return best;
}

ChainPath::SurfacePoint ChainPath::surface(double s, const Vec3& direction) const {
  constexpr int kMostSteps = 20;
  constexpr double kExact = 1e-9;
  const Segments segments = near(s);
  const Vec3 center = point(s);
  double out = radius(s);
  for (int step = 0; step < kMostSteps; ++step) {   // the ratio grows almost as the distance from the axis
    const double ratio = swept_ratio(segments, center + out * direction).value;
    out /= ratio;
    if (std::abs(ratio - 1) < kExact) break;
  }
  const Vec3 position = center + out * direction;
  return {position, glm::normalize(swept_ratio(segments, position).away)};
}

double ChainPath::distance(double s, const Vec3& p) const {
  const Ratio ratio = swept_ratio(near(s), p);
  return (ratio.value - 1) * ratio.radius;
}

double ChainPath::distance_of(const Vec3& a, const Vec3& b, const Vec3& c, double s) const {
  const double size = std::max({glm::distance(a, b), glm::distance(b, c), glm::distance(c, a)}), reach = size + kNearRadii * radius(s);
  const std::size_t first = segment_at(s - reach), last = segment_at(s + reach);
  double farthest = 0;
  for (const Vec3& p : {(a + b + c) / 3.0, (a + b) / 2.0, (b + c) / 2.0, (c + a) / 2.0}) {
    farthest = std::max(farthest, std::abs(distance(nearest(p, first, last), p)));
  }
  return farthest;
}

}  // namespace cambium
