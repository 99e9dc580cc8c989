#include "skeletons/graph/revolution.h"

#include "blobtree/input_error.h"
#include "skeletons/graph/quadratic.h"

#include <algorithm>
#include <cmath>
#include <optional>
#include <string>

namespace cambium {
namespace {

using Point = glm::dvec2;                     // (distance from the axis, z)

constexpr std::size_t kMostPoints = std::size_t{1} << 16;
constexpr std::size_t kCells = std::size_t{1} << 14;

/// Of the outline; the numbers of the stroke's points that it joins, from 1, 0 being the axis.
struct NumberedLine {
  Point a, b;
  std::size_t from = 0, to = 0;
};

bool on_axis(const NumberedLine& line) { return line.a.x == 0 && line.b.x == 0; }

/// The stroke with its ends joined to the axis, without lines of no length.
std::vector<NumberedLine> outline(std::span<const Point> stroke) {
  std::vector<NumberedLine> lines;
  const auto join = [&](const Point& a, const Point& b, std::size_t from, std::size_t to) {
    if (a != b) lines.push_back({a, b, from, to});
  };
  const bool closed = stroke.front() == stroke.back();
  if (!closed) join({0, stroke.front().y}, stroke.front(), 0, 1);
  for (std::size_t i = 1; i < stroke.size(); ++i) join(stroke[i - 1], stroke[i], i, i + 1);
  if (!closed) join(stroke.back(), {0, stroke.back().y}, stroke.size(), 0);
  return lines;
}

Box box_of(const Point& a, const Point& b) {
  Box box;
  box.extend(Vec3(a, 0)), box.extend(Vec3(b, 0));
  return box;
}

int side_of(const Point& a, const Point& b, const Point& p) {
  const Point u = b - a, v = p - a;
  const double area = u.x * v.y - u.y * v.x;
  return (area > 0) - (area < 0);
}

/// Whether two lines have a point in common.
bool meet(const NumberedLine& l, const NumberedLine& m) {
  const int a = side_of(m.a, m.b, l.a), b = side_of(m.a, m.b, l.b), c = side_of(l.a, l.b, m.a), d = side_of(l.a, l.b, m.b);
  if (a == 0 && b == 0 && c == 0 && d == 0) return box_of(l.a, l.b).intersects(box_of(m.a, m.b));
  return a * b <= 0 && c * d <= 0;
}

/// The first two lines, in the stroke's order, that meet where they should not.
std::optional<std::array<std::size_t, 2>> first_crossing(const std::vector<NumberedLine>& lines) {
  const BoxTree tree(lines.size(), [&](std::uint32_t i) { return box_of(lines[i].a, lines[i].b); });
  std::optional<std::array<std::size_t, 2>> first;
  const auto look = [&](std::uint32_t i, std::uint32_t j) {
    const std::array<std::size_t, 2> pair = {std::min(i, j), std::max(i, j)};
    if (first && *first < pair) return;
    const NumberedLine &l = lines[pair[0]], &m = lines[pair[1]];
    const bool neighbours = (pair[1] == pair[0] + 1 && l.b == m.a) || (pair[0] == 0 && pair[1] + 1 == lines.size() && m.b == l.a);
    if (!neighbours && !on_axis(l) && !on_axis(m) && meet(l, m)) first = pair;
  };
  for (std::size_t leaf = 0; leaf < tree.leaf_count(); ++leaf) tree.overlaps(leaf, look);
  return first;
}

std::string name_of(const NumberedLine& line) {
  if (line.from == 0) return "between the axis and point " + std::to_string(line.to);
  if (line.to == 0) return "between point " + std::to_string(line.from) + " and the axis";
  return "between points " + std::to_string(line.from) + " and " + std::to_string(line.to);
}

/// Of the half-plane's part that the outline bounds, square metres.
double area_of(const std::vector<NumberedLine>& lines) {
  double sum = 0;
  for (const NumberedLine& line : lines) sum += 0.5 * (line.a.x + line.b.x) * (line.b.y - line.a.y);
  return std::abs(sum);
}

double distance2_to_line(const Point& p, const Point& a, const Point& b) {
  const Point ab = b - a, ap = p - a;
  const Point off = ap - std::clamp(glm::dot(ap, ab) / glm::dot(ab, ab), 0.0, 1.0) * ab;
  return glm::dot(off, off);
}

double across(const Vec3& p) { return std::sqrt(p.x * p.x + p.y * p.y); }

}  // namespace

void validate_stroke(std::span<const glm::dvec2> stroke) {
  if (stroke.size() < 2 || stroke.size() > kMostPoints)
    throw InputError({}, "a stroke of " + std::to_string(stroke.size()) + " points", "2 to 65536 points");
  for (std::size_t i = 0; i < stroke.size(); ++i) {
    const std::string point = "stroke: point " + std::to_string(i + 1) + ", ";
    const std::string place = "(" + std::to_string(stroke[i].x) + ", " + std::to_string(stroke[i].y) + ")";
    if (!std::isfinite(stroke[i].x) || !std::isfinite(stroke[i].y)) throw InputError({}, point + place, "finite numbers");
    if (stroke[i].x < 0) throw InputError({}, point + place + ", beyond the axis", "a stroke that does not cross its axis");
  }
  const std::vector<NumberedLine> lines = outline(stroke);
  if (const auto crossing = first_crossing(lines))
    throw InputError({}, "stroke: it meets itself " + name_of(lines[(*crossing)[0]]) + " and " + name_of(lines[(*crossing)[1]]),
                     "a stroke that does not cross itself");
  Box box;
  for (const glm::dvec2& p : stroke) box.extend(Vec3(0, p.y, 0)), box.extend(Vec3(p, 0));
  if (!(area_of(lines) > 1e-12 * glm::dot(box.size(), box.size())))
    throw InputError({}, "stroke: no area between it and its axis", "a stroke that encloses a solid as it turns");
}

RevolvedStroke::RevolvedStroke(std::span<const glm::dvec2> stroke) {
  for (const NumberedLine& line : outline(stroke))
    if (!on_axis(line)) lines_.push_back({line.a, line.b});
  const auto line_box = [&](std::size_t i) { return box_of(lines_[i].a, lines_[i].b); };
  tree_ = BoxTree(lines_.size(), line_box);
  Box bounds = box_of({0, lines_[0].a.y}, lines_[0].a);
  for (std::size_t i = 0; i < lines_.size(); ++i) bounds.extend(line_box(i));
  cells_ = SettledCells(bounds, std::min(kCells, 16 * lines_.size()), lines_.size(), line_box,
                        [this](const Vec3& p) { return encloses(p.x, p.y); });
}

bool RevolvedStroke::contains(const Vec3& p) const {
  const double r = across(p);
  const SettledCells::Kind kind = cells_.at({r, p.z, 0});
  return kind == SettledCells::Kind::kUnknown ? encloses(r, p.z) : kind == SettledCells::Kind::kInside;
}

/// By the number of lines that are farther from the axis on the same height; a line's lower end is of it, its upper one is not.
bool RevolvedStroke::encloses(double r, double z) const {
  bool inside = false;
  tree_.search([&](const FloatBox& box) { return box.lo.y <= z && z <= box.hi.y && r <= box.hi.x; },
               [&](std::uint32_t i) {
                 const auto& [a, b] = lines_[i];
                 if ((a.y > z) == (b.y > z)) return;
                 if (r <= a.x + (b.x - a.x) * ((z - a.y) / (b.y - a.y))) inside = !inside;
               });
  return inside;
}

double RevolvedStroke::depth(const Vec3& p) const {
  const Point q{across(p), p.z};
  return std::sqrt(tree_.nearest2(Vec3(q, 0), kInfinity, [&](std::uint32_t i) { return distance2_to_line(q, lines_[i].a, lines_[i].b); }));
}

/// A line of the stroke sweeps part of a cone, or of a plane; along the way from a to b the square of the distance from the axis is
/// compared with the cone's.
bool RevolvedStroke::meets(const Vec3& a, const Vec3& b) const {
  if (contains(a) || contains(b)) return true;
  const Vec3 way = b - a;
  const Quadratic across2 = {way.x * way.x + way.y * way.y, 2 * (a.x * way.x + a.y * way.y), a.x * a.x + a.y * a.y};
  const double nearest = std::sqrt(std::max(across2.least({0, 1}), 0.0)) * (1 - 1e-12), farthest = std::sqrt(across2.most({0, 1}));
  const auto [low, high] = std::minmax(a.z, b.z);
  bool met = false;
  tree_.search(
      [&, low = low, high = high](const FloatBox& box) {
        return !met && box.lo.y <= high && low <= box.hi.y && box.lo.x <= farthest && nearest <= box.hi.x;
      },
      [&](std::uint32_t i) {
        const auto& [from, to] = lines_[i];
        const auto [bottom, top] = std::minmax(from.y, to.y);
        Span span{0, 1};
        span.keep_above(way.z, a.z - bottom);
        span.keep_above(-way.z, top - a.z);
        if (span.empty()) return;
        if (bottom == top) {
          const auto [inner, outer] = std::minmax(from.x, to.x);
          met = met || (across2.least(span) <= outer * outer && across2.most(span) >= inner * inner);
          return;
        }
        const double slope = (to.x - from.x) / (to.y - from.y), radius = from.x + slope * (a.z - from.y), step = slope * way.z;
        const Quadratic beyond = {across2.a - step * step, across2.b - 2 * radius * step, across2.c - radius * radius};
        met = met || (beyond.least(span) <= 0 && beyond.most(span) >= 0);
      });
  return met;
}

}  // namespace cambium
