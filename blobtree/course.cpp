// Courses of primitives. Along a straight way the square of a swept ratio, Y = (x/2.2)^2, is nearly a parabola: at most
// 2/(2.2 r)^2 of second derivative (where a ball is nearest it is exactly that), and below, on the flank of a cone, at least that
// times 1 - (d.axis)^2 - 6 |slope| x. So one look at its middle bounds Y and Y' on the whole way, and with them
// f = (1 - Y)^3 and f' = -3 (1 - Y)^2 Y'.
//
// Through a ball instead of along a way the second derivatives swing the slope by as much, since their matrix has no larger
// eigenvalue than that, and the values are those of a distance.
//
// The flank: with phi the angle at the apex, Y is proportional to sin^2(phi), homogeneous of degree 0. Its second derivative in
// the direction (a, b, c) along the ray from the apex, across it in the axial plane and around the axis is
// 2/(r cos(phi))^2 (b^2 cos(2 phi) - a b sin(2 phi) + c^2 cos^2(phi)), r at the nearest axis point, whose eigenvalues are
// 2/r^2 (1, 1, -tan^2(phi)), and sin(phi) = |slope| x.
//
// A flare's Y is its chain's over M^2, and of M bounds are known as well (flare.h).
#include "blobtree/course.h"

#include "blobtree/evaluator_scratch.h"
#include "blobtree/interval_arithmetic.h"
#include "blobtree/tape_interval.h"

#include <cmath>
#include <span>

namespace cambium {
namespace {

constexpr double kSquaredRadiusPerSupport = kRadiusPerSupport * kRadiusPerSupport;
constexpr double kSteepestTaper = 0.7;   // of slope times x: beyond, what is above says little

/// Y and Y' in the middle and bounds of Y'', to bounds on the way.
SquaredRatio along_parabola(double y, double slope, double bend_lo, double bend_hi, double half) {
  const double straight = std::abs(slope) * half, hi = y + straight + 0.5 * bend_hi * half * half;
  const double lo = bend_lo * half > std::abs(slope) ? y - 0.5 * slope * slope / bend_lo : y - straight + 0.5 * bend_lo * half * half;
  const double swing = std::max(bend_hi, -bend_lo) * half;
  return {{std::max(0.0, lo - 1e-12 * (1 + y)), hi + 1e-12 * (1 + y)}, {slope - swing, slope + swing}};
}

/// From bounds of the distance over the support radius alone.
Interval square(double lo, double hi) {
  lo = std::max(0.0, lo * (1 - 1e-12));
  hi *= 1 + 1e-12;
  return {lo * lo, hi * hi};
}
SquaredRatio between(double lo, double hi, double fastest) {
  const Interval value = square(lo, hi);
  const double steepest = 2 * hi * (1 + 1e-12) * fastest;
  return {value, {-steepest, steepest}};
}

/// The slope where the velocity is not quite that in the middle: the gradient is at most 2 hi times that of the ratio.
SquaredRatio turned(SquaredRatio y, double gradient, double turn) {
  const double more = 2 * std::sqrt(y.value.hi) * (1 + 1e-12) * gradient * turn;
  return {y.value, {y.slope.lo - more, y.slope.hi + more}};
}

double least_radius(const SweptSegment<double>& k) { return std::min(k.radius_at(k.begin), k.radius_at(k.end)); }

SeenSegment seen(const SweptSegment<double>& k, const Way& way) {
  const Vec3 q = way.middle - k.a;
  const double s = closest_parameter(k, q), r = k.radius_at(s), per_r = 1 / r, least = least_radius(k);
  const Vec3 v = q - s * k.axis;
  return {&k, v, r, per_r, std::sqrt(glm::dot(v, v)) * per_r, least, way.half * way.speed / least};
}

SquaredRatio squared_ratio(const SeenSegment& seen, const Way& way) {
  const SweptSegment<double>& k = *seen.segment;
  const double r = seen.r, per_square = kSquaredRadiusPerSupport * seen.per_r * seen.per_r, reach = way.half * way.speed;
  const double speed2 = way.speed * way.speed, along = glm::dot(way.velocity, k.axis);
  double bend_lo = 0, bend_hi = 0;
  if (k.slope == 0) {
    bend_lo = 2 * per_square * std::max(0.0, speed2 - along * along);   // a ball's, where one is nearest, is more
    bend_hi = 2 * per_square * speed2;
  } else {
    const double x_hi = seen.x + seen.change, sine = x_hi * std::abs(k.slope);
    if (sine > kSteepestTaper) {
      return between((seen.x - seen.change) * kRadiusPerSupport, x_hi * kRadiusPerSupport, way.fastest() * kRadiusPerSupport / seen.least);
    }
    // The nearest axis point moves by at most 1 + tan^2(phi) < 2 of the way.
    const double change = 2 * reach * std::abs(k.slope);
    const double r_lo = std::max(seen.least, r - change), r_hi = r + change;
    const double most = 2 * kSquaredRadiusPerSupport * speed2 / (r_lo * r_lo);
    const double across = speed2 * (1 - 6 * sine) - along * along;
    bend_hi = most;
    bend_lo = across > 0 ? 2 * kSquaredRadiusPerSupport * across / (r_hi * r_hi) : -most * sine * sine / (1 - sine * sine);
  }
  SquaredRatio y = along_parabola(seen.x * seen.x * kSquaredRadiusPerSupport, 2 * per_square * glm::dot(seen.v, way.velocity), bend_lo,
                                  bend_hi, way.half);
  if (way.wide) y.value = square((seen.x - seen.change) * kRadiusPerSupport, (seen.x + seen.change) * kRadiusPerSupport);
  return turned(y, kRadiusPerSupport / seen.least, way.turn);
}

/// Whether its support, `widening` times as wide, surely passes the ball.
bool is_out_of_reach(const SweptSegment<double>& k, double widening, const Ball& ball) {
  const Vec3 from_middle = ball.center - (k.a + 0.5 * (k.begin + k.end) * k.axis);
  const double thickest = std::max(k.radius_at(k.begin), k.radius_at(k.end));
  const double reach = 0.5 * (k.end - k.begin) + kSupportPerRadius * widening * thickest * (1 + 1e-9) + ball.radius;
  return glm::dot(from_middle, from_middle) > reach * reach;
}

/// f = strength (1 - Y)^3.
Course falloff_course(const SquaredRatio& y, double strength) {
  const double near = std::max(0.0, 1 - y.value.lo), far = std::max(0.0, 1 - y.value.hi);
  const double least = 3 * far * far, most = 3 * near * near;
  const Interval slope{y.slope.hi > 0 ? -times(most, y.slope.hi) : -times(least, y.slope.hi),
                       y.slope.lo < 0 ? -times(most, y.slope.lo) : -times(least, y.slope.lo)};
  const Interval value{far * far * far, near * near * near};
  if (strength >= 0) return {{strength * value.lo, strength * value.hi}, {times(strength, slope.lo), times(strength, slope.hi)}};
  return {{strength * value.hi, strength * value.lo}, {times(strength, slope.hi), times(strength, slope.lo)}};
}

/// Of a chain whose segments may have these ratios.
SquaredRatio nearest_of(std::span<const SquaredRatio> ratios) {
  SquaredRatio nearest{{kInfinity, kInfinity}, {kInfinity, -kInfinity}};
  for (const SquaredRatio& y : ratios) nearest.value = {std::min(nearest.value.lo, y.value.lo), std::min(nearest.value.hi, y.value.hi)};
  for (const SquaredRatio& y : ratios) {
    if (y.value.lo > nearest.value.hi) continue;
    nearest.slope = {std::min(nearest.slope.lo, y.slope.lo), std::max(nearest.slope.hi, y.slope.hi)};
  }
  return nearest;
}

/// Of Y / M^2.
SquaredRatio widened(const SquaredRatio& y, const FlareCourse& m) {
  const double least = m.factor.lo * m.factor.lo, most = m.factor.hi * m.factor.hi;
  const Interval per_square{1 / most, 1 / least}, value{y.value.lo / most, y.value.hi / least};
  return {value, y.slope * per_square + Interval{-2, -2} * value * m.log_slope};
}

FlareWay flare_way(const Way& way) {
  if (!way.straight) return {way.ball, Vec3(0.0), way.fastest()};
  if (way.wide || way.turn > 0) return {way.ball, way.velocity, way.turn};
  return {{way.middle, 0}, way.velocity, 0, way.half};
}

/// Squares of distances to convex sets have a second derivative in [0, 2]; a circle is none.
template <class Shape>
constexpr bool kIsConvex = !std::is_same_v<Shape, CircleSkeleton<double>>;

SquaredRatio squared_ratio(const CompiledPrimitive& p, const Way& way) {
  return std::visit(
      [&](const auto& shape) {
        const double inverse = p.inverse_support;
        const Distance<double> d = distance(shape, way.straight ? way.middle : way.ball.center);
        if (!way.straight || !kIsConvex<std::decay_t<decltype(shape)>>) {
          const double reach = way.straight ? way.half * way.speed : way.ball.radius;
          return between((d.value - reach) * inverse, (d.value + reach) * inverse, way.fastest() * inverse);
        }
        const double per_square = inverse * inverse;
        SquaredRatio y = along_parabola(d.value * d.value * per_square, 2 * d.value * glm::dot(d.gradient, way.velocity) * per_square, 0,
                                        2 * per_square * way.speed * way.speed, way.half);
        const double reach = way.half * way.speed;
        if (way.wide) y.value = square((d.value - reach) * inverse, (d.value + reach) * inverse);
        return turned(y, inverse, way.turn);
      },
      p.shape);
}

class CoursePolicy {
 public:
  CoursePolicy(const TapeView& view, Evaluator::Scratch& at) : view_(view), at_(at) {}

  Course primitive(const Instruction& in) const {
    const CompiledPrimitive& p = at_.shapes.primitive(static_cast<std::size_t>(&in - view_.tape.instructions().data()));
    return falloff_course(squared_ratio(p, at_.ways[in.frame]), p.strength);
  }
  Course half_space(const Instruction& in) const {
    const CompiledHalfSpace& h = view_.tree.half_spaces[view_.tree.nodes[in.node].payload];
    const Way& way = at_.ways[in.frame];
    const Interval value = half_space_interval(h, way.ball);
    const double steepest = way.fastest() / (2 * h.width);
    if (!way.straight) return {value, {-steepest, steepest}};
    const double ramp = glm::dot(way.velocity, h.normal) / (-2 * h.width), more = way.turn / (2 * h.width);
    if (value.lo > 0 && value.hi < 1) return {value, {ramp - more, ramp + more}};
    return {value, {std::min(0.0, ramp - more), std::max(0.0, ramp + more)}};
  }
  Course chain(const Instruction& in) const {
    const SquaredRatio y = nearest(in, 1);
    return y.value.lo < 1 ? falloff_course(y, view_.tree.chain_strength_of(view_.tree.nodes[in.node])) : Course{};
  }
  Course flare(const Instruction& in) const {
    const CompiledNode& node = view_.tree.nodes[in.node];
    const FlareCourse m = flare_course(view_.tree.flare_of(node), flare_way(at_.ways[in.frame]));
    const SquaredRatio y = nearest(in, m.factor.hi);
    if (!(y.value.lo < m.factor.hi * m.factor.hi)) return {};
    return falloff_course(widened(y, m), view_.tree.chain_strength_of(node));
  }
  /// l = 1 - (1 - S(u)) (1 - S(w)), field.md section 4: u is linear along a straight way, and w's distance is convex.
  Course lateral_weight(const Lateral& lateral, const Instruction& in) const {
    const Way& way = at_.ways[in.frame];
    const Interval value = lateral_contact_weight_interval(lateral, way.ball);
    const double per_softness = 0.5 / lateral.softness, per_reach = 1 / lateral.reach;
    const Vec3 from = way.ball.center - lateral.point;
    const double away = glm::length(from), reach = way.ball.radius;
    const double fastest = way.fastest();
    Interval crotch_slope{-fastest * per_softness, fastest * per_softness}, away_slope{-fastest * per_reach, fastest * per_reach};
    if (way.straight) {
      const double u = glm::dot(way.velocity, lateral.direction);
      crotch_slope = {(u - way.turn) * per_softness, (u + way.turn) * per_softness};
      if (away > reach) {
        const double middle = glm::dot(from, way.velocity) / away, change = way.half * way.speed * way.speed / (away - reach) + way.turn;
        away_slope = {std::max(away_slope.lo, (middle - change) * per_reach), std::min(away_slope.hi, (middle + change) * per_reach)};
      }
    }
    const double u = 0.5 + glm::dot(from, lateral.direction) * per_softness;
    const Interval u_range{u - reach * per_softness, u + reach * per_softness};
    const Interval w_range{(away - reach - lateral.reach) * per_reach, (away + reach - lateral.reach) * per_reach};
    const Interval by_u = scaled_by(steps_slope(u_range), not_stepped(w_range)), by_w = scaled_by(steps_slope(w_range), not_stepped(u_range));
    const Interval a = product(by_u, crotch_slope), b = product(by_w, away_slope);
    return {value, {a.lo + b.lo, a.hi + b.hi}};
  }
  Course warp(const Instruction& in, const Course& f) const {
    if (at_.ways[in.frame].certain) return f;
    const Interval& anywhere = view_.tree.warps[view_.tree.nodes[in.node].payload].range;
    return {{std::min(0.0, anywhere.lo), std::max(0.0, anywhere.hi)}, {-kInfinity, kInfinity}};
  }

 private:
  /// The nearest of a chain's segments counts: those that may be it. Those that are out of reach of so much widening are left out.
  SquaredRatio nearest(const Instruction& in, double widening) const {
    const Way& way = at_.ways[in.frame];
    const auto segments = std::span(at_.shapes.segments() + in.first, in.count);
    at_.ratios.clear();
    if (way.straight) {
      at_.seen.clear();
      double nearest = kInfinity;   // at some place of the way at most
      for (const SweptSegment<double>& segment : segments) {
        if (is_out_of_reach(segment, widening, way.ball)) continue;
        const SeenSegment& it = at_.seen.emplace_back(seen(segment, way));
        nearest = std::min(nearest, it.x + it.change);
      }
      for (const SeenSegment& it : at_.seen)
        if ((it.x - it.change) * (1 - 1e-12) <= nearest) at_.ratios.push_back(squared_ratio(it, way));
    } else {
      for (const SweptSegment<double>& segment : segments) {
        const Interval x = swept_ratio_interval(segment, way.ball);
        at_.ratios.push_back(between(x.lo * kRadiusPerSupport, x.hi * kRadiusPerSupport, way.fastest() * kRadiusPerSupport / least_radius(segment)));
      }
    }
    return nearest_of(at_.ratios);
  }

  /// Of S' = 6 t (1 - t) on [0, 1], else 0.
  static Interval steps_slope(const Interval& t) {
    const double a = smooth_step_slope(t.lo), b = smooth_step_slope(t.hi);
    return {std::min(a, b), t.lo < 0.5 && t.hi > 0.5 ? 1.5 : std::max(a, b)};
  }
  static Interval not_stepped(const Interval& t) { return {1 - smooth_step(t.hi), 1 - smooth_step(t.lo)}; }
  static Interval scaled_by(const Interval& a, const Interval& b) { return {a.lo * b.lo, a.hi * b.hi}; }   // of what is not negative
  static Interval product(const Interval& positive, const Interval& b) {
    return {b.lo < 0 ? positive.hi * b.lo : positive.lo * b.lo, b.hi > 0 ? positive.hi * b.hi : positive.lo * b.hi};
  }

  const TapeView& view_;
  Evaluator::Scratch& at_;
};

/// The way on the inner side of a warp.
Way inside(const Warp& warp, const Way& outside) {
  Way way;
  way.half = outside.half;
  if (outside.certain && misses_child(warp, outside.ball)) {
    way.straight = false;
    way.ball = {unwarp(warp, outside.ball.center), 0};
    way.speed = 0;
    return way;
  }
  const UnwarpedBall ball = unwarp(warp, outside.ball);
  way.ball = ball.ball;
  way.certain = outside.certain && ball.certain;
  const auto* const rigid = std::get_if<RigidWarp>(&warp);
  const auto* const bend = std::get_if<BendWarp>(&warp);
  const double stretch = outside.ball.radius > 0 ? ball.ball.radius / outside.ball.radius : kInfinity;
  way.straight = outside.straight && (rigid || (bend && way.certain && outside.ball.radius > 0));
  way.wide = outside.wide || bend;
  if (way.straight) {
    way.middle = unwarp(warp, outside.middle);
    way.velocity = rigid ? (outside.velocity * rigid->axes) / rigid->scale : push_forward(*bend, outside.middle, outside.velocity);
    way.speed = glm::length(way.velocity);
    way.turn = stretch * outside.turn;
    if (bend) {
      way.turn += turn_in(*bend, outside.ball, outside.velocity);
      way.half = way.ball.radius / way.speed;
    }
  } else {
    way.speed = outside.fastest() == 0 ? 0 : outside.fastest() * stretch;
  }
  return way;
}

}  // namespace

Course Evaluator::course(const PrunedField& field, const Vec3& middle, const Vec3& direction, double half) {
  return course({middle, half}, direction, false, field);
}

Course Evaluator::course(const PrunedField& field, const Ball& ball, const Vec3& direction) { return course(ball, direction, true, field); }

Course Evaluator::course(const Ball& ball, const Vec3& direction, bool wide, const PrunedField& field) {
  if (field.empty()) return {};
  Scratch& s = *scratch_;
  const TapeView view = Scratch::view(field);
  s.shapes.gather(view.tree, view.tape);
  Way world;
  world.middle = ball.center;
  world.velocity = direction;
  world.half = ball.radius * (1 + 1e-12) + 1e-15 * glm::length(ball.center);
  world.wide = wide;
  world.ball = {world.middle, world.half};
  s.ways.resize(view.frame_count());
  s.ways[0] = world;
  for (std::size_t k = 1; k < s.ways.size(); ++k) s.ways[k] = inside(view.warp_of(k), s.ways[view.outside_of(k)]);
  CoursePolicy policy(view, s);
  const Course course = run_tape(view, policy, s.courses);
  if (!(course.slope.lo <= course.slope.hi)) return {a_hair_wider(course.value), {-kInfinity, kInfinity}};   // infinities met
  // A hair wider, but at 0: that is the slope of what is constant, exactly.
  const double slack = 1e-9 * (std::abs(course.slope.lo) + std::abs(course.slope.hi));
  return {a_hair_wider(course.value),
          {course.slope.lo == 0 ? 0 : course.slope.lo - slack, course.slope.hi == 0 ? 0 : course.slope.hi + slack}};
}

}  // namespace cambium
