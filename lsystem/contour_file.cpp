#include "lsystem/contour_file.h"

#include <algorithm>
#include <cmath>
#include <numbers>
#include <string>
#include <vector>

#include "lsystem/preprocessor.h"
#include "lsystem/value_reader.h"

namespace cambium {
namespace {

using Vec2 = glm::dvec2;

constexpr std::size_t kMaxPoints = 10'000;
constexpr double kLeastRadius = 0.01;
constexpr int kStepsOfSpan = 16;

struct Contour {
  std::vector<Vec2> points;
  bool closed = true;
};

class ContourReader {
 public:
  explicit ContourReader(const SourceText& source) : values_(source, ValueReader::Layout::kFree) {}

  Contour read() { return values_.accept("cver") ? versioned() : plain(); }

 private:
  // `n dimensions closed|open`
  Contour plain() {
    Contour out;
    const std::size_t count = values_.count("a number of points, or 'cver'", 4, kMaxPoints);
    const std::size_t dimensions = values_.count("dimensions", 2, 3);
    out.closed = values_.word("'closed' or 'open'") == "closed";
    while (out.points.size() < count) out.points.push_back(point(dimensions));
    return out;
  }

  // Points with how often each counts; all of them are `whole`.
  Contour versioned() {
    values_.count("version 1 1 to 1 3", 1, 1);
    const std::size_t minor = values_.count("version 1 1 to 1 3", 1, 3);
    Contour out;
    values_.expect("name:");
    values_.next_line();
    values_.expect("points:");
    const std::size_t count = values_.count("a number of points", 1, kMaxPoints);
    const std::size_t whole = values_.count("a number of points, repeated ones included", 4, kMaxPoints);
    values_.expect("type:");
    out.closed = !values_.word("a type, open or closed").starts_with('o');
    if (minor == 3) editor_lines();
    for (std::size_t i = 0; i < count; ++i) {
      const Vec2 p = point(3);
      out.points.insert(out.points.end(), values_.count("how often the point counts", 1, 100), p);
    }
    if (out.points.size() != whole) values_.fail(std::to_string(whole) + " points in all");
    return out;
  }

  // What the editor keeps for itself.
  void editor_lines() {
    values_.expect("samples:");
    values_.next_line();
    if (values_.accept("background")) {
      values_.next_line();
      values_.next_line();
    }
    if (!values_.accept("markers:")) return;
    const std::size_t markers = values_.count("a number of markers", 0, kMaxPoints);
    for (std::size_t i = 0; i <= markers; ++i) values_.next_line();
  }

  // The third is along the axis.
  Vec2 point(std::size_t dimensions) {
    Vec2 out;
    out.x = values_.number("the coordinates of a point");
    out.y = values_.number("the coordinates of a point");
    if (dimensions == 3) values_.number("the coordinates of a point");
    return out;
  }

  ValueReader values_;
};

Vec2 on_spline(const Contour& contour, std::size_t span, double t) {
  const auto p = [&](std::size_t i) { return contour.points[(span + i) % contour.points.size()]; };
  const double s = 1 - t;
  return (s * s * s * p(0) + (3 * t * t * t - 6 * t * t + 4) * p(1) + (3 * s * s * s - 6 * s * s + 4) * p(2) +
          t * t * t * p(3)) /
         6.0;
}

double area_of(const Contour& contour) {
  const std::size_t spans = contour.closed ? contour.points.size() : contour.points.size() - 3;
  const Vec2 first = on_spline(contour, 0, 0);
  Vec2 last = first;
  double twice = 0;
  for (std::size_t i = 1; i <= spans * kStepsOfSpan; ++i) {
    const std::size_t span = std::min((i - 1) / kStepsOfSpan, spans - 1);
    const Vec2 next = on_spline(contour, span, static_cast<double>(i - span * kStepsOfSpan) / kStepsOfSpan);
    const Vec2 a = last - first, b = next - first;
    twice += a.x * b.y - a.y * b.x;
    last = next;
  }
  return 0.5 * std::abs(twice);
}

}  // namespace

double read_contour_radius(std::string_view text, const std::filesystem::path& file) {
  const SourceText source = preprocess(text, file);
  const Contour contour = ContourReader(source).read();
  const double radius = std::sqrt(area_of(contour) / std::numbers::pi);
  if (!(radius < 1e6))
    throw InputError({file.string(), 0, 0}, "a contour of more than a million line widths", "one about a line's width");
  return std::max(radius, kLeastRadius);
}

}  // namespace cambium
