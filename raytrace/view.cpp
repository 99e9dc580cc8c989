#include "raytrace/view.h"

#include "raytrace/unit_disc.h"

#include <algorithm>
#include <cmath>

namespace cambium {
namespace {

constexpr double kFilmSide = 0.036;       // metres, of the picture's longer side
constexpr double kNearestFocus = 1e-5;

Vec3 turned_about_z(const Vec3& v, double angle) {
  const double c = std::cos(angle), s = std::sin(angle);
  return {c * v.x - s * v.y, s * v.x + c * v.y, v.z};
}

}  // namespace

Ray View::ray(double x, double y) const {
  const double sx = (2 * x / width - 1) * tan_x, sy = (1 - 2 * y / height) * tan_y;
  return {eye, glm::normalize(forward + sx * right + sy * up)};
}

Ray View::ray(double x, double y, const std::array<double, 2>& sample) const {
  if (!(lens_radius > 0)) return ray(x, y);
  const double sx = (2 * x / width - 1) * tan_x, sy = (1 - 2 * y / height) * tan_y;
  const auto [dx, dy] = unit_disc(sample);
  const Vec3 offset = lens_radius * (dx * right + dy * up);
  return {eye + offset, glm::normalize(focus_distance * (forward + sx * right + sy * up) - offset)};
}

void View::look_along(const Vec3& direction) {
  const double length = glm::length(direction);
  forward = length > 0 ? direction / length : Vec3(0, 1, 0);
  const Vec3 vertical = std::abs(forward.z) < 0.9999 ? Vec3(0, 0, 1) : Vec3(0, 1, 0);
  right = glm::normalize(glm::cross(forward, vertical));
  up = glm::cross(right, forward);
}

View View::turned(const Vec3& center, double angle) const {
  View out = *this;
  out.eye = center + turned_about_z(eye - center, angle);
  out.forward = turned_about_z(forward, angle);
  out.right = turned_about_z(right, angle);
  out.up = turned_about_z(up, angle);
  return out;
}

View lens_of(const Camera& camera, int width, int height) {
  View view;
  view.width = width;
  view.height = height;
  const double longer = std::max(width, height);
  if (camera.focal_length) {
    view.tan_y = 0.5 * kFilmSide / *camera.focal_length * height / longer;
  } else {
    view.tan_y = std::tan(0.5 * std::clamp(camera.field_of_view, 1e-3, 3.0));
  }
  view.tan_x = view.tan_y * width / height;
  const double focal_length = camera.focal_length.value_or(0.5 * kFilmSide * height / (longer * view.tan_y));
  view.lens_radius = 0.5 * focal_length / camera.f_number;
  return view;
}

void focus(View& view, const Camera& camera, const Vec3& otherwise) {
  const double through = glm::dot(camera.focus.value_or(otherwise) - view.eye, view.forward);
  view.focus_distance = std::max(kNearestFocus, camera.focus_distance.value_or(through));
}

}  // namespace cambium
