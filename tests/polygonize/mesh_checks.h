// What a closed 2-manifold mesh must satisfy, found out the slow and plain way.
#pragma once

#include "polygonize/mesh.h"

#include <algorithm>
#include <cmath>
#include <cstdint>
#include <numeric>
#include <ostream>
#include <unordered_map>
#include <vector>

namespace cambium::testing {

struct MeshChecks {
  std::size_t unpaired_edges = 0;        ///< directed edges without exactly one opposite
  std::size_t repeated_edges = 0;        ///< directed edges used more than once
  std::size_t split_vertices = 0;        ///< vertices whose triangles are not one fan
  std::size_t unused_vertices = 0;
  std::size_t degenerate_triangles = 0;  ///< repeated corner or zero area
  std::size_t components = 0;
  std::size_t inward_components = 0;     ///< negative volume (a void, or wrongly wound)
  long euler = 0;                        ///< V - E + F
  double volume = 0;
  double smallest_sine = 1;              ///< of any triangle's angle

  bool closed_manifold() const {
    return unpaired_edges == 0 && repeated_edges == 0 && split_vertices == 0 && unused_vertices == 0;
  }
};

inline std::ostream& operator<<(std::ostream& out, const MeshChecks& c) {
  return out << "unpaired " << c.unpaired_edges << ", repeated " << c.repeated_edges << ", split vertices " << c.split_vertices
             << ", unused " << c.unused_vertices << ", degenerate " << c.degenerate_triangles << ", components "
             << c.components << " (" << c.inward_components << " inward), euler " << c.euler << ", volume " << c.volume;
}

/// areas = false for connectivity alone (positions may then be missing).
inline MeshChecks check_mesh(const Mesh& mesh, bool areas = true, std::size_t vertex_count = 0) {
  MeshChecks checks;
  const std::size_t vertices = areas ? mesh.positions.size() : vertex_count;
  const auto key = [](std::uint64_t a, std::uint64_t b) { return a << 32 | b; };
  std::unordered_map<std::uint64_t, std::uint32_t> uses;   // directed edge -> times
  uses.reserve(mesh.triangles.size() * 3);
  std::vector<std::uint32_t> parent(vertices);
  std::iota(parent.begin(), parent.end(), 0u);
  const auto root = [&](std::uint32_t v) {
    while (parent[v] != v) v = parent[v] = parent[parent[v]];
    return v;
  };
  std::vector<std::vector<std::array<std::uint32_t, 2>>> opposite(vertices);   // per vertex: the far edges of its triangles
  for (const auto& t : mesh.triangles) {
    if (t[0] == t[1] || t[1] == t[2] || t[2] == t[0]) ++checks.degenerate_triangles;
    for (int i = 0; i < 3; ++i) {
      ++uses[key(t[i], t[(i + 1) % 3])];
      opposite[t[i]].push_back({t[(i + 1) % 3], t[(i + 2) % 3]});
      parent[root(t[i])] = root(t[(i + 1) % 3]);
    }
    if (!areas) continue;
    const Vec3 a = mesh.positions[t[0]], b = mesh.positions[t[1]], c = mesh.positions[t[2]];
    const double doubled_area = glm::length(glm::cross(b - a, c - a));
    const double longest = std::max({glm::length(b - a), glm::length(c - b), glm::length(a - c)});
    if (!(doubled_area > 1e-9 * longest * longest)) ++checks.degenerate_triangles;
    checks.smallest_sine = std::min(checks.smallest_sine, doubled_area / (longest * longest));
  }
  for (const auto& [edge, count] : uses) {
    if (count > 1) ++checks.repeated_edges;
    const auto back = uses.find(key(edge & 0xffffffffu, edge >> 32));
    if (back == uses.end() || back->second != count) ++checks.unpaired_edges;
  }
  for (const auto& fan : opposite) {
    if (fan.empty()) {
      ++checks.unused_vertices;
      continue;
    }
    std::size_t walked = 0;
    std::uint32_t at = fan[0][0];
    do {   // from spoke to spoke; a single fan takes exactly fan.size() steps to come back
      const auto next = std::find_if(fan.begin(), fan.end(), [&](const auto& e) { return e[0] == at; });
      if (next == fan.end()) break;
      at = (*next)[1];
      ++walked;
    } while (at != fan[0][0] && walked <= fan.size());
    if (walked != fan.size() || at != fan[0][0]) ++checks.split_vertices;
  }
  checks.euler = static_cast<long>(vertices) - static_cast<long>(uses.size() / 2) + static_cast<long>(mesh.triangles.size());
  std::unordered_map<std::uint32_t, double> volumes;
  for (const auto& t : mesh.triangles) {
    double& volume = volumes[root(t[0])];
    if (areas) volume += glm::dot(mesh.positions[t[0]], glm::cross(mesh.positions[t[1]], mesh.positions[t[2]])) / 6;
  }
  checks.components = volumes.size();
  for (const auto& [id, volume] : volumes) {
    checks.volume += volume;
    if (areas && volume <= 0) ++checks.inward_components;
  }
  return checks;
}

}  // namespace cambium::testing
