#include "polygonize/mesh_distance.h"

#include <algorithm>
#include <cmath>

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

MeshDistance::MeshDistance(const Mesh& mesh)
    : mesh_(mesh), tree_(mesh.triangles.size(), [&](std::uint32_t i) {
        Box box;
        for (const std::uint32_t v : mesh.triangles[i]) box.extend(mesh.positions[v]);
        return box;
      }) {}

double MeshDistance::operator()(const Vec3& p, double hint) const {
  const double bound = std::isfinite(hint) ? hint * hint * (1 + 1e-12) + 1e-300 : kInfinity;
  return std::sqrt(tree_.nearest2(p, bound, [&](std::uint32_t i) {
    const auto& t = mesh_.triangles[i];
    return distance2_to_triangle(p, mesh_.positions[t[0]], mesh_.positions[t[1]], mesh_.positions[t[2]]);
  }));
}

}  // namespace cambium
