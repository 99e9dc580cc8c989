#include "skeletons/graph/node_graph.h"

#include "blobtree/input_error.h"

#include <cmath>
#include <numbers>
#include <string>

namespace cambium {
namespace {

/// In the order of yao_octant.
std::vector<Vec3> cube_corners() {
  std::vector<Vec3> corners;
  for (int i = 0; i < 8; ++i) corners.push_back({i & 1 ? -1 : 1, i & 2 ? -1 : 1, i & 4 ? -1 : 1});
  return corners;
}

std::vector<Vec3> cube_faces() { return {{1, 0, 0}, {-1, 0, 0}, {0, 1, 0}, {0, -1, 0}, {0, 0, 1}, {0, 0, -1}}; }

/// (0, +-a, +-b) and those with the coordinates moved on by one and by two.
void add_golden_rectangles(double a, double b, std::vector<Vec3>& corners) {
  for (int turn = 0; turn < 3; ++turn)
    for (int i = 0; i < 4; ++i) {
      const double p[3] = {0, i & 1 ? -a : a, i & 2 ? -b : b};
      corners.push_back({p[(3 - turn) % 3], p[(4 - turn) % 3], p[(5 - turn) % 3]});
    }
}

std::vector<Vec3> icosahedron_corners() {
  std::vector<Vec3> corners;
  add_golden_rectangles(1, std::numbers::phi, corners);
  return corners;
}

std::vector<Vec3> dodecahedron_corners() {
  std::vector<Vec3> corners = cube_corners();
  add_golden_rectangles(1 / std::numbers::phi, std::numbers::phi, corners);
  return corners;
}

/// Evenly spread along z, each a golden angle on from the one before.
std::vector<Vec3> spiral(int count) {
  const double golden_angle = 2 * std::numbers::pi * (2 - std::numbers::phi);
  std::vector<Vec3> places;
  for (int i = 0; i < count; ++i) {
    const double z = 1 - (2 * i + 1.0) / count, across = std::sqrt(1 - z * z);
    places.push_back({across * std::cos(golden_angle * i), across * std::sin(golden_angle * i), z});
  }
  return places;
}

std::vector<Vec3> places_of(int sectors) {
  switch (sectors) {
    case 4: return {{1, 1, 1}, {1, -1, -1}, {-1, 1, -1}, {-1, -1, 1}};
    case 6: return cube_faces();
    case 8: return cube_corners();
    case 12: return icosahedron_corners();
    case 20: return dodecahedron_corners();
    default: return spiral(sectors);
  }
}

}  // namespace

std::vector<Vec3> yao_directions(int sectors) {
  if (sectors < 4 || sectors > 64) throw InputError({}, "sectors = " + std::to_string(sectors), "4 to 64");
  std::vector<Vec3> directions = places_of(sectors);
  for (Vec3& direction : directions) direction = glm::normalize(direction);
  return directions;
}

int yao_sector(std::span<const Vec3> directions, const Vec3& v) {
  if (directions.size() == 8) return static_cast<int>(yao_octant(v));
  int best = 0;
  double most = -kInfinity;
  for (std::size_t i = 0; i < directions.size(); ++i)
    if (const double along = glm::dot(directions[i], v); along > most) most = along, best = static_cast<int>(i);
  return best;
}

}  // namespace cambium
