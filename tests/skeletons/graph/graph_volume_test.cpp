#include "skeletons/graph/graph_volume.h"

#include "blobtree/input_error.h"
#include "tests/blobtree/random_blobtrees.h"

#include <gtest/gtest.h>

namespace cambium {
namespace {

TEST(GraphVolume, HoldsWhatOneOfItsSolidsHoldsAndNoObstacle) {
  Draws draws(1);
  const auto obstacles = std::make_shared<const Obstacles>(std::vector<PlacedSolid>{{.solid = BallSolid{0.5}, .origin = {0, 0, 2}}},
                                                           std::vector<HalfSpaceObstacle>{{{1, 0, 0}, {-2, 0, 0}}});
  const PlacedSolid stem{.solid = CylinderSolid{0.5, 2}, .endpoints = false}, ball{.solid = BallSolid{1.5}, .origin = {0, 0, 2}};
  const GraphVolume volume({stem, ball}, obstacles);
  for (int i = 0; i < 5000; ++i) {
    const Vec3 p = draws.point({Vec3(-2, -2, -1), Vec3(2, 2, 4)});
    const double across = std::hypot(p.x, p.y), from_crown = glm::length(p - Vec3{0, 0, 2});
    const bool trunk = across <= 0.5 && 0 <= p.z && p.z <= 2, crown = from_crown <= 1.5, blocked = from_crown <= 0.5 || p.x > 1;
    EXPECT_EQ(volume.contains(p), (trunk || crown) && !blocked);
    EXPECT_EQ(volume.bears_endpoints(p), crown && !blocked);
    EXPECT_NEAR(volume.depth(p), crown ? 1.5 - from_crown : 0, 1e-12);
  }
}

TEST(GraphVolume, SolidsAreTurnedScaledAndMovedAlsoUpsideDown) {
  Draws draws(2);
  const Vec3 axes[] = {{0, 0, 1}, {0, 0, -3}, {1e-9, 0, -1}, {3e-6, -1e-6, -1}, {1, 2, 2}, {-2, 0.1, -4}};
  for (const Vec3& axis : axes) {
    const SolidFrame frame(PlacedSolid{.solid = ConeSolid{1, 0, 3}, .origin = {5, 6, 7}, .axis = axis, .scale = 2});
    const Vec3 up = glm::normalize(axis);
    for (int i = 0; i < 500; ++i) {
      const Vec3 local = draws.point({Vec3(-2), Vec3(2)}), p = frame.placed(local);
      EXPECT_LT(glm::length(frame.local(p) - local), 1e-12);
      EXPECT_NEAR(glm::length(p - Vec3{5, 6, 7}), 2 * glm::length(local), 1e-12);
      EXPECT_NEAR(glm::dot(p - Vec3{5, 6, 7}, up), 2 * local.z, 1e-12);
      EXPECT_EQ(frame.contains(p), contains(ConeSolid{1, 0, 3}, frame.local(p)));
    }
    EXPECT_NEAR(frame.depth(Vec3{5, 6, 7} + 0.2 * up), 0.2, 1e-12);
  }
}

TEST(GraphVolume, APlaceIsOfThePartWhoseSolidItIsMostInTheMiddleOf) {
  const GraphVolume volume({{.solid = BallSolid{1}, .part = 1},
                            {.solid = BallSolid{2}, .origin = {2, 0, 0}, .part = 2},
                            {.solid = CylinderSolid{0.01, 0.2}, .origin = {0, 0, -3}, .scale = 30}});
  EXPECT_EQ(volume.parts(), 3u);
  EXPECT_EQ(volume.part_of({-0.8, 0, -0.1}), 1);
  EXPECT_EQ(volume.part_of({0.65, 0, -0.1}), 1) << "0.66 of its radius from one center, 0.68 from the other";
  EXPECT_EQ(volume.part_of({0.69, 0, -0.1}), 2);
  EXPECT_EQ(volume.part_of({-0.01, 0, 2}), 0);
  EXPECT_EQ(volume.part_of({-0.01, 0, 0.8}), 0) << "nearly on the axis, and a fifth of the radius below the sphere's surface";
  EXPECT_EQ(volume.part_of({-0.29, 0, 0.1}), 1);
}

TEST(GraphVolume, AConeIsNotCutThroughByABallInItsWayNorByAnotherCone) {
  const std::vector<PlacedSolid> solids = {{.solid = ConeSolid{0.1, 0.4, 9}, .endpoints = false, .part = 1},
                                           {.solid = BallSolid{2}, .origin = {0.3, 0, 4}, .part = 2},
                                           {.solid = ConeSolid{0.2, 0.8, 6}, .axis = {0.3, 0, 4}, .endpoints = false, .part = 2}};
  const GraphVolume volume(solids);
  for (int i = 1; i < 90; ++i) EXPECT_EQ(volume.part_of({0, 0, 0.1 * i}), 1) << i;
  for (int i = 1; i < 44; ++i) EXPECT_EQ(volume.part_of({0.01 * i, 0, 0.04 / 0.3 * i}), 2) << i;
}

TEST(GraphVolume, RefusesWhatPlacesNothing) {
  const PlacedSolid bad[] = {{.solid = BallSolid{1}, .origin = {NAN, 0, 0}}, {.solid = BallSolid{1}, .axis = {0, 0, 0}},
                             {.solid = BallSolid{1}, .scale = 0},            {.solid = BallSolid{1}, .scale = INFINITY},
                             {.solid = BallSolid{0}},                        {.solid = MeshSolid{}}};
  for (const PlacedSolid& placed : bad) {
    EXPECT_THROW(GraphVolume({placed}), InputError);
    EXPECT_THROW(Obstacles({placed}, {}), InputError);
  }
  EXPECT_THROW(GraphVolume({}), InputError);
  EXPECT_THROW(Obstacles({}, {{{0, 0, 0}, {0, 0, 0}}}), InputError);
}

TEST(Obstacles, AreCrossedByWaysThatMeetOneOfThemHoweverThin) {
  const PlacedSolid sheet{.solid = CylinderSolid{5, 1e-6}, .origin = {0, 0, 3}, .axis = {1, 0, 1}};
  const PlacedSolid pebble{.solid = BallSolid{0.01}, .origin = {0.3, 0.4, -2}};
  const Obstacles obstacles({sheet, pebble}, {{{0, 0, 10}, {0, 0, -1}}});
  EXPECT_TRUE(obstacles.crossed({-1, 0, 0}, {2, 0, 5}));
  EXPECT_FALSE(obstacles.crossed({-1, 0, 0}, {-1, 1, 2}));
  EXPECT_TRUE(obstacles.crossed({0.3, 0.4, -9}, {0.305, 0.4, 0}));
  EXPECT_FALSE(obstacles.crossed({0.32, 0.4, -9}, {0.32, 0.4, 0}));
  EXPECT_TRUE(obstacles.crossed({-20, 0, 9}, {-20, 0, 10.1}));
  EXPECT_FALSE(obstacles.crossed({-20, 0, 9}, {-20, 0, 9.9}));
  EXPECT_FALSE(Obstacles().crossed({0, 0, 0}, {1, 1, 1}));
}

}  // namespace
}  // namespace cambium
