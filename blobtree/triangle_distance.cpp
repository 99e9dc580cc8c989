#include "blobtree/triangle_distance.h"

#include <algorithm>

namespace cambium {
namespace {

double distance2_to_segment(const Vec3& p, const Vec3& a, const Vec3& b) {
  const Vec3 ab = b - a, ap = p - a;
  const double length2 = glm::dot(ab, ab);
  const double t = length2 > 0 ? std::clamp(glm::dot(ap, ab) / length2, 0.0, 1.0) : 0.0;
  const Vec3 d = ap - t * ab;
  return glm::dot(d, d);
}

}  // namespace

double distance2_to_triangle(const Vec3& p, const Vec3& a, const Vec3& b, const Vec3& c) {
  const Vec3 ab = b - a, ac = c - a, ap = p - a;
  const Vec3 n = glm::cross(ab, ac);
  const double n2 = glm::dot(n, n), longest2 = std::max(glm::dot(ab, ab), glm::dot(ac, ac));
  // Thinner than a millionth of a millionth of its length, its normal is rounding.
  if (n2 > 1e-24 * longest2 * longest2 && glm::dot(glm::cross(ab, ap), n) >= 0 && glm::dot(glm::cross(c - b, p - b), n) >= 0 &&
      glm::dot(glm::cross(ap, ac), n) >= 0) {
    const double height = glm::dot(ap, n);
    return height * height / n2;
  }
  return std::min({distance2_to_segment(p, a, b), distance2_to_segment(p, b, c), distance2_to_segment(p, c, a)});
}

}  // namespace cambium
