#include "blobtree/flare.h"

#include "blobtree/dual.h"
#include "blobtree/interval_arithmetic.h"

#include <algorithm>
#include <cmath>
#include <numbers>

namespace cambium {
namespace {

constexpr double kPi = std::numbers::pi;

double smaller(double a, double b) { return std::min(a, b); }
double or_zero(bool c, double a) { return c ? a : 0.0; }
#define CAMBIUM_RULE inline
#include "blobtree/flare_sections-inl.h"
#undef CAMBIUM_RULE

using Radius = SectionRadius<double>;

/// A section at one q, for any tau; its slope by q beyond the limit of the envelope is that at the limit.
class SectionAt {
 public:
  SectionAt() = default;
  SectionAt(FlareSection section, double q) : section_(section), q_(q) {
    if (section != FlareSection::kEnvelope) return;
    q_ = std::min(q, kLargestProngCosine);
    const double v = std::cbrt((1 - q_) / (1 + q_));
    widest_ = (1 - v) / (1 + v);   // tanh(atanh(q)/3)
  }
  Radius radius(double tau) const {
    switch (section_) {
      case FlareSection::kEnvelope: return envelope_section(q_, 1 - q_, widest_, tau);
      case FlareSection::kQuadrifolium: return quadrifolium_section(q_, tau);
      case FlareSection::kCircle: return circle_section(q_, tau);
    }
    return {};
  }

 private:
  FlareSection section_ = FlareSection::kEnvelope;
  double q_ = 0, widest_ = 0;
};

bool is_beyond_limit(const CompiledFlare& flare, double q) {
  return flare.section == FlareSection::kEnvelope && q > kLargestProngCosine;
}

Vec3 reference_direction(const Vec3& axis) {
  for (const Vec3& to : {Vec3(1, 0, 0), Vec3(0, 1, 0)}) {
    const Vec3 across = to - glm::dot(to, axis) * axis;
    if (glm::length(across) > 1e-6) return glm::normalize(across);
  }
  return {0, 0, 1};   // no axis is parallel to both
}

/// Where a point is between the valley and the prong that are nearest to it around the axis: q and the prong's length there, and how both
/// change by the angle.
struct Around {
  double q = 0, q_by_angle = 0, length = 1, length_by_angle = 0;
};

/// t from the prong (0) to the valley (1). side: 1 beyond the prong, -1 before it.
Around around_at(const FlareGap& gap, double t, double side) {
  const double near = side > 0 ? gap.length : gap.next_length, far = side > 0 ? gap.next_length : gap.length;
  const double t_by_angle = side * 2 / gap.width, half_turn = 0.5 * kPi * t;
  return {std::cos(half_turn), -0.5 * kPi * std::sin(half_turn) * t_by_angle, near + (far - near) * (0.5 * t * t),
          (far - near) * t * t_by_angle};
}

Around around_at(const CompiledFlare& flare, double azimuth) {
  const double angle = wrapped_angle(azimuth - flare.gaps.front().begin);
  const FlareGap* gap = flare.gaps.data();
  for (const FlareGap& next : flare.gaps)
    if (next.begin - flare.gaps.front().begin <= angle) gap = &next;
  const double s = std::clamp((angle - (gap->begin - flare.gaps.front().begin)) / gap->width, 0.0, 1.0);
  return s <= 0.5 ? around_at(*gap, 2 * s, 1) : around_at(*gap, 2 * (1 - s), -1);
}

/// 1 - z/h in [0, 1]: k is its cube.
double remaining(const CompiledFlare& flare, double z) { return std::clamp(1 - z / flare.height, 0.0, 1.0); }
double cube(double a) { return a * a * a; }

double sharpness_at(const CompiledFlare& flare, double k, double length) {
  return std::min(kSharpest, flare.sharpness * k * length);
}

double largest_factor(const CompiledFlare& flare, double z) {
  const double k = cube(remaining(flare, z));
  return (1 + sharpness_at(flare, k, flare.longest)) * (1 + flare.spread * k);
}

}  // namespace

std::string_view name_of(FlareSection section) {
  switch (section) {
    case FlareSection::kEnvelope: return "envelope";
    case FlareSection::kQuadrifolium: return "quadrifolium";
    case FlareSection::kCircle: return "circle";
  }
  return "";
}

double wrapped_angle(double angle) {
  const double turned = angle - 2 * kPi * std::floor(angle / (2 * kPi));
  return turned < 2 * kPi ? std::max(0.0, turned) : 0.0;
}

CompiledFlare::CompiledFlare(const Flare& authored)
    : base(authored.base), axis(glm::normalize(authored.axis)), x(reference_direction(axis)), y(glm::cross(axis, x)),
      height(authored.height), spread(authored.spread), sharpness(authored.sharpness), section(authored.section), longest(0) {
  for (const Prong& prong : authored.prongs) {
    gaps.push_back({wrapped_angle(prong.angle), 0, prong.length, 0});
    longest = std::max(longest, prong.length);
  }
  std::ranges::sort(gaps, {}, &FlareGap::begin);
  for (std::size_t i = 0; i < gaps.size(); ++i) {
    const bool last = i + 1 == gaps.size();
    const FlareGap& next = gaps[last ? 0 : i + 1];
    gaps[i].width = next.begin + (last ? 2 * kPi : 0.0) - gaps[i].begin;
    gaps[i].next_length = next.length;
  }
}

double flare_factor(const CompiledFlare& flare, const Vec3& p) {
  const Vec3 at = flare.local(p);
  const double rest = remaining(flare, at.x);
  if (!(rest > 0)) return 1;
  const double k = cube(rest);
  const Around around = around_at(flare, std::atan2(at.z, at.y));
  return SectionAt(flare.section, around.q).radius(sharpness_at(flare, k, around.length)).e * (1 + flare.spread * k);
}

FlareFactor flare_factor_gradient(const CompiledFlare& flare, const Vec3& p) {
  const Vec3 at = flare.local(p);
  const double rest = remaining(flare, at.x);
  if (!(rest > 0)) return {};
  const double k = cube(rest), k_by_z = rest < 1 ? -3 * rest * rest / flare.height : 0;
  const Around around = around_at(flare, std::atan2(at.z, at.y));
  const double wanted = flare.sharpness * k * around.length, tau = std::min(kSharpest, wanted);
  const Radius radius = SectionAt(flare.section, around.q).radius(tau);
  const double by_tau = wanted < kSharpest ? radius.by_tau * flare.sharpness : 0, widening = 1 + flare.spread * k;
  const double by_q = is_beyond_limit(flare, around.q) ? 0 : radius.by_q;
  const double by_angle = (by_q * around.q_by_angle + by_tau * k * around.length_by_angle) / radius.e;
  const double by_z = (by_tau * around.length / radius.e + flare.spread / widening) * k_by_z;
  const double rho2 = at.y * at.y + at.z * at.z;
  const Vec3 azimuth_gradient = rho2 > 0 ? (at.y * flare.y - at.z * flare.x) / rho2 : Vec3(0.0);
  return {radius.e * widening, by_angle * azimuth_gradient + by_z * flare.axis};
}

double flare_widening(const CompiledFlare& flare, const Vec3& p) {
  return 1 + flare.spread * cube(remaining(flare, flare.local(p).x));
}

// ---- bounds ---------------------------------------------------------------------------------------------------------
namespace {

Interval inverse(const Interval& positive) { return {1 / positive.hi, 1 / positive.lo}; }

/// Calls act(gap, where it begins) for those that an arc of at most one turn meets.
template <class Act>
void for_each_gap(const CompiledFlare& flare, const Interval& arc, const Act& act) {
  for (const FlareGap& gap : flare.gaps) {
    const double ahead = arc.lo + wrapped_angle(gap.begin - arc.lo);
    for (const double begin : {ahead - 2 * kPi, ahead})
      if (begin <= arc.hi && begin + gap.width >= arc.lo) act(gap, begin);
  }
}

/// Bounds of everything that M is made of, over a range of heights and an arc around the axis.
class FlareRange {
 public:
  FlareRange(const CompiledFlare& flare, const Interval& z, const Interval& azimuth)
      : flare_(flare), rest_{remaining(flare, z.hi), remaining(flare, z.lo)}, k_{cube(rest_.lo), cube(rest_.hi)},
        below_base_(z.lo <= 0), above_base_(z.hi >= 0) {
    if (rest_.hi > 0) go_around(azimuth);
    tau_ = {sharpness_at(flare, k_.lo, length_.lo), sharpness_at(flare, k_.hi, length_.hi)};
    valley_ = SectionAt(flare.section, q_.lo);
    prong_ = SectionAt(flare.section, q_.hi);
    least_ = valley_.radius(tau_.lo);
    most_ = prong_.radius(tau_.hi);
  }

  Interval factor() const {
    return {least_.e * (1 + flare_.spread * k_.lo) * (1 - kRounding), most_.e * (1 + flare_.spread * k_.hi) * (1 + kRounding)};
  }
  /// Of the derivative of ln M by the azimuth, and by the height.
  Interval by_angle() const {
    const Interval k = k_ * Interval{flare_.sharpness, flare_.sharpness};
    const Interval by_q{is_beyond_limit(flare_, q_.hi) ? 0 : least_.by_q, most_.by_q};
    return (by_q * q_by_angle_ + by_tau() * k * length_by_angle_) * per_e();
  }
  Interval by_height() const {
    const Interval tau_by_k = length_ * Interval{flare_.sharpness, flare_.sharpness};
    const Interval spreading{flare_.spread / (1 + flare_.spread * k_.hi), flare_.spread / (1 + flare_.spread * k_.lo)};
    const double per_height = -3 / flare_.height;
    const Interval k_by_z{above_base_ ? per_height * rest_.hi * rest_.hi : 0, below_base_ ? 0 : per_height * rest_.lo * rest_.lo};
    return (by_tau() * tau_by_k * per_e() + spreading) * k_by_z;
  }

 private:
  static constexpr double kRounding = 1e-13;

  /// The arc, in parts that lie between a prong and a valley.
  void go_around(const Interval& azimuth) {
    q_ = length_ = q_by_angle_ = length_by_angle_ = kNothing;
    for_each_gap(flare_, azimuth, [&](const FlareGap& gap, double begin) {
      const double from = std::max(0.0, (azimuth.lo - begin) / gap.width), to = std::min(1.0, (azimuth.hi - begin) / gap.width);
      if (from <= std::min(to, 0.5)) add_half(gap, 2 * from, 2 * std::min(to, 0.5), 1);
      if (std::max(from, 0.5) <= to) add_half(gap, 2 * (1 - to), 2 * (1 - std::max(from, 0.5)), -1);
    });
  }
  void add_half(const FlareGap& gap, double t_from, double t_to, double side) {
    for (const double t : {t_from, t_to}) {   // all goes one way in between
      const Around at = around_at(gap, t, side);
      q_ = hull(q_, {at.q, at.q});
      q_by_angle_ = hull(q_by_angle_, {at.q_by_angle, at.q_by_angle});
      length_ = hull(length_, {at.length, at.length});
      length_by_angle_ = hull(length_by_angle_, {at.length_by_angle, at.length_by_angle});
    }
  }
  /// Of E, while its sharpness grows.
  Interval by_tau() const {
    Interval slope{std::min(least_.by_tau, valley_.radius(tau_.hi).by_tau), std::max(most_.by_tau, prong_.radius(tau_.lo).by_tau)};
    if (flare_.sharpness * k_.hi * length_.hi >= kSharpest) slope = hull(slope, {0, 0});
    return slope;
  }
  Interval per_e() const { return inverse({least_.e, most_.e}); }

  const CompiledFlare& flare_;
  Interval rest_, k_, tau_{0, 0};
  bool below_base_, above_base_;
  Interval q_{0, 0}, q_by_angle_{0, 0}, length_{0, 0}, length_by_angle_{0, 0};
  SectionAt valley_, prong_;           ///< where E is smallest and largest
  Radius least_{}, most_{};
};

Interval around(double center, double reach) { return {center - reach, center + reach}; }

/// Of a ball, a hair more: points and balls round differently.
double reach_of(const CompiledFlare& flare, const Ball& ball) {
  return ball.radius * (1 + 1e-12) + 1e-15 * (glm::length(ball.center) + glm::length(flare.base));
}

}  // namespace

Interval arc_of_ball(double azimuth, double rho, double radius) {
  const double half = radius < rho ? std::min(std::asin(radius / rho) + 1e-12, kPi) : kPi;
  return {azimuth - half, azimuth + half};
}

std::vector<FlareGap> gaps_in_arc(const CompiledFlare& flare, const Interval& arc) {
  std::vector<FlareGap> gaps;
  for_each_gap(flare, arc, [&](FlareGap gap, double begin) {
    gap.begin = begin;
    gaps.push_back(gap);
  });
  std::ranges::sort(gaps, {}, &FlareGap::begin);
  return gaps;
}

Interval flare_factor_interval(const CompiledFlare& flare, const Ball& ball) {
  return flare_factor_interval(flare, ball, Vec3(kInfinity));
}

Interval flare_factor_interval(const CompiledFlare& flare, const Ball& ball, const Vec3& half_size) {
  const Vec3 at = flare.local(ball.center);
  const double reach = reach_of(flare, ball);
  double z_reach = 0;
  for (int i = 0; i < 3; ++i) z_reach += times(std::abs(flare.axis[i]), half_size[i]);
  const Interval z = around(at.x, std::min(z_reach, reach));
  if (z.lo >= flare.height) return {1, 1};
  return FlareRange(flare, z, arc_of_ball(std::atan2(at.z, at.y), std::hypot(at.y, at.z), reach)).factor();
}

namespace {

/// Where ways are about a flare's axis: its heights, azimuths, squared distances from the axis (0: azimuths may turn ever so fast), and
/// twice the areas that they sweep about it.
struct WayAbout {
  Interval z, azimuth, square, swept;
};

/// Around the axis a straight line sweeps equal areas, so that its azimuth goes one way.
WayAbout about_line(const CompiledFlare& flare, const Vec3& middle, const Vec3& velocity, double half) {
  const Vec3 from = flare.local(middle - half * velocity), to = flare.local(middle + half * velocity), step = to - from;
  const double slack = 1e-13 * (glm::length(middle) + glm::length(flare.base) + glm::length(from) + glm::length(to));
  const double step2 = step.y * step.y + step.z * step.z;
  const double nearest = step2 > 0 ? std::clamp(-(from.y * step.y + from.z * step.z) / step2, 0.0, 1.0) : 0.0;
  const double least = std::hypot(from.y + nearest * step.y, from.z + nearest * step.z) - slack;
  const double most = std::max(std::hypot(from.y, from.z), std::hypot(to.y, to.z)) + slack;
  const double area = from.y * to.z - from.z * to.y, swept = half > 0 ? area / (2 * half) : 0;
  const Interval z{std::min(from.x, to.x) - slack, std::max(from.x, to.x) + slack};
  if (!(least > slack)) return {z, arc_of_ball(0, 0, 1), {0, most * most}, around(swept, 0)};
  const double begin = std::atan2(from.z, from.y), turned = std::atan2(area, from.y * to.y + from.z * to.z);
  const double more = 1e-12 + slack / least;
  const Interval azimuth{begin + std::min(turned, 0.0) - more, begin + std::max(turned, 0.0) + more};
  return {z, azimuth, {least * least, most * most}, around(swept, slack * (glm::length(velocity) + std::abs(swept) / least))};
}

WayAbout about_ball(const CompiledFlare& flare, const FlareWay& way) {
  const Vec3 at = flare.local(way.ball.center);
  const double reach = reach_of(flare, way.ball), rho = std::hypot(at.y, at.z), least = std::max(0.0, rho - reach);
  const double vx = glm::dot(way.velocity, flare.x), vy = glm::dot(way.velocity, flare.y);
  return {around(at.x, reach), arc_of_ball(std::atan2(at.z, at.y), rho, reach), {least * least, (rho + reach) * (rho + reach)},
          around(at.y * vy - at.z * vx, reach * std::hypot(vx, vy) + (rho + reach) * way.turn)};
}

}  // namespace

FlareCourse flare_course(const CompiledFlare& flare, const FlareWay& way) {
  const WayAbout about = way.half > 0 ? about_line(flare, way.ball.center, way.velocity, way.half) : about_ball(flare, way);
  if (about.z.lo >= flare.height) return {{1, 1}, {0, 0}};
  const FlareRange range(flare, about.z, about.azimuth);
  const Interval climb = around(glm::dot(way.velocity, flare.axis), way.turn);
  const Interval turning = about.square.lo > 0 ? about.swept * inverse(about.square) : Interval{-kInfinity, kInfinity};
  return {range.factor(), range.by_angle() * turning + range.by_height() * climb};
}

// M only falls with height, so this closes in from below on the lowest place that the sweep can reach.
double flare_reach(const CompiledFlare& flare, const ChainNode* ends) {
  constexpr int kSteps = 12;
  const double z[2] = {glm::dot(ends[0].position - flare.base, flare.axis), glm::dot(ends[1].position - flare.base, flare.axis)};
  double most = largest_factor(flare, 0);
  for (int step = 0; step < kSteps && most > 1; ++step) {
    const double reach = kSupportPerRadius * (1 + 1e-9) * most;
    const double lowest = std::min(z[0] - reach * ends[0].radius, z[1] - reach * ends[1].radius);
    const double next = largest_factor(flare, lowest - 1e-12 * (std::abs(z[0]) + std::abs(z[1])));
    if (!(next < most)) break;
    most = next;
  }
  return most;
}

}  // namespace cambium
