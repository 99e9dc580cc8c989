#include "polygonize/tube_rings.h"

#include <algorithm>
#include <cmath>
#include <numbers>

namespace cambium {
namespace {

// Of the tolerance: how far corners may stand out and sides lie in, and how far a wall may leave the axis and its radius.
constexpr double kRoundShare = 0.45, kWallShare = 0.45;
constexpr double kMostOfRadius = 0.12;   // that a wall may be off by, however large the tolerance
constexpr double kProfileShare = 0.3;    // of that: how straight the surface is where it is not looked at
constexpr int kMostCuts = 4;             // of a segment, for that
constexpr double kClearance = 0.1;       // in radii: of a ring's corners before the next ring's plane
constexpr double kNearNode = 0.4;        // in radii: an end that near to a node moves onto it

/// The angle by which a line along the surface turns at s: where the axis bends, and where the radius begins to grow otherwise.
double turn_of(const ChainPath& path, double s) {
  const std::size_t k = path.segment_at(s);
  if (k == 0 || s > path.node_at(k)) return 0;
  const auto flare = [&](std::size_t segment) {
    const auto nodes = path.nodes();
    return std::atan2(nodes[segment + 1].radius - nodes[segment].radius, path.node_at(segment + 1) - path.node_at(segment));
  };
  return std::acos(std::clamp(glm::dot(path.direction(k - 1), path.direction(k)), -1.0, 1.0)) + std::abs(flare(k) - flare(k - 1));
}

double distance_to_chord(const Vec3& p, const Vec3& a, const Vec3& b) {
  const Vec3 along = b - a;
  const double t = std::clamp(glm::dot(p - a, along) / glm::dot(along, along), 0.0, 1.0);
  return glm::distance(p, a + t * along);
}

class RingPlan {
 public:
  RingPlan(const ChainPath& path, const Stretch& stretch, const TubeRule& rule) : path_(path), rule_(rule) {
    list_places(stretch);
    follow_profile();
    for (const double s : places_) round_off_.push_back(path_.radius(s) * (1 - std::cos(turn_of(path_, s) / 2)));
  }

  std::vector<std::vector<TubeRing>> parts(const RunOptions& run) {
    std::vector<std::vector<TubeRing>> parts;
    std::size_t at = 0;
    while (at + 1 < places_.size() && !run.cancelled()) {
      std::vector<TubeRing> part{ring_at(places_[at])};
      while (const auto next = next_place(part.back(), at)) {
        if (run.cancelled()) return {};
        at = *next;
        part.push_back(ring_after(part.back(), places_[at]));
      }
      if (part.size() > 1) {
        parts.push_back(std::move(part));
      } else {
        ++at;
      }
    }
    return parts;
  }

 private:
  // The ends, the nodes between them, and what divides long segments into equal parts.
  void list_places(Stretch stretch) {
    std::size_t first = path_.segment_at(stretch.begin) + 1, last = path_.segment_at(stretch.end);   // nodes between
    const auto near = [&](std::size_t node, double s) { return std::abs(path_.node_at(node) - s) < kNearNode * path_.radius(s); };
    if (first <= last && near(first, stretch.begin)) stretch.begin = path_.node_at(first++);
    if (first <= last && near(last, stretch.end)) stretch.end = path_.node_at(last--);
    places_ = {stretch.begin};
    const auto reach = [&](double s) {
      const double from = places_.back();
      const double parts = std::ceil((s - from) / (kRingRadii * std::min(path_.radius(from), path_.radius(s))));
      for (double k = 1; k < parts; ++k) places_.push_back(from + (s - from) * k / parts);
      places_.push_back(s);
    };
    for (std::size_t node = first; node <= last && node < path_.segment_count(); ++node) {
      if (path_.node_at(node) > places_.back() && path_.node_at(node) < stretch.end) reach(path_.node_at(node));
    }
    if (stretch.end > places_.back()) reach(stretch.end);
  }

  double out_at(double s) const {
    const TubeRing ring = ring_at(s);
    return glm::distance(path_.surface(s, ring.side).position, ring.center);
  }
  double most_off(double radius) const { return std::min(kWallShare * rule_.tolerance, kMostOfRadius * radius); }

  // A cone touches the spheres at its ends beside their middles, the farther the more it flares: where the surface is not straight from
  // one place to the next there are more.
  void follow_profile() {
    std::vector<double> places{places_.front()};
    out_ = {out_at(places_.front())};
    const auto halve = [&](auto&& self, double s, int cuts) -> void {
      const double from = places.back(), middle = (from + s) / 2, out = out_at(s);
      const double off = std::abs(out_at(middle) - (out_.back() + out) / 2);
      if (cuts > 0 && off > kProfileShare * most_off(path_.radius(middle))) {
        self(self, middle, cuts - 1);
        self(self, s, cuts - 1);
        return;
      }
      places.push_back(s);
      out_.push_back(out);
    };
    for (std::size_t i = 1; i < places_.size(); ++i) halve(halve, places_[i], kMostCuts);
    places_ = std::move(places);
  }

  std::uint32_t sides_for(double radius) const {
    const double bow = std::min(2 * kRoundShare * rule_.tolerance / radius, 1.0);
    return static_cast<std::uint32_t>(std::ceil(std::max(rule_.min_sides, std::numbers::pi / std::acos(1 - bow))));
  }

  TubeRing ring_at(double s) const {
    TubeRing ring;
    ring.at = s;
    ring.center = path_.point(s);
    ring.along = path_.tangent(s);
    const Vec3 other = std::abs(ring.along.z) < 0.7 ? Vec3(0, 0, 1) : Vec3(1, 0, 0);
    ring.side = glm::normalize(glm::cross(ring.along, other));
    ring.sides = sides_for(path_.radius(ring.at));
    return ring;
  }

  // Turned no more than the chain turns.
  TubeRing ring_after(const TubeRing& before, double s) const {
    TubeRing ring;
    ring.at = s;
    ring.center = path_.point(s);
    ring.along = path_.tangent(s);
    ring.side = glm::normalize(before.side - glm::dot(before.side, ring.along) * ring.along);
    const std::uint32_t wanted = sides_for(path_.radius(s));
    const bool fewer = 5 * wanted < 4 * before.sides;   // a step is worth its longer triangles
    ring.sides = wanted > before.sides || fewer ? wanted : before.sides;
    return ring;
  }

  // The farthest place that a straight wall reaches.
  std::optional<std::size_t> next_place(const TubeRing& from, std::size_t at) const {
    std::optional<std::size_t> found;
    for (std::size_t next = at + 1; next < places_.size() && wall_fits(at, next); ++next) {
      if (clear_of_each_other(from, ring_after(from, places_[next]))) found = next;
    }
    return found;
  }

  bool wall_fits(std::size_t from, std::size_t to) const {
    const double s = places_[from], e = places_[to];
    const Vec3 a = path_.point(s), b = path_.point(e);
    const double thinnest = std::min(path_.radius(s), path_.radius(e));
    if (to > from + 1 && e - s > kRingRadii * thinnest) return false;
    const double most = most_off(thinnest);
    if (std::max(round_off_[from], round_off_[to]) > most) return false;
    for (std::size_t k = from + 1; k < to; ++k) {
      const double t = (places_[k] - s) / (e - s);
      const double off_axis = distance_to_chord(path_.point(places_[k]), a, b);
      const double off_wall = std::abs(out_[k] - (out_[from] + t * (out_[to] - out_[from])));
      if (off_axis + off_wall + round_off_[k] > most) return false;
    }
    return true;
  }

  bool clear_of_each_other(const TubeRing& a, const TubeRing& b) const {
    if (glm::dot(a.along, b.along) < 0.5) return false;
    const double clearance = kClearance * path_.radius(a.at);
    const auto ahead = [&](const TubeRing& ring, const TubeRing& plane) {   // least of its corners
      double least = kInfinity;
      for (std::uint32_t k = 0; k < ring.sides; ++k) {
        least = std::min(least, glm::dot(ring_corner(path_, ring, k).position - plane.center, plane.along));
      }
      return least;
    };
    const auto behind = [&](const TubeRing& ring, const TubeRing& plane) {
      TubeRing turned = plane;
      turned.along = -plane.along;
      return ahead(ring, turned);
    };
    return ahead(b, a) > clearance && behind(a, b) > clearance;
  }

  const ChainPath& path_;
  const TubeRule& rule_;
  std::vector<double> places_;      // metres along the chain
  std::vector<double> out_;         // by place: of the surface from the axis
  std::vector<double> round_off_;   // of the surface over walls that meet in an edge there
};

}  // namespace

ChainPath::SurfacePoint ring_corner(const ChainPath& path, const TubeRing& ring, std::uint32_t k) {
  const double angle = 2 * std::numbers::pi * k / ring.sides;
  const Vec3 direction = std::cos(angle) * ring.side + std::sin(angle) * glm::cross(ring.along, ring.side);
  ChainPath::SurfacePoint corner = path.surface(ring.at, direction);
  const double bow = path.radius(ring.at) * (1 - std::cos(std::numbers::pi / ring.sides));
  corner.position += 0.5 * bow * corner.normal;
  return corner;
}

std::vector<std::vector<TubeRing>> plan_rings(const ChainPath& path, const Stretch& stretch, const TubeRule& rule, const RunOptions& run) {
  if (stretch.empty()) return {};
  return RingPlan(path, stretch, rule).parts(run);
}

}  // namespace cambium
