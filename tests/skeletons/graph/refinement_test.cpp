#include "skeletons/graph/refinement.h"

#include "blobtree/input_error.h"

#include <gtest/gtest.h>

#include <algorithm>

namespace cambium {
namespace {

constexpr double kPi = std::numbers::pi;

/// A trunk of 2 m with a crown of 2 m radius on it.
std::vector<PlacedSolid> mushroom() {
  return {{.solid = CylinderSolid{0.2, 2}, .endpoints = false, .part = 3}, {.solid = BallSolid{2, kPi / 2}, .origin = {0, 0, 2}}};
}

struct Parts {
  std::vector<PlacedSolid> spheres, cones, trunk;
};

Parts parts_of(const std::vector<PlacedSolid>& solids) {
  Parts parts;
  for (const PlacedSolid& placed : solids) {
    if (placed.part == 0) parts.trunk.push_back(placed);
    else if (std::holds_alternative<BallSolid>(placed.solid)) parts.spheres.push_back(placed);
    else parts.cones.push_back(placed);
  }
  return parts;
}

double radius_of(const PlacedSolid& sphere) { return std::get<BallSolid>(sphere.solid).radius; }

TEST(Refinement, FillsTheCrownWithSpheresThatDoNotOverlapAndKeepsTheTrunk) {
  for (std::uint64_t seed = 0; seed < 20; ++seed) {
    const Parts parts = parts_of(refined(mushroom(), {}, {0, 0, 0}, nullptr, seed));
    ASSERT_EQ(parts.trunk.size(), 1u);
    EXPECT_EQ(std::get<CylinderSolid>(parts.trunk[0].solid).height, 2);
    EXPECT_FALSE(parts.trunk[0].endpoints);
    EXPECT_GE(parts.spheres.size(), 4u);
    EXPECT_LE(parts.spheres.size(), 7u);
    for (std::size_t i = 0; i < parts.spheres.size(); ++i) {
      EXPECT_EQ(parts.spheres[i].part, i + 1);
      EXPECT_TRUE(parts.spheres[i].endpoints);
      EXPECT_TRUE(contains(BallSolid{2, kPi / 2}, parts.spheres[i].origin - Vec3{0, 0, 2}));
      for (std::size_t k = 0; k < i; ++k)
        EXPECT_GE(glm::distance(parts.spheres[i].origin, parts.spheres[k].origin),
                  (radius_of(parts.spheres[i]) + radius_of(parts.spheres[k])) * (1 - 1e-12));
    }
  }
}

TEST(Refinement, ConesLeadFromTheTrunkIntoTheirSpheresAndBearNoEndpoints) {
  for (std::uint64_t seed = 0; seed < 20; ++seed) {
    const std::vector<PlacedSolid> solids = refined(mushroom(), {.spheres = 10}, {0, 0, 0}, nullptr, seed);
    const Parts parts = parts_of(solids);
    EXPECT_GE(parts.cones.size() + 1, parts.spheres.size());
    for (const PlacedSolid& cone : parts.cones) {
      EXPECT_FALSE(cone.endpoints);
      const PlacedSolid& sphere = parts.spheres[cone.part - 1u];
      const ConeSolid& shape = std::get<ConeSolid>(cone.solid);
      EXPECT_TRUE(contains(CylinderSolid{0.2, 2}, cone.origin)) << "it begins in the trunk";
      const Vec3 lid = cone.origin + shape.height * glm::normalize(cone.axis);
      EXPECT_NEAR(std::hypot(glm::distance(lid, sphere.origin), shape.radius_tip), radius_of(sphere), 1e-9) << "its rim is on the sphere";
      EXPECT_NEAR(shape.radius_tip, 0.5 * radius_of(sphere), 1e-12);
      const Vec3 way = sphere.origin - cone.origin;
      EXPECT_GE(way.z, std::hypot(way.x, way.y) * (1 - 1e-9)) << "it rises";
    }
    // Nothing is missing between a cone's beginning and its sphere.
    const GraphVolume volume(solids);
    for (const PlacedSolid& sphere : parts.spheres)
      for (const PlacedSolid& cone : parts.cones)
        for (int i = 0; i <= 100 && cone.part == sphere.part; ++i) EXPECT_TRUE(volume.contains(glm::mix(cone.origin, sphere.origin, i / 100.0)));
  }
}

TEST(Refinement, WithoutATrunkConesBeginAtTheRoot) {
  const Vec3 root{5, 5, 0};
  const Parts parts = parts_of(refined({{.solid = CylinderSolid{2, 6}, .origin = {5, 5, 0}}}, {.spheres = 5}, root, nullptr, 1));
  EXPECT_TRUE(parts.trunk.empty());
  EXPECT_FALSE(parts.cones.empty());
  for (const PlacedSolid& cone : parts.cones) EXPECT_EQ(cone.origin, root);
}

TEST(Refinement, RootsAreReachedFromTheTopOfATaprootThatGoesDown) {
  const std::vector<PlacedSolid> below = {{.solid = CylinderSolid{0.1, 2}, .axis = {0, 0, -1}, .endpoints = false},
                                          {.solid = BallSolid{3, kPi / 2}, .axis = {0, 0, -1}}};
  const Parts parts = parts_of(refined(below, {.spheres = 8}, {0, 0, 0}, nullptr, 3));
  ASSERT_FALSE(parts.cones.empty());
  for (const PlacedSolid& cone : parts.cones) {
    const Vec3 way = parts.spheres[cone.part - 1u].origin - cone.origin;
    EXPECT_TRUE(cone.origin.z > -1e-9 || way.z <= -std::hypot(way.x, way.y) * (1 - 1e-9)) << "it goes on down";
  }
}

TEST(Refinement, SpheresAndConesKeepOutOfObstaclesWhereTheyCan) {
  const Obstacles wall({{.solid = CylinderSolid{0.5, 0.4}, .origin = {0.6, 0, 2.6}}}, {{{0, 0, 0}, {1, 0, 0}}});
  std::vector<PlacedSolid> volume = mushroom();
  const Parts parts = parts_of(refined(volume, {.spheres = 8}, {0, 0, 0}, &wall, 5));
  for (const PlacedSolid& sphere : parts.spheres) EXPECT_FALSE(wall.holds(sphere.origin));
}

TEST(Refinement, IsTheSameForTheSameSeedAlone) {
  const auto places = [](std::uint64_t seed) {
    std::vector<double> all;
    for (const PlacedSolid& placed : refined(mushroom(), {}, {0, 0, 0}, nullptr, seed))
      all.insert(all.end(), {placed.origin.x, placed.origin.y, placed.origin.z});
    return all;
  };
  EXPECT_EQ(places(1), places(1));
  EXPECT_NE(places(1), places(2));
}

TEST(Refinement, RefusesWhatFillsNothingByItsKey) {
  const auto refusal = [](const std::vector<PlacedSolid>& volume, const GraphRefinement& refinement) {
    try {
      refined(volume, refinement, {0, 0, 0}, nullptr, 0);
      return std::string("none");
    } catch (const InputError& error) {
      return error.found();
    }
  };
  EXPECT_EQ(refusal(mushroom(), {.spheres = 1}), "spheres = 1");
  EXPECT_EQ(refusal(mushroom(), {.spheres = 65}), "spheres = 65");
  EXPECT_EQ(refusal(mushroom(), {.radius = 0}).substr(0, 10), "radius = 0");
  EXPECT_EQ(refusal(mushroom(), {.radius = NAN}).substr(0, 8), "radius =");
  EXPECT_EQ(refusal(mushroom(), {.cone_radius = 1.5}).substr(0, 13), "cone_radius =");
  EXPECT_EQ(refusal({{.solid = BallSolid{1}, .endpoints = false}}, {}), "no volume that bears endpoints");
}

}  // namespace
}  // namespace cambium
