// Meshes whose every property is known.
#pragma once

#include "polygonize/mesh.h"

#include <cmath>
#include <map>
#include <numbers>

namespace cambium::testing {

/// An octahedron, every triangle cut in four `rounds` times, its vertices at `radius` from `center`.
inline Mesh ball_mesh(int rounds, double radius, const Vec3& center = Vec3(0)) {
  Mesh mesh;
  mesh.positions = {{1, 0, 0}, {-1, 0, 0}, {0, 1, 0}, {0, -1, 0}, {0, 0, 1}, {0, 0, -1}};
  mesh.triangles = {{0, 2, 4}, {2, 1, 4}, {1, 3, 4}, {3, 0, 4}, {2, 0, 5}, {1, 2, 5}, {3, 1, 5}, {0, 3, 5}};
  for (int round = 0; round < rounds; ++round) {
    std::map<std::array<std::uint32_t, 2>, std::uint32_t> middles;
    const auto middle = [&](std::uint32_t a, std::uint32_t b) {
      const auto [at, fresh] = middles.try_emplace({std::min(a, b), std::max(a, b)}, static_cast<std::uint32_t>(mesh.positions.size()));
      if (fresh) mesh.positions.push_back(glm::normalize(mesh.positions[a] + mesh.positions[b]));
      return at->second;
    };
    std::vector<std::array<std::uint32_t, 3>> finer;
    for (const auto& [a, b, c] : mesh.triangles) {
      const std::uint32_t ab = middle(a, b), bc = middle(b, c), ca = middle(c, a);
      for (const auto& t : {std::array{a, ab, ca}, {ab, b, bc}, {ca, bc, c}, {ab, bc, ca}}) finer.push_back(t);
    }
    mesh.triangles = std::move(finer);
  }
  for (Vec3& p : mesh.positions) p = center + radius * p;
  return mesh;
}

/// A torus around the z axis of n x m quads.
inline Mesh ring_mesh(std::uint32_t n, std::uint32_t m, double radius, double thickness) {
  Mesh mesh;
  const double turn = 2 * std::numbers::pi;
  for (std::uint32_t i = 0; i < n; ++i) {
    for (std::uint32_t j = 0; j < m; ++j) {
      const double a = turn * i / n, b = turn * j / m, r = radius + thickness * std::cos(b);
      mesh.positions.emplace_back(r * std::cos(a), r * std::sin(a), thickness * std::sin(b));
      const auto at = [&](std::uint32_t k, std::uint32_t l) { return (k % n) * m + l % m; };
      mesh.triangles.push_back({at(i, j), at(i + 1, j), at(i + 1, j + 1)});
      mesh.triangles.push_back({at(i, j), at(i + 1, j + 1), at(i, j + 1)});
    }
  }
  return mesh;
}

/// Both, as one mesh of separate parts.
inline Mesh joined(Mesh a, const Mesh& b) {
  const auto first = static_cast<std::uint32_t>(a.positions.size());
  a.positions.insert(a.positions.end(), b.positions.begin(), b.positions.end());
  for (const auto& t : b.triangles) a.triangles.push_back({t[0] + first, t[1] + first, t[2] + first});
  return a;
}

}  // namespace cambium::testing
