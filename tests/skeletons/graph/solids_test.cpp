#include "skeletons/graph/solids.h"

#include "blobtree/input_error.h"
#include "skeletons/graph/graph_volume.h"

#include <gtest/gtest.h>

namespace cambium {
namespace {

constexpr double kPi = std::numbers::pi;

double volume_of(const Solid& solid, const Vec3& axis = {0, 0, 1}) {
  return GraphVolume({PlacedSolid{.solid = solid, .origin = {3, -2, 1}, .axis = axis, .scale = 1.5}}).volume() / (1.5 * 1.5 * 1.5);
}

TEST(Solids, HaveTheVolumesOfTheirFormulas) {
  for (const Vec3& axis : {Vec3{0, 0, 1}, Vec3{1, 2, -3}, Vec3{0, 0, -2}}) {
    EXPECT_NEAR(volume_of(BallSolid{1}, axis), 4 * kPi / 3, 0.04);
    EXPECT_NEAR(volume_of(BallSolid{1, kPi / 2}, axis), 2 * kPi / 3, 0.02);
    EXPECT_NEAR(volume_of(BallSolid{2, 0.3 * kPi}, axis), 2 * kPi / 3 * 8 * (1 - std::cos(0.3 * kPi)), 0.1);
    EXPECT_NEAR(volume_of(EllipsoidSolid{{1, 2, 3}}, axis), 4 * kPi / 3 * 6, 0.25);
    EXPECT_NEAR(volume_of(CylinderSolid{1, 2}, axis), 2 * kPi, 0.06);
    EXPECT_NEAR(volume_of(ConeSolid{1, 0, 3}, axis), kPi, 0.04);
    EXPECT_NEAR(volume_of(ConeSolid{0, 1, 3}, axis), kPi, 0.04);
  }
}

TEST(Solids, AreNotDeeperThanTheirSurfaceIsFar) {
  const Solid solids[] = {BallSolid{1}, EllipsoidSolid{{1, 2, 0.5}}, CylinderSolid{1, 2}, ConeSolid{1, 0, 3}, ConeSolid{0.5, 1.5, 1}};
  for (const Solid& solid : solids) {
    const Box box = bounds(solid);
    for (int i = 0; i < 2000; ++i) {
      const Vec3 unit{i % 13 / 12.0, i / 13 % 11 / 10.0, i / 143 % 14 / 13.0};
      const Vec3 p = box.lo + box.size() * unit;
      if (!contains(solid, p)) continue;
      const double d = depth(solid, p);
      ASSERT_GE(d, -1e-12);
      for (const Vec3& step : {Vec3{1, 0, 0}, Vec3{-1, 0, 0}, Vec3{0, 1, 0}, Vec3{0, -1, 0}, Vec3{0, 0, 1}, Vec3{0, 0, -1}})
        EXPECT_TRUE(contains(solid, p + 0.999 * d * step)) << solid.index();
    }
  }
}

TEST(Solids, OfNoSizeAreRefusedByTheirKey) {
  const std::pair<Solid, const char*> bad[] = {
      {BallSolid{0}, "radius"}, {BallSolid{1, 0}, "alpha"}, {BallSolid{1, 7}, "alpha"}, {EllipsoidSolid{{1, 0, 1}}, "half_size"},
      {CylinderSolid{1, -1}, "height"}, {ConeSolid{0, 0, 1}, "radius_base"}, {ConeSolid{1, -1, 1}, "radius_tip"}};
  for (const auto& [solid, key] : bad) {
    try {
      validate(solid);
      FAIL() << key;
    } catch (const InputError& error) {
      EXPECT_NE(error.found().find(key), std::string::npos) << error.found();
    }
  }
}

}  // namespace
}  // namespace cambium
