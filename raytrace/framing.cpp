#include "raytrace/framing.h"

#include <tbb/enumerable_thread_specific.h>
#include <tbb/parallel_for.h>

#include <algorithm>
#include <cmath>

namespace cambium {
namespace {

void orient(View& view, const Vec3& forward) {
  view.forward = forward;
  const Vec3 vertical = std::abs(forward.z) < 0.9999 ? Vec3(0, 0, 1) : Vec3(0, 1, 0);
  view.right = glm::normalize(glm::cross(forward, vertical));
  view.up = glm::cross(view.right, forward);
}

/// For points in camera axes: the largest of x - tan z and of -x - tan z give how far the camera must be back, and where its
/// axis must pass, so that all lie between its two planes.
struct Wedge {
  double tan = 0, plus = -kInfinity, minus = -kInfinity;
  void add(double x, double z) {
    plus = std::max(plus, x - tan * z);
    minus = std::max(minus, -x - tan * z);
  }
  double distance() const { return 0.5 * (plus + minus) / tan; }
  double center() const { return 0.5 * (plus - minus); }
};

}  // namespace

Ray View::ray(double x, double y) const {
  const double sx = (2 * x / width - 1) * tan_x, sy = (1 - 2 * y / height) * tan_y;
  return {eye, glm::normalize(forward + sx * right + sy * up)};
}

View frame(const Camera& camera, std::span<const Box> boxes, int width, int height) {
  View view;
  view.width = width;
  view.height = height;
  view.tan_y = std::tan(0.5 * std::clamp(camera.field_of_view, 1e-3, 3.0));
  view.tan_x = view.tan_y * width / height;

  const Box unit{Vec3(-0.5), Vec3(0.5)};
  std::span<const Box> framed = boxes;
  if (camera.frame && !camera.frame->empty()) framed = {&*camera.frame, 1};
  if (framed.empty()) framed = {&unit, 1};
  Box whole;
  for (const Box& box : framed) whole.extend(box);

  if (camera.eye) {
    const Vec3 towards = camera.target.value_or(whole.center()) - *camera.eye;
    const double length = glm::length(towards);
    orient(view, length > 0 ? towards / length : Vec3(0, 1, 0));
    view.eye = *camera.eye;
    return view;
  }
  const double flat = std::cos(camera.elevation);
  orient(view, -Vec3(flat * std::cos(camera.azimuth), flat * std::sin(camera.azimuth), std::sin(camera.elevation)));
  const double margin = std::max(1e-3, camera.margin);
  Wedge across{view.tan_x / margin}, upright{view.tan_y / margin};
  const Vec3 origin = camera.target.value_or(whole.center());
  for (const Box& box : framed) {
    for (int corner = 0; corner < 8; ++corner) {
      const Vec3 p{corner & 1 ? box.hi.x : box.lo.x, corner & 2 ? box.hi.y : box.lo.y, corner & 4 ? box.hi.z : box.lo.z};
      const Vec3 q = p - origin;
      across.add(glm::dot(q, view.right), glm::dot(q, view.forward));
      upright.add(glm::dot(q, view.up), glm::dot(q, view.forward));
    }
  }
  if (camera.target) {  // it stays in the middle: each side must fit by itself
    const double distance = std::max({across.plus, across.minus}) / across.tan;
    view.eye = origin - std::max(distance, std::max(upright.plus, upright.minus) / upright.tan) * view.forward;
    return view;
  }
  const double distance = std::max(across.distance(), upright.distance());
  view.eye = origin + across.center() * view.right + upright.center() * view.up - distance * view.forward;
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
