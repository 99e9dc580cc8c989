#include "skeletons/graph/thickness.h"

#include <gtest/gtest.h>

#include <cmath>

namespace cambium {
namespace {

/// A trunk of 4 m with an endpoint of level 1 at its top; from there a twig of 1 m with one of level 2, and one of 3 m besides from
/// half-way up.
struct Tree {
  std::vector<Vec3> positions = {{0, 0, 0}, {0, 0, 2}, {0, 0, 4}, {0, 0, 5}, {3, 0, 2}};
  std::vector<std::uint32_t> parents = {0, 0, 1, 2, 1};
  std::vector<std::uint32_t> endpoints = {2, 3, 4};
  std::vector<std::uint8_t> levels = {1, 2, 2};

  PathRadii both(const GraphThickness& thickness, std::vector<double> zetas) const {
    return path_radii({positions, parents, endpoints, levels}, thickness, zetas);
  }
  std::vector<double> radii(const GraphThickness& thickness, std::vector<double> zetas) const { return both(thickness, zetas).tip; }
};

TEST(Thickness, IsAPowerOfTheLongestWayOn) {
  const auto r = Tree().radii({.trunk_radius = 0.2, .unit = 1, .every_level = false}, {0.6, 0.5});
  const double scale = 0.2 / std::sqrt(5.0);
  EXPECT_DOUBLE_EQ(r[0], 0.2);
  EXPECT_DOUBLE_EQ(r[1], scale * std::sqrt(3.0));
  EXPECT_DOUBLE_EQ(r[2], scale);
  EXPECT_DOUBLE_EQ(r[3], 0.001);
  EXPECT_DOUBLE_EQ(r[4], 0.001);
}

TEST(Thickness, OfALateralBeginsWithItsOwnWay) {
  const auto base = Tree().both({.trunk_radius = 0.2, .unit = 1, .every_level = false}, {0.6, 0.5}).base;
  const double scale = 0.2 / std::sqrt(5.0);
  EXPECT_DOUBLE_EQ(base[1], 0.2);
  EXPECT_DOUBLE_EQ(base[2], scale * std::sqrt(3.0)) << "the same way on as the lateral's, which is 3 m long";
  EXPECT_DOUBLE_EQ(base[4], scale * std::sqrt(3.0));
  EXPECT_DOUBLE_EQ(base[3], scale);
}

TEST(Thickness, IsTheLargestThatAnyLevelAsksFor) {
  const auto r = Tree().radii({.trunk_radius = 0.2, .unit = 1}, {1.0, 0.5});
  const double scale = 0.2 / 4;                         // level 1: 4 m to the power of 1, level 2: the root of 5 m
  EXPECT_DOUBLE_EQ(r[0], 0.2);
  EXPECT_DOUBLE_EQ(r[1], scale * 2);                    // of 2 and the root of 3
  EXPECT_DOUBLE_EQ(r[2], scale);
}

TEST(Thickness, DoesNotDependOnTheSizeOfTheTreeWhereNoUnitIsSet) {
  Tree tree;
  const auto before = tree.radii({}, {0.6, 0.3});
  for (Vec3& p : tree.positions) p *= 100.0;
  const auto after = tree.radii({}, {0.6, 0.3});
  for (std::size_t i = 0; i < before.size(); ++i) EXPECT_NEAR(before[i], after[i], 1e-15);
}

TEST(Thickness, OfPipesAddsUpAtForks) {
  const auto r = Tree().radii({.rule = ThicknessRule::kPipe, .trunk_radius = 0.2, .exponent = 2.0}, {0.3});
  EXPECT_DOUBLE_EQ(r[1], 0.2);
  EXPECT_DOUBLE_EQ(r[1] * r[1], r[2] * r[2] + r[4] * r[4]);
  EXPECT_DOUBLE_EQ(r[2], r[3]);
}

TEST(Thickness, OfPipesMeetsTipsAndTrunkWhereNoExponentIsSet) {
  const auto r = Tree().radii({.rule = ThicknessRule::kPipe, .trunk_radius = 0.2, .tip_radius = 0.05}, {0.3});
  EXPECT_NEAR(r[0], 0.2, 1e-15);
  EXPECT_NEAR(r[3], 0.05, 1e-15);
  EXPECT_NEAR(r[4], 0.05, 1e-15);
}

}  // namespace
}  // namespace cambium
