#include "polygonize/corner_normals.h"

#include <algorithm>
#include <cmath>
#include <numeric>

namespace cambium {
namespace {

struct Corner {
  std::uint32_t triangle = 0;
  std::uint8_t corner = 0;
};

/// The corners at each vertex that lies on a crease.
struct CreaseFans {
  std::vector<std::uint32_t> vertices;   // ascending
  std::vector<std::uint32_t> first;      // into corners; one more than vertices
  std::vector<Corner> corners;
};

CreaseFans crease_fans(const Mesh& mesh) {
  CreaseFans fans;
  constexpr std::uint32_t kNone = 0xffffffffu;
  std::vector<std::uint32_t> fan_of(mesh.positions.size(), kNone);
  for (const auto& edge : mesh.creases)
    for (const std::uint32_t v : edge) fan_of[v] = 0;
  for (std::uint32_t v = 0; v < fan_of.size(); ++v) {
    if (fan_of[v] == kNone) continue;
    fan_of[v] = static_cast<std::uint32_t>(fans.vertices.size());
    fans.vertices.push_back(v);
  }
  std::vector<std::uint32_t> next(fans.vertices.size() + 1, 0);
  const auto for_corners = [&](const auto& visit) {
    for (std::uint32_t t = 0; t < mesh.triangles.size(); ++t)
      for (std::uint8_t c = 0; c < 3; ++c)
        if (const std::uint32_t fan = fan_of[mesh.triangles[t][c]]; fan != kNone) visit(fan, Corner{t, c});
  };
  for_corners([&](std::uint32_t fan, Corner) { ++next[fan + 1]; });
  std::partial_sum(next.begin(), next.end(), next.begin());
  fans.first = next;
  fans.corners.resize(next.back());
  for_corners([&](std::uint32_t fan, Corner corner) { fans.corners[next[fan]++] = corner; });
  return fans;
}

std::uint32_t root_of(std::vector<std::uint32_t>& parents, std::uint32_t i) {
  while (parents[i] != i) i = parents[i] = parents[parents[i]];
  return i;
}

void join(std::vector<std::uint32_t>& parents, std::uint32_t a, std::uint32_t b) {
  a = root_of(parents, a), b = root_of(parents, b);
  parents[std::max(a, b)] = std::min(a, b);
}

glm::dvec3 weighted_normal(const Mesh& mesh, const Corner& at) {
  const auto& t = mesh.triangles[at.triangle];
  const Vec3& p = mesh.positions[t[at.corner]];
  const Vec3 a = mesh.positions[t[(at.corner + 1) % 3]] - p, b = mesh.positions[t[(at.corner + 2) % 3]] - p, n = glm::cross(a, b);
  const double length = glm::length(n);
  return length > 0 ? std::atan2(length, glm::dot(a, b)) / length * n : Vec3(0.0);
}

}  // namespace

CornerNormals corner_normals(const Mesh& mesh) {
  CornerNormals made{mesh.normals, {}};
  if (mesh.creases.empty()) return made;
  made.triangles = mesh.triangles;
  const CreaseFans fans = crease_fans(mesh);
  std::vector<std::uint32_t> side;
  for (std::size_t f = 0; f < fans.vertices.size(); ++f) {
    const std::uint32_t v = fans.vertices[f];
    const Corner* const corners = &fans.corners[fans.first[f]];
    const std::uint32_t count = fans.first[f + 1] - fans.first[f];
    side.resize(count);
    std::iota(side.begin(), side.end(), 0u);
    // A fan is a few triangles: the next of each is looked for among all.
    for (std::uint32_t i = 0; i < count; ++i) {
      const std::uint32_t shared = mesh.triangles[corners[i].triangle][(corners[i].corner + 2) % 3];
      if (std::binary_search(mesh.creases.begin(), mesh.creases.end(), std::array{std::min(v, shared), std::max(v, shared)})) continue;
      for (std::uint32_t k = 0; k < count; ++k)
        if (mesh.triangles[corners[k].triangle][(corners[k].corner + 1) % 3] == shared) join(side, i, k);
    }
    const auto one = [&](std::uint32_t i) { return root_of(side, i) == 0; };
    bool whole = true;
    for (std::uint32_t i = 0; i < count && whole; ++i) whole = one(i);
    if (whole) continue;
    for (std::uint32_t root = 0; root < count; ++root) {
      if (root_of(side, root) != root) continue;
      const std::uint32_t index = root == 0 ? v : static_cast<std::uint32_t>(made.normals.size());
      glm::dvec3 sum(0.0);
      for (std::uint32_t i = root; i < count; ++i) {
        if (root_of(side, i) != root) continue;
        made.triangles[corners[i].triangle][corners[i].corner] = index;
        sum += weighted_normal(mesh, corners[i]);
      }
      const double length = glm::length(sum);
      const glm::vec3 normal = length > 0 ? glm::vec3(sum / length) : mesh.normals[v];
      if (root == 0) made.normals[v] = normal;
      else made.normals.push_back(normal);
    }
  }
  return made;
}

std::vector<std::uint32_t> smoothing_groups(const Mesh& mesh, const CornerNormals& corners) {
  std::vector<std::uint32_t> groups(mesh.triangles.size(), 1);
  if (corners.triangles.empty()) return groups;
  std::vector<std::uint32_t> parents(corners.normals.size());
  std::iota(parents.begin(), parents.end(), 0u);
  for (const auto& t : corners.triangles)
    for (int c = 1; c < 3; ++c) join(parents, t[0], t[c]);
  std::vector<std::uint32_t> number(parents.size(), 0);
  std::uint32_t last = 0;
  for (std::size_t t = 0; t < groups.size(); ++t) {
    std::uint32_t& of_root = number[root_of(parents, corners.triangles[t][0])];
    if (of_root == 0) of_root = ++last;
    groups[t] = of_root;
  }
  return groups;
}

}  // namespace cambium
