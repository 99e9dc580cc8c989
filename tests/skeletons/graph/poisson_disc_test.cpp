#include "skeletons/graph/poisson_disc.h"

#include "blobtree/input_error.h"
#include "blobtree/place_hash.h"
#include "tests/skeletons/graph/node_clouds.h"

#include <gtest/gtest.h>

#include <atomic>
#include <chrono>
#include <cmath>
#include <thread>

namespace cambium {
namespace {

using namespace testing;

constexpr double kPi = std::numbers::pi;

PoissonDiscNodes strewn(const GraphVolume& volume, const PoissonDiscOptions& options, std::span<const Vec3> given = {}, int count = 1) {
  return poisson_disc(volume, given, options, threads(count)).value();
}

/// The largest distance from a place in the volume to the nearest node, as far as some thousand places tell.
double widest_hole(const GraphVolume& volume, std::span<const Vec3> nodes) {
  double widest = 0;
  for (std::uint64_t i = 0; i < 4000; ++i) {
    const Vec3 unit{unit_of(hash_of(1, i, 0)), unit_of(hash_of(1, i, 1)), unit_of(hash_of(1, i, 2))};
    const Vec3 p = volume.bounds().lo + volume.bounds().size() * unit;
    if (!volume.contains(p)) continue;
    double nearest = kInfinity;
    for (const Vec3& node : nodes) nearest = std::min(nearest, glm::length(p - node));
    widest = std::max(widest, nearest);
  }
  return widest;
}

TEST(PoissonDisc, NodesKeepTheirDistanceAndAreInTheVolume) {
  const GraphVolume volumes[] = {ball(1), ball(2, 0.3 * kPi, {1, 2, -1}),
                                 GraphVolume({PlacedSolid{.solid = CylinderSolid{0.05, 4}, .axis = {1, 1, 1}},
                                              PlacedSolid{.solid = EllipsoidSolid{{1, 0.5, 0.7}}, .origin = {1, 1, 2}}})};
  for (const GraphVolume& volume : volumes)
    for (const PoissonDiscOptions& options : {PoissonDiscOptions{.count = 3000}, PoissonDiscOptions{.spacing = 0.11, .seed = 5},
                                              PoissonDiscOptions{.count = 400, .spacing = 0.04}, PoissonDiscOptions{.count = 40}}) {
      const PoissonDiscNodes nodes = strewn(volume, options);
      EXPECT_GE(least_distance(nodes.positions, 3 * nodes.spacing), nodes.spacing);
      if (options.spacing) { EXPECT_EQ(nodes.spacing, *options.spacing); }
      for (const Vec3& p : nodes.positions) ASSERT_TRUE(volume.contains(p));
    }
}

TEST(PoissonDisc, GivenNodesComeFirstAndAreKeptClearOf) {
  const std::vector<Vec3> given = {{2, 1, -3}, {2.01, 1, -3}, {2, 1, -1.95}, {2, 1.99, -3}, {9, 9, 9}};
  for (const PoissonDiscOptions& options : {PoissonDiscOptions{.count = 2000}, PoissonDiscOptions{.spacing = 0.15}}) {
    const PoissonDiscNodes nodes = strewn(ball(1), options, given);
    ASSERT_GT(nodes.positions.size(), given.size());
    EXPECT_TRUE(std::equal(given.begin(), given.end(), nodes.positions.begin()));
    EXPECT_GE(least_distance(nodes.positions, 3 * nodes.spacing, given.size()), nodes.spacing);
  }
}

TEST(PoissonDisc, TheCountThatIsWantedIsReachedExactly) {
  const Vec3 given[] = {{2, 1, -3}};
  const auto obstacles = std::make_shared<Obstacles>(std::vector<PlacedSolid>{{.solid = BallSolid{0.9}, .origin = {2, 1, -3}}},
                                                     std::vector<HalfSpaceObstacle>{});
  const GraphVolume shell({PlacedSolid{.solid = BallSolid{1}, .origin = {2, 1, -3}}}, obstacles);
  for (const std::size_t count : {1u, 2u, 3u, 10u, 47u, 300u, 1000u, 9810u, 30000u}) {
    EXPECT_EQ(strewn(ball(1), {.count = count}).positions.size(), count);
    EXPECT_EQ(strewn(ball(1, 0.1 * kPi, {1, 1, 1}), {.count = count, .seed = 9}, given).positions.size(), count);
    EXPECT_EQ(strewn(shell, {.count = count}, given).positions.size(), count);
  }
}

TEST(PoissonDisc, ACountFillsTheVolumeNearly) {
  for (const std::size_t count : {300u, 10000u}) {
    const GraphVolume volume = ball(1, 0.3 * kPi);
    const PoissonDiscNodes nodes = strewn(volume, {.count = count});
    EXPECT_LT(widest_hole(volume, nodes.positions), 1.6 * nodes.spacing);
    EXPECT_GT(static_cast<double>(count) * std::pow(nodes.spacing, 3) / volume.volume(), 0.57);
  }
}

TEST(PoissonDisc, WithoutACountNoHoleIsMuchLargerThanTheSpacing) {
  for (const double spacing : {0.3, 0.1}) {
    const GraphVolume volume = ball(1, 0.4 * kPi, {1, -1, 2});
    EXPECT_LT(widest_hole(volume, strewn(volume, {.spacing = spacing}).positions), 1.15 * spacing);
  }
}

TEST(PoissonDisc, FewerNodesThanFitAreSpreadOverAllOfTheVolume) {
  const GraphVolume volume = ball(1);
  const PoissonDiscNodes nodes = strewn(volume, {.count = 2000, .spacing = 0.05});
  ASSERT_EQ(nodes.positions.size(), 2000u);
  Vec3 middle{0.0};
  for (const Vec3& p : nodes.positions) middle += (p - Vec3{2, 1, -3}) / 2000.0;
  EXPECT_LT(glm::length(middle), 0.05);
}

TEST(PoissonDisc, MoreNodesThanFitAtASpacingAreNotMade) {
  const PoissonDiscNodes nodes = strewn(ball(1), {.count = 5000, .spacing = 0.5});
  EXPECT_LT(nodes.positions.size(), 100u);
  EXPECT_GT(nodes.positions.size(), 20u);
}

TEST(PoissonDisc, NodesAreTheSameAtAnyThreadCountAndOthersWithAnotherSeed) {
  for (const PoissonDiscOptions& options : {PoissonDiscOptions{.count = 40000}, PoissonDiscOptions{.spacing = 0.07}}) {
    const std::vector<Vec3> one = strewn(ball(1), options).positions;
    EXPECT_EQ(one, strewn(ball(1), options, {}, 2).positions);
    EXPECT_EQ(one, strewn(ball(1), options, {}, 4).positions);
    PoissonDiscOptions other = options;
    other.seed = 1;
    EXPECT_NE(one, strewn(ball(1), other).positions);
  }
}

TEST(PoissonDisc, AVolumeThinnerThanTheSpacingIsFilledAlongItsLength) {
  const GraphVolume rod({PlacedSolid{.solid = CylinderSolid{0.01, 5}, .axis = {1, 2, 3}}});
  const auto along_rod = strewn(rod, {.spacing = 0.1}).positions.size();
  EXPECT_GT(along_rod, 27u);   // 37 is what random parking leaves when it goes on for ever
  EXPECT_LT(along_rod, 51u);
  EXPECT_EQ(strewn(rod, {.count = 200}).positions.size(), 200u);
  const GraphVolume sheet({PlacedSolid{.solid = CylinderSolid{1, 0.002}, .axis = {1, 2, 3}}});
  const PoissonDiscNodes on_sheet = strewn(sheet, {.spacing = 0.1});
  EXPECT_LT(widest_hole(sheet, on_sheet.positions), 0.14);
}

TEST(PoissonDisc, NoRoomLeavesTheGivenNodesAlone) {
  const auto everywhere = std::make_shared<Obstacles>(std::vector<PlacedSolid>{},
                                                      std::vector<HalfSpaceObstacle>{{{0, 0, 50}, {0, 0, 1}}});
  const GraphVolume none({PlacedSolid{.solid = BallSolid{1}}}, everywhere);
  const std::vector<Vec3> given = {{0, 0, 1}, {0, 0, 2}};
  EXPECT_EQ(strewn(none, {.count = 100}, given).positions, given);
  EXPECT_EQ(strewn(none, {.spacing = 0.1}, given).positions, given);
  EXPECT_GT(strewn(none, {.count = 100}, given).spacing, 0);
  EXPECT_EQ(strewn(ball(1), {.count = 2}, given).positions, given);
}

TEST(PoissonDisc, WhatLittleAnObstacleLeavesIsNoRoom) {
  const auto wall = std::make_shared<Obstacles>(std::vector<PlacedSolid>{}, std::vector<HalfSpaceObstacle>{{.point = {0, 0, 0.995}}});
  const GraphVolume sliver({PlacedSolid{.solid = BallSolid{}}}, wall);
  EXPECT_EQ(strewn(sliver, {.count = 150}, std::vector<Vec3>{{0, 0, 1}}).positions.size(), 1u);
}

TEST(PoissonDisc, SettingsThatAskForNothingOrTooMuchAreRefused) {
  EXPECT_THROW(strewn(ball(1), {}), InputError);
  EXPECT_THROW(strewn(ball(1), {.spacing = 0.0}), InputError);
  EXPECT_THROW(strewn(ball(1), {.spacing = 1e-4}), InputError);
  EXPECT_THROW(strewn(ball(1), {.spacing = 1e-9}), InputError);
  EXPECT_THROW(strewn(ball(1), {.count = std::size_t{1} << 32}), InputError);
}

TEST(PoissonDisc, CancellingStopsItBeforeItBeginsOrOnTheWay) {
  std::atomic<bool> cancel = true;
  RunOptions run;
  run.cancel = &cancel;
  EXPECT_FALSE(poisson_disc(ball(1), {}, {.count = 1000000}, run));
  cancel = false;
  std::thread canceller([&] {
    std::this_thread::sleep_for(std::chrono::milliseconds(100));
    cancel = true;
  });
  EXPECT_FALSE(poisson_disc(ball(1), {}, {.count = 10000000}, run));
  canceller.join();
}

}  // namespace
}  // namespace cambium
