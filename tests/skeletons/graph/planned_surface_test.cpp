// Trees planned on graphs whose steps are shorter than the trunk's radius, surfaced (field.md section 6, conditioning).
#include "blobtree/field.h"
#include "skeletons/axes.h"
#include "skeletons/graph/plan.h"
#include "skeletons/surface.h"

#include <gtest/gtest.h>

#include <cmath>

namespace cambium {
namespace {

/// A trunk of 45 cm through nodes 7 cm from each other, to one endpoint 5 m up.
GraphOptions lone_trunk(std::uint64_t seed) {
  GraphOptions options;
  options.volume = {PlacedSolid{.solid = CylinderSolid{0.7, 5}}};
  options.levels.resize(1);
  options.levels[0].nodes = 12'000;
  options.levels[0].spacing = 0.07;
  options.levels[0].endpoints = {0, 0};
  options.levels[0].given_endpoints = {{0.1, 0.2, 5}};
  options.thickness.trunk_radius = 0.45;
  options.seed = seed;
  return options;
}

/// How far from p along d, unit, the surface is. Precondition: p is inside, p + most * d outside.
double reach(const Field& field, const Vec3& p, const Vec3& d, double most) {
  double inside = 0, outside = most;
  for (int i = 0; i < 40; ++i) {
    const double middle = 0.5 * (inside + outside);
    (field.value(p + middle * d) > kIso ? inside : outside) = middle;
  }
  return inside;
}

TEST(PlannedSurface, HasTheTrunksRadiusAllAlongAndNoKnuckles) {
  for (const std::uint64_t seed : {1, 2, 3, 4, 5}) {
    const Skeleton skeleton = plan_tree(lone_trunk(seed)).value().skeleton;
    ASSERT_GT(skeleton.nodes.size(), 40u) << "steps of a quarter of the radius";
    const Surfaced made = surface(skeleton, {});
    const Field field(made.tree);
    const Chain chain = made.tree.get<Chain>(made.tree.root());
    for (std::size_t i = 1; i + 1 < chain.nodes.size(); ++i) {
      const auto& node = chain.nodes[i];
      const Vec3 in = glm::normalize(node.position - chain.nodes[i - 1].position);
      const Vec3 out = glm::normalize(chain.nodes[i + 1].position - node.position);
      EXPECT_LE(std::acos(std::min(1.0, glm::dot(in, out))), 5.001 * std::numbers::pi / 180);
      if (node.radius < 0.25) continue;   // towards the tip it is a steep cone, wider across than its balls
      const Vec3 side = across(glm::normalize(in + out), {1, 0, 0}), other = glm::cross(glm::normalize(in + out), side);
      for (int k = 0; k < 12; ++k) {
        const double angle = k * std::numbers::pi / 6;
        const double wide = reach(field, node.position, std::cos(angle) * side + std::sin(angle) * other, 2 * node.radius) / node.radius;
        EXPECT_GT(wide, 0.97) << "seed " << seed << ", node " << i;
        EXPECT_LT(wide, 1.12) << "seed " << seed << ", node " << i;
      }
    }
  }
}

}  // namespace
}  // namespace cambium
