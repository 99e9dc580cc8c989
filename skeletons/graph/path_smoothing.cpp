#include "skeletons/graph/path_smoothing.h"

namespace cambium {
namespace {

constexpr std::uint32_t kNone = ~std::uint32_t{0};

/// Of each node the child on the longest way onward; kNone at ends.
std::vector<std::uint32_t> children_onward(std::span<const Vec3> positions, std::span<const std::uint32_t> parents) {
  std::vector<double> onward(positions.size(), 0.0);
  std::vector<std::uint32_t> child(positions.size(), kNone);
  for (std::size_t i = positions.size(); i-- > 1;) {
    const std::uint32_t parent = parents[i];
    if (parent == i) continue;
    const double way = onward[i] + glm::length(positions[i] - positions[parent]);
    if (child[parent] == kNone || way > onward[parent]) onward[parent] = way, child[parent] = static_cast<std::uint32_t>(i);
  }
  return child;
}

}  // namespace

void smooth_paths(std::vector<Vec3>& positions, std::span<const std::uint32_t> parents, const std::vector<bool>& fixed,
                  const Obstacles* obstacles, int passes) {
  const auto child = children_onward(positions, parents);
  std::vector<Vec3> moved(positions);
  for (int pass = 0; pass < passes; ++pass) {
    for (std::size_t i = 0; i < positions.size(); ++i) {
      if (fixed[i] || child[i] == kNone || parents[i] == i) continue;
      const Vec3 to = 0.5 * positions[i] + 0.25 * (positions[parents[i]] + positions[child[i]]);
      moved[i] = obstacles && obstacles->holds(to) ? positions[i] : to;
    }
    positions = moved;
  }
}

}  // namespace cambium
