#include "raytrace/framing.h"

#include <tbb/enumerable_thread_specific.h>
#include <tbb/parallel_for.h>

#include <algorithm>
#include <cmath>
#include <numbers>

namespace cambium {
namespace {

/// For points in camera axes: the largest of x - tan z and of -x - tan z give how far the camera must be back, and where its
/// axis must pass, so that all lie between its two planes.
struct Wedge {
  double tan = 0, plus = -kInfinity, minus = -kInfinity;
  void add(double x, double z) {
    plus = std::max(plus, x - tan * z);
    minus = std::max(minus, -x - tan * z);
  }
  double distance() const { return 0.5 * (plus + minus) / tan; }
  double one_sided_distance() const { return std::max(plus, minus) / tan; }   // with its axis through the origin
  double center() const { return 0.5 * (plus - minus); }
};

/// What to frame: the camera's own box, or all of it, or a cube.
std::vector<Vec3> points_to_frame(const Camera& camera, std::span<const Box> boxes, Box& whole) {
  const Box unit{Vec3(-0.5), Vec3(0.5)};
  if (camera.frame && !camera.frame->empty()) boxes = {&*camera.frame, 1};
  if (boxes.empty()) boxes = {&unit, 1};
  std::vector<Vec3> points;
  points.reserve(8 * boxes.size());
  for (const Box& box : boxes) {
    whole.extend(box);
    for (int c = 0; c < 8; ++c) points.push_back({c & 1 ? box.hi.x : box.lo.x, c & 2 ? box.hi.y : box.lo.y, c & 4 ? box.hi.z : box.lo.z});
  }
  return points;
}

/// Points around the circles that points describe about a vertical, the widest of each of some heights: between them lies all that a
/// turntable brings into view.
std::vector<Vec3> swept_about(const Vec3& center, const std::vector<Vec3>& points, const Box& whole) {
  struct Slab {
    double lo = kInfinity, hi = -kInfinity, radius = 0;
  };
  constexpr int kSlabs = 64, kAround = 64;
  std::vector<Slab> slabs(kSlabs);
  const double height = whole.size().z;
  for (const Vec3& p : points) {
    const double at = height > 0 ? (p.z - whole.lo.z) / height * kSlabs : 0;
    Slab& slab = slabs[static_cast<std::size_t>(std::clamp(at, 0.0, kSlabs - 1.0))];
    slab.lo = std::min(slab.lo, p.z);
    slab.hi = std::max(slab.hi, p.z);
    slab.radius = std::max(slab.radius, std::hypot(p.x - center.x, p.y - center.y));
  }
  std::vector<Vec3> circles;
  for (const Slab& slab : slabs) {
    if (!(slab.lo <= slab.hi)) continue;
    const double around = slab.radius / std::cos(std::numbers::pi / kAround);   // the polygon holds the circle
    for (int k = 0; k < kAround; ++k) {
      const double angle = 2 * std::numbers::pi * k / kAround;
      for (const double z : {slab.lo, slab.hi})
        circles.push_back({center.x + around * std::cos(angle), center.y + around * std::sin(angle), z});
    }
  }
  return circles;
}

/// Moves the eye as near as lets every point into the picture.
void stand_back(View& view, const Vec3& origin, bool origin_in_the_middle, double margin, const std::vector<Vec3>& points) {
  Wedge across{view.tan_x / margin}, upright{view.tan_y / margin};
  for (const Vec3& p : points) {
    const Vec3 q = p - origin;
    across.add(glm::dot(q, view.right), glm::dot(q, view.forward));
    upright.add(glm::dot(q, view.up), glm::dot(q, view.forward));
  }
  if (origin_in_the_middle) {   // each side must fit by itself
    const double distance = std::max(across.one_sided_distance(), upright.one_sided_distance());
    view.eye = origin - distance * view.forward;
    return;
  }
  const double distance = std::max(across.distance(), upright.distance());
  view.eye = origin + across.center() * view.right + upright.center() * view.up - distance * view.forward;
}

}  // namespace

View frame(const Camera& camera, std::span<const Box> boxes, int width, int height) {
  View view = lens_of(camera, width, height);
  Box whole;
  std::vector<Vec3> points = points_to_frame(camera, boxes, whole);
  const Vec3 middle = camera.target.value_or(whole.center());
  if (camera.eye) {
    view.eye = *camera.eye;
    view.look_along(middle - view.eye);
  } else {
    const double flat = std::cos(camera.elevation);
    view.look_along(-Vec3(flat * std::cos(camera.azimuth), flat * std::sin(camera.azimuth), std::sin(camera.elevation)));
    if (camera.turntable) points = swept_about(middle, points, whole);
    stand_back(view, middle, camera.target.has_value(), std::max(1e-3, camera.margin), points);
  }
  if (camera.turntable) {
    const Turntable& turn = *camera.turntable;
    view = view.turned(middle, 2 * std::numbers::pi * turn.frame / std::max(turn.frames, 1));
  }
  focus(view, camera, middle);
  return view;
}

std::vector<Box> surface_boxes(const SurfaceCover& cover) {
  const int parts = std::clamp(static_cast<int>(std::cbrt(200000.0 / std::max<std::size_t>(cover.size(), 1))), 1, 24);
  std::vector<Box> found(cover.size());
  tbb::enumerable_thread_specific<Evaluator> evaluators;
  tbb::parallel_for(std::size_t{0}, cover.size(), [&](std::size_t i) {
    const PrunedField field = cover.field(i);
    const Box& cell = field.box();
    if (parts == 1) {
      found[i] = cell;
      return;
    }
    const Vec3 size = cell.size() / double(parts);
    for (int k = 0; k < parts * parts * parts; ++k) {
      const Vec3 lo = cell.lo + size * Vec3(k % parts, k / parts % parts, k / (parts * parts));
      const Box part{lo, lo + size};
      if (evaluators.local().interval(field, part).contains(kIso)) found[i].extend(part);
    }
  });
  std::erase_if(found, [](const Box& box) { return box.empty(); });
  return found;
}

}  // namespace cambium
