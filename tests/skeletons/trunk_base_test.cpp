#include "skeletons/trunk_base.h"

#include "blobtree/field.h"
#include "blobtree/input_error.h"
#include "skeletons/surface.h"

#include <gtest/gtest.h>

#include <cmath>
#include <functional>
#include <numbers>

namespace cambium {
namespace {

/// 30 cm thick, straight up.
Skeleton trunk() {
  Skeleton s;
  for (int i = 0; i < 6; ++i) s.nodes.push_back({{0, 0, 0.8 * i}, 0.3, i - 1, {}, {}});
  return s;
}

SurfaceOptions with_base(const TrunkBase& base) {
  SurfaceOptions options;
  options.base = base;
  return options;
}

TrunkBase bare_base() {
  TrunkBase base;
  base.height = 1.2;
  base.irregularity = 0;
  base.below = BelowGround::kKeep;
  base.roots.length = 0;
  return base;
}

/// Metres from the axis to the surface at that height and azimuth.
double reach(const Field& field, double height, double azimuth, double most = 3) {
  double inside = 0, outside = most;
  for (int i = 0; i < 50; ++i) {
    const double r = 0.5 * (inside + outside);
    (field.value({r * std::cos(azimuth), r * std::sin(azimuth), height}) > kIso ? inside : outside) = r;
  }
  return inside;
}

TEST(TrunkBase, FlaresAtTheGroundAndIsTheTrunkAboveItsHeight) {
  const Field flared(surface(trunk(), with_base(bare_base())).tree), plain(surface(trunk(), {}).tree);
  const double prong = reach(flared, 0, 0), valley = reach(flared, 0, std::numbers::pi / 5);
  EXPECT_NEAR(valley, 0.3 * 1.4, 1e-6);
  EXPECT_NEAR(prong, 0.3 * 1.4 * 1.6, 1e-5);
  for (const double height : {1.2, 1.7, 3.0})
    for (const double azimuth : {0.0, 1.0, 4.0}) EXPECT_EQ(reach(flared, height, azimuth), reach(plain, height, azimuth));
}

TEST(TrunkBase, RootsRunOnFromTheProngsWithoutASeam) {
  TrunkBase base = bare_base();
  base.roots.length = 2;
  base.roots.wander = 0;
  base.roots.depth = 0;
  const Field field(surface(trunk(), with_base(base)).tree);
  const double along = reach(field, 0, 0, 4);
  EXPECT_GT(along, 1.8) << "the root lies along its prong";
  double last = kInfinity;                                 // the height of the surface over the prong falls outwards without a gap
  for (double r = 0.3; r < 1.8; r += 0.05) {
    double inside = 0, outside = 2;
    ASSERT_GT(field.value({r, 0, 0}), kIso) << r;
    for (int i = 0; i < 40; ++i) {
      const double z = 0.5 * (inside + outside);
      (field.value({r, 0, z}) > kIso ? inside : outside) = z;
    }
    EXPECT_LT(inside, last + 0.003) << r;
    last = inside;
  }
}

TEST(TrunkBase, MayBeCutFlatAtTheGround) {
  TrunkBase base;
  base.below = BelowGround::kCut;
  base.roots.depth = 0.5;
  const Field cut(surface(trunk(), with_base(base)).tree);
  base.below = BelowGround::kKeep;
  const Field kept(surface(trunk(), with_base(base)).tree);
  EXPECT_GT(kept.value({0.05, 0, -0.1}), kIso);
  EXPECT_LT(cut.value({0.05, 0, -0.02}), kIso);
  EXPECT_GT(cut.value({0.05, 0, 0.02}), kIso);
  for (const double azimuth : {0.3, 2.0}) EXPECT_NEAR(reach(cut, 0.3, azimuth), reach(kept, 0.3, azimuth), 1e-9);
}

TEST(TrunkBase, StandsOnASlope) {
  TrunkBase base = bare_base();
  base.up = {-0.5, 0, 1};
  base.below = BelowGround::kCut;
  const Field field(surface(trunk(), with_base(base)).tree);
  const Vec3 uphill = glm::normalize(Vec3(1, 0, 0.5)), up = glm::normalize(base.up);
  for (const double r : {-0.3, 0.0, 0.3}) {
    EXPECT_GT(field.value(r * uphill + 0.02 * up), kIso);
    EXPECT_LT(field.value(r * uphill - 0.02 * up), kIso);
  }
}

TEST(TrunkBase, RootsOfASkeletonsOwnMeltIntoTheTrunkAsWell) {
  Skeleton s = trunk();
  s.nodes.push_back({{1.5, 0, -0.3}, 0.08, 0, 0.2, true});
  const Fork fork = surface(s, {}).tree.get<Fork>(surface(s, {}).tree.root());
  ASSERT_EQ(fork.laterals.size(), 1u);
  EXPECT_LT(fork.laterals[0].direction.z, -0.9) << "its crotch is below";
  s.nodes.back().position.z = 1.0;
  EXPECT_GT(surface(s, {}).tree.get<Fork>(surface(s, {}).tree.root()).laterals[0].direction.z, 0.5) << "a branch's is above";
}

TEST(TrunkBase, RefusesByTheKey) {
  const std::pair<const char*, std::function<void(TrunkBase&)>> cases[] = {
      {"base: height", [](TrunkBase& b) { b.height = 0; }},
      {"base: spread", [](TrunkBase& b) { b.spread = -1; }},
      {"base: sharpness", [](TrunkBase& b) { b.sharpness = 1; }},
      {"base: prongs", [](TrunkBase& b) { b.count = 0; }},
      {"base: irregularity", [](TrunkBase& b) { b.irregularity = std::nan(""); }},
      {"base: up", [](TrunkBase& b) { b.up = Vec3(0.0); }},
      {"base: roots: radius", [](TrunkBase& b) { b.roots.radius = 0; }},
      {"base: roots: branches", [](TrunkBase& b) { b.roots.branches = -1; }},
  };
  for (const auto& [named, spoil] : cases) {
    TrunkBase base;
    spoil(base);
    try {
      surface(trunk(), with_base(base));
      ADD_FAILURE() << named;
    } catch (const InputError& error) {
      EXPECT_EQ(error.found().substr(0, std::string_view(named).size()), named);
    }
  }
  SurfaceOptions galbraith = with_base({});
  galbraith.profile = Profile::kGalbraith;
  EXPECT_THROW(surface(trunk(), galbraith), InputError);
}

}  // namespace
}  // namespace cambium
