// Skeletons of any size, as a generator would grow them, with radii after the pipe model.
#pragma once

#include "skeletons/skeleton.h"

#include <cmath>
#include <cstdint>
#include <vector>

namespace cambium {

/// Which node bears an internode, and whether it starts a lateral there.
struct GrownInternode {
  std::int32_t parent = -1;
  bool lateral = false;
};

/// Deterministic draws in [0, 1).
class GrowthDraws {
 public:
  double next() {
    state_ = state_ * 6364136223846793005u + 1442695040888963407u;
    return static_cast<double>(state_ >> 11) * 0x1p-53;
  }

 private:
  std::uint64_t state_ = 7;
};

/// Positions for a topology: internodes of 2 cm and three radii, laterals at 40 degrees, axes that wander by up to 12.
inline Skeleton grow(const std::vector<GrownInternode>& internodes) {
  Skeleton s;
  std::vector<double> section(internodes.size(), 0);
  std::vector<Vec3> direction(internodes.size(), Vec3(0, 0, 1));
  for (std::size_t i = internodes.size(); i-- > 0;) {
    if (section[i] == 0) section[i] = 1e-6;  // a tip is 1 mm thick
    if (internodes[i].parent >= 0) section[internodes[i].parent] += section[i];
  }
  GrowthDraws draws;
  for (std::size_t i = 0; i < internodes.size(); ++i) {
    SkeletonNode node;
    node.parent = internodes[i].parent;
    node.radius = std::sqrt(section[i]);
    if (node.parent >= 0) {
      const Vec3 along = direction[node.parent];
      const Vec3 any(draws.next() - 0.5, draws.next() - 0.5, draws.next() - 0.5);
      const Vec3 across = glm::normalize(any - glm::dot(any, along) * along);
      const double angle = internodes[i].lateral ? 0.7 : 0.2 * draws.next();
      direction[i] = std::cos(angle) * along + std::sin(angle) * across;
      node.position = s.nodes[node.parent].position + (0.02 + 3 * node.radius) * direction[i];
      node.lateral = internodes[i].lateral;
    }
    s.nodes.push_back(node);
  }
  return s;
}

inline Skeleton grown_axis(std::int32_t internodes) {
  std::vector<GrownInternode> all{{}};
  for (std::int32_t i = 1; i <= internodes; ++i) all.push_back({i - 1, false});
  return grow(all);
}

/// Every internode bears two: an axis has two internodes on average.
inline Skeleton grown_binary_tree(std::int32_t internodes) {
  std::vector<GrownInternode> all{{}};
  for (std::int32_t i = 1; i <= internodes; ++i) all.push_back({i / 2, i > 1 && i % 2 == 1});
  return grow(all);
}

/// Axes of 4 to 8 internodes, breadth first; half of the nodes of an axis bear another.
inline Skeleton grown_branches(std::size_t internodes) {
  std::vector<GrownInternode> all{{}};
  std::vector<std::int32_t> bearing;
  GrowthDraws draws;
  for (std::size_t axis = 0; all.size() <= internodes; ++axis) {
    std::int32_t at = axis == 0 ? 0 : bearing[axis - 1];
    const int count = 4 + static_cast<int>(5 * draws.next());
    for (int i = 0; i < count; ++i) {
      all.push_back({at, axis > 0 && i == 0});
      at = static_cast<std::int32_t>(all.size()) - 1;
      if (i == 0 || (i + 1 < count && draws.next() < 0.5)) bearing.push_back(at);
    }
  }
  return grow(all);
}

}  // namespace cambium
