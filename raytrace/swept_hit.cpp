#include "raytrace/swept_hit.h"

#include <algorithm>
#include <cmath>

namespace cambium {
namespace {

constexpr double kHardly = 1e-9;

/// Where a ray through q enters a ball; NaN if it passes it.
double enter_ball(const Vec3& q, const Vec3& direction, const Vec3& center, double radius) {
  const Vec3 v = q - center;
  const double along = glm::dot(v, direction);
  const Vec3 across = v - along * direction;
  return -along - std::sqrt(radius * radius - glm::dot(across, across));
}

enum class Flank { kHit, kMissed, kBeforeIt, kBeyondIt, kUnknown };
struct FlankHit {
  Flank how = Flank::kUnknown;
  double t = 0;
};

/// Where the ray enters the cone that touches both balls: points whose distance e from the axis at height h has
/// e^2 (1 - slope^2) = (radius + slope h)^2. The ball that touches there is at s = (h + slope radius) / (1 - slope^2).
FlankHit enter_flank(const SweptSegment<double>& k, const AxisView& view) {
  const double cosine2 = 1 - k.slope * k.slope;
  if (!(cosine2 > 0)) return {};   // one ball holds the other
  const double r = k.radius_at(view.h), dr = k.slope * view.dh;
  const double a = cosine2 * view.d_square - dr * dr, b = cosine2 * view.mixed - r * dr, c = cosine2 * view.square - r * r;
  const double discriminant = b * b - a * c;
  if (!(discriminant >= 0)) return {a > 0 ? Flank::kMissed : Flank::kUnknown, 0};   // the balls are in the cone
  const double root = std::sqrt(discriminant);
  const double t = b > 0 ? (-b - root) / a : c / (root - b);
  const double s = (view.h + t * view.dh + k.slope * k.radius) / cosine2;
  if (s >= k.begin && s <= k.end) return {Flank::kHit, t};
  if (!(a > 0)) return {};
  return {s < k.begin ? Flank::kBeforeIt : Flank::kBeyondIt, t};
}

}  // namespace

SweptSegment<double> swept_segment(const Vec3& from, double radius_from, const Vec3& to, double radius_to) {
  const Vec3 d = to - from;
  const double length = glm::length(d);
  if (!(length > 0)) return {from, {0, 0, 1}, 0, 0, std::max(radius_from, radius_to), 0};
  return {from, d / length, 0, length, radius_from, (radius_to - radius_from) / length};
}

std::optional<double> first_inside(const SweptSegment<double>& k, const Ray& ray, const RaySegment& part) {
  return first_inside(k, ray, part, AxisView(k, ray, 0.5 * (part.begin + part.end)));
}

std::optional<double> first_inside(const SweptSegment<double>& k, const Ray& ray, const RaySegment& part, const AxisView& view) {
  const FlankHit flank = enter_flank(k, view);
  if (flank.how == Flank::kMissed) return std::nullopt;
  // Who enters the cone beside the flank comes into the hull through the ball on that side. A ball that is passed is NaN.
  const auto into_begin = [&] { return enter_ball(view.q, ray.direction, k.begin * k.axis, k.radius_at(k.begin)); };
  const auto into_end = [&] { return enter_ball(view.q, ray.direction, k.end * k.axis, k.radius_at(k.end)); };
  double t = flank.t;
  if (flank.how == Flank::kBeforeIt) t = into_begin();
  if (flank.how == Flank::kBeyondIt) t = into_end();
  if (flank.how == Flank::kUnknown) t = std::fmin(into_begin(), into_end());   // of both what is entered first is the hull's
  t += 0.5 * (part.begin + part.end);
  if (t >= part.begin && t <= part.end) return t;
  // Who starts on the surface and goes in has entered it hardly before; a chord of 1e-9 radii is nowhere deep enough to matter.
  if (t < part.begin && (part.begin - t <= kHardly * thickest(k) || swept_ratio(k, ray.at(part.begin)) <= 1)) return part.begin;
  return std::nullopt;
}

SweptSegment<double> widened(const SweptSegment<double>& k, double factor) {
  return {k.a, k.axis, k.begin, k.end, factor * k.radius, factor * k.slope};
}

std::optional<RaySegment> part_within(const SweptSegment<double>& k, double reach, const RaySegment& part, const AxisView& view) {
  const double middle = 0.5 * (part.begin + part.end), outside = view.square - reach * reach;
  double begin = part.begin - middle, end = part.end - middle;
  const double rises = std::abs(view.dh) * end;
  if (view.h + rises < k.begin - reach || view.h - rises > k.end + reach) return std::nullopt;   // beyond the flat ends
  if (view.d_square > 1e-12) {
    const double discriminant = view.mixed * view.mixed - view.d_square * outside;
    if (!(discriminant >= 0)) return std::nullopt;
    const double root = std::sqrt(discriminant), per = 1 / view.d_square;
    begin = std::max(begin, (-view.mixed - root) * per);
    end = std::min(end, (-view.mixed + root) * per);
  } else if (outside > 0 && std::sqrt(view.square) > reach + 1e-6 * (end - begin)) {   // along the axis
    return std::nullopt;
  }
  if (view.dh != 0) {
    const double per = 1 / view.dh, low = (k.begin - reach - view.h) * per, high = (k.end + reach - view.h) * per;
    begin = std::max(begin, std::min(low, high));
    end = std::min(end, std::max(low, high));
  }
  if (!(begin <= end)) return std::nullopt;
  return RaySegment{begin + middle, end + middle};
}

Vec3 swept_normal(const SweptSegment<double>& k, const Vec3& p) {
  const Vec3 q = p - k.a;
  return distance_along<double>(q - closest_parameter(k, q) * k.axis).gradient;
}

Box solid_bounds(const SweptSegment<double>& k, const Box& within) {
  // Balls that reach the box have their centres in it when it is padded by the thickest radius.
  const auto centers = clip({k.a, k.axis}, within.padded(thickest(k) * (1 + 1e-9)), {k.begin, k.end});
  Box box;
  if (!centers) return box;
  for (const double s : {centers->begin, centers->end}) {
    const Vec3 center = k.a + s * k.axis;
    const double reach = k.radius_at(s) * (1 + 1e-9);
    box.extend(Box{center - reach, center + reach});
  }
  box = Box::intersection(box, within);
  return box.empty() ? Box{} : box;
}

}  // namespace cambium
