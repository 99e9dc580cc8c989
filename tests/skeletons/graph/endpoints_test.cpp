#include "skeletons/graph/endpoints.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <set>

namespace cambium {
namespace {

/// A grid of places in a ball of radius 1; the first one is its centre.
std::vector<Vec3> places_in_ball() {
  std::vector<Vec3> places{Vec3{0.0}};
  for (int i = 0; i < 17 * 17 * 17; ++i) {
    const Vec3 p{i % 17 / 8.0 - 1, i / 17 % 17 / 8.0 - 1, i / 289 / 8.0 - 1};
    if (glm::length(p) <= 1 && glm::length(p) > 0) places.push_back(p);
  }
  return places;
}

const GraphVolume kBall({PlacedSolid{.solid = BallSolid{1}}});

TEST(Endpoints, AreDifferentNodesAndNeverTheRoot) {
  const auto places = places_in_ball();
  const auto endpoints = draw_endpoints(kBall, places, {}, 200, 7);
  EXPECT_EQ(endpoints.size(), 200u);
  EXPECT_EQ(std::set(endpoints.begin(), endpoints.end()).size(), 200u);
  EXPECT_EQ(std::count(endpoints.begin(), endpoints.end(), 0u), 0);
}

TEST(Endpoints, AreAllNodesThereAreWhereMoreAreWanted) {
  const auto places = places_in_ball();
  EXPECT_EQ(draw_endpoints(kBall, places, {}, 100'000, 7).size(), places.size() - 1);
}

TEST(Endpoints, OfAShellAreNotDeeperThanIt) {
  const auto places = places_in_ball();
  const auto endpoints = draw_endpoints(kBall, places, {.shell = 0.2}, 100, 7);
  EXPECT_EQ(endpoints.size(), 100u);
  for (const auto endpoint : endpoints) EXPECT_GE(glm::length(places[endpoint]), 0.8 - 1e-12);
}

TEST(Endpoints, StayOutOfAVolumeThatBearsNone) {
  const GraphVolume volume({PlacedSolid{.solid = BallSolid{1}, .endpoints = false}, PlacedSolid{.solid = BallSolid{0.5}}});
  const auto places = places_in_ball();
  const auto endpoints = draw_endpoints(volume, places, {}, 100'000, 7);
  EXPECT_GT(endpoints.size(), 100u);
  for (const auto endpoint : endpoints) EXPECT_LE(glm::length(places[endpoint]), 0.5);
}

TEST(Endpoints, AreAllottedEvenlyToSubvolumes) {
  const GraphVolume volume({PlacedSolid{.solid = BallSolid{1}, .part = 1}, PlacedSolid{.solid = BallSolid{0.1}, .origin = {9, 0, 0}, .part = 2},
                            PlacedSolid{.solid = BallSolid{0.1}, .origin = {19, 0, 0}, .part = 3}});
  std::vector<Vec3> places = places_in_ball();
  std::vector<std::uint16_t> parts(places.size(), 1);
  parts[0] = 0;
  for (int i = 0; i < 20; ++i) places.push_back({9 + 0.004 * i, 0, 0}), parts.push_back(2);
  for (int i = 0; i < 3; ++i) places.push_back({19 + 0.004 * i, 0, 0}), parts.push_back(3);
  std::vector<int> of_part(4, 0);
  for (const auto endpoint : draw_endpoints(volume, places, {.parts = parts}, 30, 7)) ++of_part[parts[endpoint]];
  EXPECT_EQ(of_part[3], 3) << "all that it has";
  EXPECT_EQ(of_part[1] + of_part[2], 27) << "which make up for it";
  EXPECT_LE(std::abs(of_part[1] - of_part[2]), 1);
}

TEST(Endpoints, AreEachNodeAboutEquallyOften) {
  const auto places = places_in_ball();
  std::vector<int> times(places.size(), 0);
  constexpr int kDraws = 4000;
  for (int seed = 0; seed < kDraws; ++seed)
    for (const auto endpoint : draw_endpoints(kBall, places, {}, 10, static_cast<std::uint64_t>(seed))) ++times[endpoint];
  const double expected = kDraws * 10.0 / static_cast<double>(places.size() - 1);
  double chi = 0;
  for (std::size_t i = 1; i < times.size(); ++i) chi += (times[i] - expected) * (times[i] - expected) / expected;
  const auto freedom = static_cast<double>(places.size() - 2);
  EXPECT_NEAR(chi / freedom, 1.0, 5 * std::sqrt(2 / freedom));
}

TEST(Endpoints, AroundAPathAreNearItAndNotOnIt) {
  const auto places = places_in_ball();
  std::vector<std::uint32_t> path;
  for (std::uint32_t i = 0; i < places.size(); ++i)
    if (places[i].x == 0 && places[i].y == 0) path.push_back(i);
  const auto endpoints = draw_endpoints_around(places, path, 0.3, 40, 7);
  EXPECT_EQ(endpoints.size(), 40u);
  for (const auto endpoint : endpoints) {
    EXPECT_GT(std::hypot(places[endpoint].x, places[endpoint].y), 0.0);
    EXPECT_LE(std::hypot(places[endpoint].x, places[endpoint].y), 0.3 + 1e-12);
  }
}

}  // namespace
}  // namespace cambium
