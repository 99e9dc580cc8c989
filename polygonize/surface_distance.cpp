#include "polygonize/surface_distance.h"

#include <algorithm>
#include <cmath>

namespace cambium {
namespace {

constexpr double kRelative = 1e-3;    // of the distance: what is certainly precise enough
constexpr double kAbsolute = 1e-9;    // metres

double over(const Sample& s) { return s.value - kIso; }

}  // namespace

// A and b are on different sides, so a surface point lies between them whatever the field does there.
SurfaceDistance::Landing SurfaceDistance::between(const PrunedField& near, Vec3 a, Sample at_a, Vec3 b, Sample at_b,
                                                  double precision) {
  Landing best;
  double fa = over(at_a), fb = over(at_b);
  for (int round = 0; round < 80; ++round) {
    double t = fa / (fa - fb);
    if (round % 4 == 3 || !(t > 0 && t < 1)) t = 0.5;
    const Vec3 x = a + t * (b - a);
    const Sample s = sample(near, x);
    best = {x, s.gradient};
    const double f = over(s), slope = glm::length(s.gradient), width = glm::length(b - a);
    if (f == 0 || width < precision || std::abs(f) < 0.01 * precision * slope) break;
    if ((f >= 0) == (fa >= 0)) {
      a = x, fa = f;
      if (round % 2) fb *= 0.5;
    } else {
      b = x, fb = f;
      if (round % 2) fa *= 0.5;
    }
  }
  return best;
}

std::optional<SurfaceDistance::Landing> SurfaceDistance::land(const PrunedField& near, const Vec3& from, double longest_step,
                                                              double precision) {
  Vec3 x = from;
  Sample s = sample(near, x);
  for (int round = 0; round < 24; ++round) {
    const double f = over(s), slope = glm::length(s.gradient);
    if (f == 0) return Landing{x, s.gradient};
    if (!(slope > 0)) return std::nullopt;
    const double length = std::abs(f) / slope;
    const Vec3 down = -(f / (slope * slope)) * s.gradient;
    const double travelled = glm::length(x + down - from);
    if (length < std::max(precision, 0.03 * kRelative * travelled)) return Landing{x + down, s.gradient};
    double scale = std::min(1.0, longest_step / length);
    for (int tries = 0;; ++tries) {
      const Vec3 y = x + scale * down;
      const Sample t = sample(near, y);
      if ((over(t) >= 0) != (f >= 0)) {
        // Close to straight it is over in a step or two; where it is not, the bracket decides.
        if (std::abs(over(t)) < 0.2 * std::abs(f)) {
          const double rest = std::abs(over(t)) / std::max(glm::length(t.gradient), 1e-300);
          if (rest < std::max(precision, 0.03 * kRelative * glm::length(y - from))) {
            return Landing{y - over(t) / glm::dot(t.gradient, t.gradient) * t.gradient, t.gradient};
          }
        }
        return between(near, x, s, y, t, std::max(precision, 0.1 * kRelative * glm::length(y - from)));
      }
      if (std::abs(over(t)) < std::abs(f)) {
        x = y, s = t;
        break;
      }
      if (tries == 6) return std::nullopt;
      scale *= 0.5;
    }
  }
  return std::nullopt;
}

std::optional<SurfaceDistance::Foot> SurfaceDistance::nearest(const PrunedField& near, const Vec3& p) {
  const double reach = 0.5 * glm::length(near.box().size());
  const auto landing = land(near, p, reach, kAbsolute);
  if (!landing) return std::nullopt;
  return slide(near, p, *landing);
}

std::optional<SurfaceDistance::Foot> SurfaceDistance::around(const PrunedField& near, const Vec3& p, double reach) {
  constexpr int kHalvings = 9;   // of the reach, for the first look
  const Sample here = sample(near, p);
  for (int halvings = kHalvings; halvings >= 0; --halvings) {
    const double step = std::ldexp(reach, -halvings);
    for (int direction = 0; direction < 27; ++direction) {
      const Vec3 way(direction % 3 - 1, direction / 3 % 3 - 1, direction / 9 - 1);
      if (way == Vec3(0.0)) continue;
      const Vec3 q = p + step * glm::normalize(way);
      const Sample there = sample(near, q);
      if ((over(there) >= 0) != (over(here) >= 0)) return slide(near, p, between(near, p, here, q, there, kRelative * step));
    }
  }
  return std::nullopt;
}

SurfaceDistance::Foot SurfaceDistance::slide(const PrunedField& near, const Vec3& p, const Vec3& on_surface) {
  return slide(near, p, Landing{on_surface, sample(near, on_surface).gradient});
}

SurfaceDistance::Foot SurfaceDistance::slide(const PrunedField& near, const Vec3& p, Landing foot) {
  double distance = glm::length(p - foot.point);
  double share = 1;
  for (int round = 0; round < 20 && distance > kAbsolute; ++round) {
    const double slope = glm::length(foot.gradient);
    if (!(slope > 0)) break;
    const Vec3 n = foot.gradient / slope, away = p - foot.point;
    const Vec3 along = away - n * glm::dot(n, away);
    if (glm::length(along) < 0.04 * distance) break;   // to a thousandth of the distance, it is the foot
    const auto next = land(near, foot.point + share * along, distance, std::max(kAbsolute, 0.1 * kRelative * distance));
    const double nearer = next ? glm::length(p - next->point) : kInfinity;
    // On a crease a step across it gains little or nothing: shorter ones end at its nearest point.
    if (!(nearer < (1 - 0.1 * kRelative) * distance)) share *= 0.5;
    if (nearer < distance) foot = *next, distance = nearer;
    if (share < 0.01) break;
  }
  return {foot.point, distance};
}

}  // namespace cambium
