#include "skeletons/graph/volume_probe.h"

#include "blobtree/place_hash.h"
#include "tests/skeletons/graph/node_clouds.h"

#include <gtest/gtest.h>

#include <memory>

namespace cambium {
namespace {

using namespace testing;

constexpr double kPi = std::numbers::pi;

TEST(VolumeProbe, TellsTheVolumeOfThickAndThinSolids) {
  EXPECT_NEAR(VolumeProbe(ball(1), 4096).volume(), 4 * kPi / 3, 0.05);
  EXPECT_NEAR(VolumeProbe(ball(1, 0.3 * kPi, {1, 2, 3}), 4096).volume(), 2 * kPi / 3 * (1 - std::cos(0.3 * kPi)), 0.02);
  const GraphVolume rod({PlacedSolid{.solid = CylinderSolid{1e-3, 5}, .axis = {1, 2, 3}, .scale = 2}});
  EXPECT_NEAR(VolumeProbe(rod, 4096).volume(), 8 * 5e-6 * kPi, 8 * 1e-6);
}

TEST(VolumeProbe, CountsWhatIsInSeveralSolidsOnce) {
  const PlacedSolid one{.solid = BallSolid{1}};
  EXPECT_NEAR(VolumeProbe(GraphVolume({one, one, one}), 16384).volume(), 4 * kPi / 3, 0.05);
  const GraphVolume apart({one, PlacedSolid{.solid = BallSolid{1}, .origin = {5, 0, 0}}});
  EXPECT_NEAR(VolumeProbe(apart, 16384).volume(), 8 * kPi / 3, 0.1);
}

TEST(VolumeProbe, LeavesOutObstacles) {
  const auto half = std::make_shared<Obstacles>(std::vector<PlacedSolid>{}, std::vector<HalfSpaceObstacle>{{{0, 0, 0}, {0, 0, 1}}});
  EXPECT_NEAR(VolumeProbe(GraphVolume({PlacedSolid{.solid = BallSolid{1}}}, half), 4096).volume(), 2 * kPi / 3, 0.03);
  const auto all = std::make_shared<Obstacles>(std::vector<PlacedSolid>{}, std::vector<HalfSpaceObstacle>{{{0, 0, 2}, {0, 0, 1}}});
  EXPECT_TRUE(VolumeProbe(GraphVolume({PlacedSolid{.solid = BallSolid{1}}}, all), 4096).empty());
}

TEST(VolumeProbe, ShareOfABallFallsFromOneAsTheBallOutgrowsTheVolume) {
  const GraphVolume volume = ball(1);
  const VolumeProbe probe(volume, 4096);
  EXPECT_GT(probe.share_of_ball(1e-3), 0.99);
  EXPECT_NEAR(probe.share_of_ball(0.1), 1 - 3.0 / 16 * 3 * 0.1, 0.02);   // 1 - 3/16 of surface times radius over volume
  EXPECT_NEAR(probe.share_of_ball(10), 1e-3, 5e-3);
  EXPECT_GT(probe.share_of_ball(1000), 0);
}

TEST(VolumeProbe, MayHoldIsTrueWhereverTheVolumeIs) {
  const GraphVolume volumes[] = {ball(1), ball(1, 0.1 * kPi, {1, 2, 3}), GraphVolume({PlacedSolid{.solid = CylinderSolid{0.01, 5}, .axis = {1, 2, 3}}}),
                                 GraphVolume({PlacedSolid{.solid = CylinderSolid{1, 0.01}, .axis = {1, 2, 3}}})};
  for (const GraphVolume& volume : volumes) {
    const VolumeProbe probe(volume, 4096);
    std::size_t held = 0, looked_at = 0;
    for (std::uint64_t i = 0; i < 20000; ++i) {
      const Vec3 unit{unit_of(hash_of(1, i, 0)), unit_of(hash_of(1, i, 1)), unit_of(hash_of(1, i, 2))};
      const Vec3 p = volume.bounds().lo + volume.bounds().size() * unit;
      if (volume.contains(p)) { EXPECT_TRUE(probe.may_hold({p, p})); }
      held += probe.may_hold({p, p});
      ++looked_at;
    }
    EXPECT_LT(held, looked_at);   // and not everywhere
  }
}

}  // namespace
}  // namespace cambium
