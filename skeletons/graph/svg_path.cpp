#include "skeletons/graph/svg_path.h"

#include "blobtree/geometry.h"
#include "blobtree/input_error.h"
#include "skeletons/graph/svg_text.h"
#include "skeletons/number_checks.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <numbers>

namespace cambium {
namespace {

using Point = glm::dvec2;
/// A Bézier curve of the third degree; lines are straight ones, and arcs are made of short ones.
using Curve = std::array<Point, 4>;

constexpr std::size_t kMost = std::size_t{1} << 16;           // curves, and points of the stroke
constexpr double kArcStep = std::numbers::pi / 8;             // a curve is off its arc by less than a ten millionth of the radius

/// One piece of an ellipse around a center: axes turned by `tilt`.
struct EllipseArc {
  Point center, radii;
  double tilt = 0, from = 0, sweep = 0;

  Point at(double angle) const { return center + turned({radii.x * std::cos(angle), radii.y * std::sin(angle)}); }
  Point slope(double angle) const { return turned({-radii.x * std::sin(angle), radii.y * std::cos(angle)}); }
  Point turned(const Point& p) const {
    const double c = std::cos(tilt), s = std::sin(tilt);
    return {c * p.x - s * p.y, s * p.x + c * p.y};
  }
};

/// The arc between two points that are not the same, radii not 0, as the SVG 1.1 recommendation, appendix F.6.5 and F.6.6, has it.
EllipseArc arc_between(const Point& a, const Point& b, Point radii, double tilt, bool large, bool positive) {
  EllipseArc arc{{}, radii, -tilt, 0, 0};
  const Point half = arc.turned(0.5 * (a - b));
  const double stretch = glm::length(half / radii);
  if (stretch > 1) arc.radii *= stretch;
  const Point unit = half / arc.radii;
  const double off = std::sqrt(std::max(1 / glm::dot(unit, unit) - 1, 0.0)) * (large == positive ? -1 : 1);
  const Point middle = Point{unit.y, -unit.x} * off;
  arc.tilt = tilt;
  arc.center = 0.5 * (a + b) + arc.turned(middle * arc.radii);
  const Point begin = unit - middle, end = -unit - middle;
  arc.from = std::atan2(begin.y, begin.x);
  arc.sweep = std::atan2(end.y, end.x) - arc.from;
  if (positive && arc.sweep < 0) arc.sweep += 2 * std::numbers::pi;
  if (!positive && arc.sweep > 0) arc.sweep -= 2 * std::numbers::pi;
  return arc;
}

/// The first subpath of a path's data.
class PathReader {
 public:
  explicit PathReader(SvgCursor cursor) : cursor_(cursor) {}

  std::vector<Curve> read() {
    cursor_.skip_separators();
    char command = cursor_.peek();
    if (command != 'M' && command != 'm') cursor_.refuse("a path that begins with M");
    cursor_.move(1);
    begin_ = pen_ = pair({});
    command = command == 'm' ? 'l' : 'L';                     // what further pairs mean
    for (cursor_.skip_separators(); !cursor_.at_end(); cursor_.skip_separators()) {
      if (curves_.size() > kMost) cursor_.refuse("a path of at most 65536 pieces");
      if (cursor_.sees_number() && command != 'Z' && command != 'z') {
        draw(command);
        continue;
      }
      const char next = cursor_.peek();
      if (next == 'M' || next == 'm') break;
      if (command == 'Z' || command == 'z') break;            // what follows is another subpath
      if (next == '\0' || std::string_view("LlHhVvCcSsQqTtAaZz").find(next) == std::string_view::npos)
        cursor_.refuse("one of the commands M, L, H, V, C, S, Q, T, A and Z");
      cursor_.move(1);
      command = next;
      draw(command);
    }
    return std::move(curves_);
  }

 private:
  Point pair(const Point& origin) {
    const double x = cursor_.number(), y = cursor_.number();
    return origin + Point{x, y};
  }

  void draw(char command) {
    const bool relative = 'a' <= command && command <= 'z';
    const Point origin = relative ? pen_ : Point{0, 0};
    const Point handle = handle_;
    const char kind = relative ? static_cast<char>(command - 'a' + 'A') : command;
    const bool after_cubic = last_ == 'C' || last_ == 'S', after_quadratic = last_ == 'Q' || last_ == 'T';
    last_ = kind;
    switch (kind) {
      case 'L': return line(pair(origin));
      case 'H': return line({origin.x + cursor_.number(), pen_.y});
      case 'V': return line({pen_.x, origin.y + cursor_.number()});
      case 'C': {
        const Point a = pair(origin), b = pair(origin);
        return cubic(a, b, pair(origin));
      }
      case 'S': {
        const Point b = pair(origin);
        return cubic(after_cubic ? 2.0 * pen_ - handle : pen_, b, pair(origin));
      }
      case 'Q': {
        const Point a = pair(origin);
        return quadratic(a, pair(origin));
      }
      case 'T': return quadratic(after_quadratic ? 2.0 * pen_ - handle : pen_, pair(origin));
      case 'A': return arc(origin);
      default: return line(begin_);
    }
  }

  void line(const Point& to) { cubic(glm::mix(pen_, to, 1.0 / 3), glm::mix(pen_, to, 2.0 / 3), to); }

  void cubic(const Point& a, const Point& b, const Point& to) {
    curves_.push_back({pen_, a, b, to});
    handle_ = b;
    pen_ = to;
  }

  void quadratic(const Point& a, const Point& to) {
    cubic(glm::mix(pen_, a, 2.0 / 3), glm::mix(to, a, 2.0 / 3), to);
    handle_ = a;
  }

  void arc(const Point& origin) {
    const double rx = std::abs(cursor_.number()), ry = std::abs(cursor_.number()), tilt = cursor_.number() * std::numbers::pi / 180;
    const bool large = cursor_.flag(), positive = cursor_.flag();
    const Point to = pair(origin);
    if (to == pen_) return;
    if (!(rx > 0 && ry > 0)) return line(to);
    const EllipseArc arc = arc_between(pen_, to, {rx, ry}, tilt, large, positive);
    const int steps = std::max(1, static_cast<int>(std::ceil(std::abs(arc.sweep) / kArcStep)));
    const double step = arc.sweep / steps, reach = 4.0 / 3 * std::tan(0.25 * step);
    for (int i = 0; i < steps; ++i) {
      const double from = arc.from + i * step;
      const Point end = i + 1 < steps ? arc.at(from + step) : to;
      cubic(pen_ + reach * arc.slope(from), end - reach * arc.slope(from + step), end);
    }
  }

  SvgCursor cursor_;
  Point begin_{0.0}, pen_{0.0}, handle_{0.0};
  char last_ = 'M';
  std::vector<Curve> curves_;
};

/// How many lines are not farther than `tolerance` from the curve (Wang's bound by its second differences).
double lines_of(const Curve& c, double tolerance) {
  const double bend = std::max(glm::length(c[0] - 2.0 * c[1] + c[2]), glm::length(c[1] - 2.0 * c[2] + c[3]));
  return std::max(1.0, std::ceil(std::sqrt(0.75 * bend / tolerance)));
}

Point at(const Curve& c, double t) {
  const double s = 1 - t;
  return s * s * s * c[0] + 3 * s * s * t * c[1] + 3 * s * t * t * c[2] + t * t * t * c[3];
}

std::string text_of(const Point& p) { return "(" + std::to_string(p.x) + ", " + std::to_string(p.y) + ")"; }

struct Range {
  double low = kInfinity, high = -kInfinity;
  void extend(double v) { low = std::min(low, v), high = std::max(high, v); }
  double size() const { return high - low; }
};

/// What one path is made into a stroke by, and where it stands for messages.
class StrokeMaker {
 public:
  StrokeMaker(const SvgStrokeOptions& options, SvgCursor path) : options_(options), path_(path) {}

  std::vector<Point> stroke(std::vector<Curve> curves) const {
    Range drawn;
    for (const Curve& curve : curves)
      for (const Point& p : curve) drawn.extend(p.y);
    if (!(drawn.size() > 0) || !std::isfinite(drawn.size())) refuse("a path without a height", "a stroke that goes up");
    return in_metres(points_of(curves, drawn.size()));
  }

 private:
  [[noreturn]] void refuse(const std::string& found, const std::string& expected) const { path_.refuse_at(path_.at(), found, expected); }

  std::vector<Point> points_of(const std::vector<Curve>& curves, double size) const {
    const double apart = 1e-9 * size;
    std::vector<Point> points = {curves.front()[0]};
    for (const Curve& curve : curves) {
      const double lines = lines_of(curve, options_.tolerance * size);
      if (!(static_cast<double>(points.size()) + lines <= kMost))
        refuse("a stroke of more than 65536 points", "fewer, or a larger tolerance");
      for (int i = 1; i <= static_cast<int>(lines); ++i) {
        const Point p = i < lines ? at(curve, i / lines) : curve[3];
        if (glm::length(p - points.back()) > apart) points.push_back(p);
      }
    }
    if (points.size() > 2 && glm::length(points.back() - points.front()) <= apart) points.back() = points.front();
    return points;
  }

  std::vector<Point> in_metres(std::vector<Point> points) const {
    Range x, y;
    for (const Point& p : points) x.extend(p.x), y.extend(p.y);
    if (!(y.size() > 0) || !std::isfinite(x.size())) refuse("a path without a height", "a stroke that goes up");
    const double axis = options_.axis.value_or(x.low), scale = options_.height / y.size();
    const double side = x.high - axis >= axis - x.low ? 1 : -1;
    for (Point& p : points) {
      double distance = side * (p.x - axis);
      if (std::abs(distance) <= 1e-9 * y.size()) distance = 0;
      if (distance < 0)
        refuse("a stroke that crosses its axis x = " + std::to_string(axis) + " at " + text_of(p), "all of it on one side");
      p = {scale * distance, scale * (y.high - p.y)};
    }
    return points;
  }

  const SvgStrokeOptions& options_;
  SvgCursor path_;
};

}  // namespace

std::vector<glm::dvec2> read_svg_stroke(std::string_view text, const std::string& file, const SvgStrokeOptions& options) {
  require_positive(options.height, "height");
  require_positive(options.tolerance, "tolerance");
  if (options.axis && !std::isfinite(*options.axis)) throw InputError({}, "axis = " + std::to_string(*options.axis), "a finite axis");
  const SvgPathPlace place = find_svg_path(text, file, options.id);
  const SvgCursor path(text, file, place.begin, place.end);
  std::vector<Curve> curves = PathReader(path).read();
  for (Curve& curve : curves)
    for (Point& p : curve) p = place.to_document(p);
  return StrokeMaker(options, path).stroke(std::move(curves));
}

}  // namespace cambium
