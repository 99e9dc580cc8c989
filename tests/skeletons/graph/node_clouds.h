// Nodes to join, and what is asked of them, the slow way.
#pragma once

#include "skeletons/graph/graph_volume.h"
#include "skeletons/graph/poisson_disc.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <cstdint>
#include <map>
#include <random>
#include <span>
#include <vector>

namespace cambium::testing {

inline RunOptions threads(int count) {
  RunOptions run;
  run.threads = count;
  return run;
}

inline GraphVolume ball(double radius, double angle = std::numbers::pi, const Vec3& axis = {0, 0, 1}) {
  return GraphVolume({PlacedSolid{.solid = BallSolid{radius, angle}, .origin = {2, 1, -3}, .axis = axis}});
}

/// Without any least distance.
inline std::vector<Vec3> random_places(std::size_t count, unsigned seed) {
  std::mt19937_64 random(seed);
  std::uniform_real_distribution<double> unit(0, 1);
  std::vector<Vec3> places;
  for (std::size_t i = 0; i < count; ++i) {
    const double x = unit(random), y = unit(random);
    places.push_back({x, y, unit(random)});
  }
  return places;
}

/// Of all pairs, found by cells of `about`, which no answer exceeds; those of two of the first `given` do not count.
inline double least_distance(std::span<const Vec3> nodes, double about, std::size_t given = 0) {
  using Cell = std::array<long, 3>;
  const auto cell_of = [&](const Vec3& p) { return Cell{std::lround(p.x / about), std::lround(p.y / about), std::lround(p.z / about)}; };
  std::map<Cell, std::vector<std::size_t>> cells;
  for (std::size_t i = 0; i < nodes.size(); ++i) cells[cell_of(nodes[i])].push_back(i);
  double least = about;
  for (std::size_t i = 0; i < nodes.size(); ++i) {
    const Cell c = cell_of(nodes[i]);
    for (int k = 0; k < 27; ++k) {
      const auto found = cells.find({c[0] + k % 3 - 1, c[1] + k / 3 % 3 - 1, c[2] + k / 9 - 1});
      if (found == cells.end()) continue;
      for (const std::size_t j : found->second)
        if (j > i && j >= given) least = std::min(least, std::sqrt(glm::dot(nodes[i] - nodes[j], nodes[i] - nodes[j])));
    }
  }
  return least;
}

}  // namespace cambium::testing
