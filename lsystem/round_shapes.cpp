#include "lsystem/round_shapes.h"

#include <algorithm>
#include <cmath>
#include <map>
#include <numbers>
#include <utility>

namespace cambium {
namespace {

constexpr int kHalvings = 3;
constexpr std::uint32_t kSides = 32;

using Triangle = std::array<std::uint32_t, 3>;

/// Cuts every triangle into four; what is in the middle of an edge goes out to the sphere.
void halve_edges(OrganShape& sphere) {
  std::map<std::pair<std::uint32_t, std::uint32_t>, std::uint32_t> middles;
  const auto middle = [&](std::uint32_t a, std::uint32_t b) {
    const auto [found, inserted] = middles.emplace(std::minmax(a, b), static_cast<std::uint32_t>(sphere.vertices.size()));
    if (inserted) sphere.vertices.push_back(0.5 * glm::normalize(sphere.vertices[a] + sphere.vertices[b]));
    return found->second;
  };
  std::vector<Triangle> quarters;
  for (const auto& [a, b, c] : sphere.triangles) {
    const std::uint32_t ab = middle(a, b), bc = middle(b, c), ca = middle(c, a);
    quarters.insert(quarters.end(), {Triangle{a, ab, ca}, Triangle{ab, b, bc}, Triangle{ca, bc, c}, Triangle{ab, bc, ca}});
  }
  sphere.triangles = std::move(quarters);
}

}  // namespace

OrganShape unit_sphere() {
  constexpr double r = 0.5;
  OrganShape octahedron{"sphere",
                        {{r, 0, 0}, {-r, 0, 0}, {0, r, 0}, {0, -r, 0}, {0, 0, r}, {0, 0, -r}},
                        {{0, 2, 4}, {2, 1, 4}, {1, 3, 4}, {3, 0, 4}, {2, 0, 5}, {1, 2, 5}, {3, 1, 5}, {0, 3, 5}}};
  for (int i = 0; i < kHalvings; ++i) halve_edges(octahedron);
  return octahedron;
}

OrganShape unit_disc() {
  OrganShape disc{"disc", {Vec3(0.0)}, {}};
  for (std::uint32_t i = 0; i < kSides; ++i) {
    const double angle = 2 * std::numbers::pi * i / kSides;
    disc.vertices.push_back({0.5 * std::cos(angle), 0.5 * std::sin(angle), 0});
    disc.triangles.push_back({0, i + 1, (i + 1) % kSides + 1});
  }
  return disc;
}

}  // namespace cambium
