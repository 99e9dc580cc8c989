#include "lsystem/turtle.h"

#include <cmath>
#include <initializer_list>

namespace cambium {
namespace {

// Rotation in the plane of two axes by which `from` goes towards `to`.
void rotate(Vec3& from, Vec3& to, double radians) {
  const double c = std::cos(radians);
  const double s = std::sin(radians);
  const Vec3 before = from;
  from = c * from + s * to;
  to = c * to - s * before;
}

}  // namespace

void TurtleFrame::yaw(double radians) { rotate(heading, left, radians); }
void TurtleFrame::pitch(double radians) { rotate(heading, up, radians); }
void TurtleFrame::roll(double radians) { rotate(left, up, radians); }

void TurtleFrame::turn_back() {
  heading = -heading;
  left = -left;
}

// ABOP (1.6): L = V x H / |V x H|, with V the direction opposite to gravity.
void TurtleFrame::level() {
  const Vec3 across = glm::cross(Vec3(0, 0, 1), heading);
  const double length = glm::length(across);
  if (length < 1e-9) return;
  left = across / length;
  up = glm::cross(left, heading);
}

void TurtleFrame::bend(const Vec3& tropism, double elasticity) {
  const Vec3 torque = glm::cross(heading, tropism);
  const double strength = glm::length(torque);
  const double angle = elasticity * strength;
  if (!(strength > 0) || angle == 0 || !std::isfinite(angle)) return;
  const Vec3 axis = torque / strength;
  const double c = std::cos(angle);
  const double s = std::sin(angle);
  for (Vec3* v : {&heading, &left, &up})
    *v = c * *v + s * glm::cross(axis, *v) + (1 - c) * glm::dot(axis, *v) * axis;
  restore_orthonormality();
}

bool TurtleFrame::orient(const Vec3& new_heading, const Vec3* new_up) {
  const double length = glm::length(new_heading);
  if (!(length > 0) || !std::isfinite(length)) return false;
  const Vec3 h = new_heading / length;
  const Vec3 wanted = new_up ? *new_up : up;
  Vec3 across = glm::cross(h, wanted);
  if (!new_up && glm::length(across) < 1e-9) across = glm::cross(h, heading);
  if (!(glm::length(across) > 1e-9 * glm::length(wanted)) || !std::isfinite(glm::length(across))) return false;
  heading = h;
  left = glm::normalize(across);
  up = glm::cross(left, heading);
  return true;
}

void TurtleFrame::restore_orthonormality() {
  heading = glm::normalize(heading);
  left = glm::normalize(left - glm::dot(left, heading) * heading);
  up = glm::cross(left, heading);
}

}  // namespace cambium
