#include "skeletons/graph/node_graph.h"

#include "blobtree/input_error.h"
#include "blobtree/place_hash.h"
#include "tests/skeletons/graph/node_clouds.h"

#include <gtest/gtest.h>

#include <atomic>
#include <numbers>
#include <set>
#include <utility>

namespace cambium {
namespace {

using namespace testing;
using Edges = std::set<std::pair<std::uint32_t, std::uint32_t>>;

NodeGraph joined(std::span<const Vec3> positions, double spacing, const EdgeOptions& options = {}, std::span<const std::uint16_t> parts = {},
                 const Obstacles* obstacles = nullptr, int count = 1) {
  return join_nodes(positions, spacing, parts, obstacles, options, threads(count)).value();
}

PoissonDiscNodes strewn(std::size_t count, double angle = std::numbers::pi) {
  return poisson_disc(ball(1, angle), {}, {.count = count, .seed = 3}, threads(1)).value();
}

Edges edges_of(const NodeGraph& graph) {
  Edges edges;
  for (std::uint32_t u = 0; u < graph.nodes(); ++u)
    for (const std::uint32_t v : graph.of(u)) edges.insert({std::min(u, v), std::max(u, v)});
  return edges;
}

/// Both ends know of each edge, in ascending order and once, and there is none from a node to itself.
void expect_sound(const NodeGraph& graph) {
  ASSERT_EQ(graph.first.back(), graph.to.size());
  for (std::uint32_t u = 0; u < graph.nodes(); ++u) {
    const auto to = graph.of(u);
    for (std::size_t i = 1; i < to.size(); ++i) ASSERT_LT(to[i - 1], to[i]);
    for (const std::uint32_t v : to) {
      ASSERT_NE(u, v);
      const auto back = graph.of(v);
      ASSERT_TRUE(std::binary_search(back.begin(), back.end(), u));
    }
  }
}

std::size_t reached_from_root(const NodeGraph& graph) {
  std::vector<bool> seen(graph.nodes());
  std::vector<std::uint32_t> waiting = {0};
  std::size_t count = 0;
  seen[0] = true;
  while (!waiting.empty()) {
    const std::uint32_t u = waiting.back();
    waiting.pop_back();
    ++count;
    for (const std::uint32_t v : graph.of(u))
      if (!seen[v]) seen[v] = true, waiting.push_back(v);
  }
  return count;
}

template <class Allowed>
Edges yao_edges(std::span<const Vec3> positions, int sectors, double longest, const Allowed& allowed) {
  const std::vector<Vec3> directions = yao_directions(sectors);
  Edges edges;
  for (std::uint32_t u = 0; u < positions.size(); ++u) {
    std::vector<std::pair<double, std::uint32_t>> nearest(directions.size(), {longest * longest, 0xffffffff});
    for (std::uint32_t v = 0; v < positions.size(); ++v) {
      if (v == u || !allowed(u, v)) continue;
      const Vec3 way = positions[v] - positions[u];
      auto& best = nearest[static_cast<std::size_t>(yao_sector(directions, way))];
      best = std::min(best, {glm::dot(way, way), v});
    }
    for (const auto& [d2, v] : nearest)
      if (v != 0xffffffff) edges.insert({std::min(u, v), std::max(u, v)});
  }
  return edges;
}

constexpr auto kAll = [](std::uint32_t, std::uint32_t) { return true; };

TEST(YaoDirections, AreUnitAndApartAndSpreadEvenly) {
  for (int sectors = 4; sectors <= 64; ++sectors) {
    const std::vector<Vec3> directions = yao_directions(sectors);
    ASSERT_EQ(directions.size(), static_cast<std::size_t>(sectors));
    Vec3 sum{0.0};
    double closest = -1;
    for (std::size_t i = 0; i < directions.size(); ++i) {
      EXPECT_NEAR(glm::length(directions[i]), 1, 1e-12);
      sum += directions[i];
      for (std::size_t j = 0; j < i; ++j) closest = std::max(closest, glm::dot(directions[i], directions[j]));
    }
    EXPECT_LT(glm::length(sum), 0.5) << sectors;
    EXPECT_GT(std::acos(closest), 2.4 / std::sqrt(sectors)) << sectors;   // 3.8 is the most there can be
  }
}

TEST(YaoDirections, OfRegularSolidsAreEquallyFarFromTheirNeighbours) {
  const std::pair<int, double> solids[] = {{4, -1.0 / 3}, {6, 0}, {8, 1.0 / 3}, {12, 1 / std::sqrt(5)}, {20, std::sqrt(5) / 3}};
  for (const auto& [sectors, cosine] : solids) {
    const std::vector<Vec3> directions = yao_directions(sectors);
    for (const Vec3& a : directions) {
      double nearest = -1;
      for (const Vec3& b : directions)
        if (&a != &b) nearest = std::max(nearest, glm::dot(a, b));
      EXPECT_NEAR(nearest, cosine, 1e-12) << sectors;
    }
  }
}

TEST(YaoDirections, ASectorIsWhereItsDirectionIsNearest) {
  for (int sectors = 4; sectors <= 64; ++sectors) {
    const std::vector<Vec3> directions = yao_directions(sectors);
    for (std::uint64_t i = 0; i < 300; ++i) {
      const Vec3 way = Vec3{unit_of(hash_of(7, i, 0)), unit_of(hash_of(7, i, 1)), unit_of(hash_of(7, i, 2))} - 0.5;
      const Vec3 mine = directions[static_cast<std::size_t>(yao_sector(directions, way))];
      for (const Vec3& other : directions) EXPECT_GE(glm::dot(mine, way), glm::dot(other, way) - 1e-15);
    }
  }
  EXPECT_EQ(yao_sector(yao_directions(8), {0, 1, 0}), 0);
  EXPECT_EQ(yao_sector(yao_directions(6), {1, 1, 1}), 0);
}

TEST(YaoDirections, FewerThanFourOrMoreThan64AreRefused) {
  for (const int sectors : {-1, 0, 3, 65}) EXPECT_THROW(yao_directions(sectors), InputError);
}

TEST(NodeGraph, OfYaoJoinsTheNearestOfEachSector) {
  const PoissonDiscNodes nodes = strewn(400, 0.3 * std::numbers::pi);
  for (int sectors = 4; sectors <= 64; ++sectors) {
    const NodeGraph graph = joined(nodes.positions, nodes.spacing, {.sectors = sectors});
    expect_sound(graph);
    ASSERT_EQ(graph.repaired, 0u);
    ASSERT_EQ(edges_of(graph), yao_edges(nodes.positions, sectors, longest_yao_edge(nodes.positions, nodes.spacing, sectors), kAll)) << sectors;
  }
}

TEST(NodeGraph, OfYaoIsRightForNodesThatAreNotStrewnEvenly) {
  std::vector<Vec3> places = random_places(1500, 4);
  for (Vec3& p : places) p *= p;
  const double spacing = 0.01;
  const NodeGraph graph = joined(places, spacing);
  const Edges expected = yao_edges(places, 8, longest_yao_edge(places, spacing, 8), kAll);
  const Edges edges = edges_of(graph);
  EXPECT_TRUE(std::includes(edges.begin(), edges.end(), expected.begin(), expected.end()));
  EXPECT_EQ(edges.size(), expected.size() + graph.repaired);
}

TEST(NodeGraph, OfYaoOnALatticeTakesTheLowerOfEquallyNearNodes) {
  std::vector<Vec3> lattice;
  for (int i = 0; i < 512; ++i) lattice.push_back({i % 8, i / 8 % 8, i / 64});
  for (const int sectors : {4, 6, 8, 12, 14, 20, 26})
    EXPECT_EQ(edges_of(joined(lattice, 1, {.sectors = sectors})), yao_edges(lattice, sectors, longest_yao_edge(lattice, 1, sectors), kAll)) << sectors;
}

TEST(NodeGraph, OfAThresholdJoinsAllPairsThatAreNearer) {
  const PoissonDiscNodes nodes = strewn(700);
  for (const double threshold : {1.3, 1.8, 3.0}) {
    const NodeGraph graph = joined(nodes.positions, nodes.spacing, {.rule = EdgeRule::kThreshold, .threshold = threshold});
    expect_sound(graph);
    Edges expected;
    for (std::uint32_t u = 0; u < nodes.positions.size(); ++u)
      for (std::uint32_t v = 0; v < u; ++v)
        if (glm::length(nodes.positions[u] - nodes.positions[v]) <= threshold * nodes.spacing) expected.insert({v, u});
    const Edges edges = edges_of(graph);
    EXPECT_TRUE(std::includes(edges.begin(), edges.end(), expected.begin(), expected.end()));
    EXPECT_EQ(edges.size(), expected.size() + graph.repaired);
  }
}

TEST(NodeGraph, SubvolumesAreJoinedThroughTheCommonOneOnly) {
  const PoissonDiscNodes nodes = strewn(2000);
  std::vector<std::uint16_t> parts;
  for (const Vec3& p : nodes.positions) parts.push_back(p.x < 1.9 ? 1 : p.x > 2.1 ? 2 : 0);   // a sheet between two halves
  const auto allowed = [&](std::uint32_t u, std::uint32_t v) { return parts[u] == parts[v] || parts[u] == 0 || parts[v] == 0; };
  const NodeGraph graph = joined(nodes.positions, nodes.spacing, {}, parts);
  EXPECT_EQ(graph.repaired, 0u);
  EXPECT_EQ(edges_of(graph), yao_edges(nodes.positions, 8, longest_yao_edge(nodes.positions, nodes.spacing, 8), allowed));
  for (const auto& [u, v] : edges_of(joined(nodes.positions, nodes.spacing, {.rule = EdgeRule::kThreshold}, parts))) EXPECT_TRUE(allowed(u, v));
}

TEST(NodeGraph, ObstaclesAreNotCrossed) {
  const Obstacles wall({PlacedSolid{.solid = BallSolid{0.5}, .origin = {2, 1, -3}}}, {});
  const GraphVolume around({PlacedSolid{.solid = BallSolid{1}, .origin = {2, 1, -3}}}, std::make_shared<Obstacles>(wall));
  const PoissonDiscNodes nodes = poisson_disc(around, {}, {.count = 1500}, threads(1)).value();
  const auto allowed = [&](std::uint32_t u, std::uint32_t v) { return !wall.crossed(nodes.positions[std::min(u, v)], nodes.positions[std::max(u, v)]); };
  const NodeGraph graph = joined(nodes.positions, nodes.spacing, {}, {}, &wall);
  EXPECT_EQ(graph.repaired, 0u);
  const Edges expected = yao_edges(nodes.positions, 8, longest_yao_edge(nodes.positions, nodes.spacing, 8), allowed);
  EXPECT_EQ(edges_of(graph), expected);
  EXPECT_NE(expected, yao_edges(nodes.positions, 8, longest_yao_edge(nodes.positions, nodes.spacing, 8), kAll));
}

TEST(NodeGraph, WhatIsApartIsJoinedByTheShortestEdgesAndCounted) {
  std::vector<Vec3> places;
  for (int cloud = 0; cloud < 5; ++cloud)
    for (const Vec3& p : random_places(200, static_cast<unsigned>(cloud))) places.push_back(p + Vec3{cloud * cloud * 30, 0, 0});
  const NodeGraph graph = joined(places, 0.02, {.rule = EdgeRule::kThreshold, .threshold = 20});
  expect_sound(graph);
  EXPECT_EQ(graph.repaired, 4u);
  EXPECT_EQ(reached_from_root(graph), places.size());
  for (int cloud = 1; cloud < 5; ++cloud) {   // the edge from the cloud before
    double least = kInfinity, edge = kInfinity;
    for (auto u = static_cast<std::uint32_t>(200 * cloud - 200); u < 200u * static_cast<unsigned>(cloud); ++u) {
      for (auto v = static_cast<std::uint32_t>(200 * cloud); v < 200u * static_cast<unsigned>(cloud) + 200; ++v)
        least = std::min(least, glm::length(places[u] - places[v]));
      for (const std::uint32_t v : graph.of(u))
        if (v >= 200u * static_cast<unsigned>(cloud)) edge = std::min(edge, glm::length(places[u] - places[v]));
    }
    EXPECT_EQ(edge, least);
  }
}

TEST(NodeGraph, RepairCrossesObstaclesAndSubvolumesOnlyWhereNothingElseWillDo) {
  // Two rows beside each other that only their far ends may join, by an edge longer than those that may not be.
  std::vector<Vec3> places;
  std::vector<std::uint16_t> parts;
  for (int i = 0; i < 20; ++i) places.push_back({i, 0, 0}), parts.push_back(1);
  for (int i = 0; i < 20; ++i) places.push_back({i, 3, 0}), parts.push_back(i == 19 ? 0 : 2);
  const EdgeOptions near{.rule = EdgeRule::kThreshold, .threshold = 1.5};
  const NodeGraph graph = joined(places, 1, near, parts);
  EXPECT_EQ(graph.repaired, 1u);
  const auto end = graph.of(39);
  EXPECT_TRUE(std::binary_search(end.begin(), end.end(), 19u));
  parts.back() = 2;
  const NodeGraph forced = joined(places, 1, near, parts);
  EXPECT_EQ(forced.repaired, 1u);
  EXPECT_EQ(reached_from_root(forced), places.size());
  EXPECT_EQ(forced.of(0).back(), 20u);
}

TEST(NodeGraph, OfNodesAtTheSamePlaceReachesThemAll) {
  const std::vector<Vec3> places(100, Vec3{1, 2, 3});
  const NodeGraph graph = joined(places, 0.1);
  EXPECT_EQ(graph.repaired, 99u);
  EXPECT_EQ(reached_from_root(graph), 100u);
}

TEST(NodeGraph, OfNoneOrOneOrTwoNodesIsWhatItShouldBe) {
  EXPECT_EQ(joined({}, 1).nodes(), 0u);
  const Vec3 places[] = {{0, 0, 0}, {100, 0, 0}};
  EXPECT_EQ(joined(std::span(places, 1), 1).edges(), 0u);
  EXPECT_EQ(joined(places, 1).edges(), 1u);
}

TEST(NodeGraph, IsTheSameAtAnyThreadCount) {
  const PoissonDiscNodes nodes = strewn(20000);
  for (const EdgeOptions& options : {EdgeOptions{}, EdgeOptions{.rule = EdgeRule::kThreshold}, EdgeOptions{.sectors = 14}}) {
    const NodeGraph one = joined(nodes.positions, nodes.spacing, options);
    for (const int count : {2, 4}) {
      const NodeGraph other = joined(nodes.positions, nodes.spacing, options, {}, nullptr, count);
      EXPECT_EQ(one.first, other.first);
      EXPECT_EQ(one.to, other.to);
      EXPECT_EQ(one.repaired, other.repaired);
    }
  }
}

TEST(NodeGraph, SettingsOutOfRangeAreRefusedByTheirKey) {
  const Vec3 places[] = {{0, 0, 0}, {1, 0, 0}};
  const std::pair<EdgeOptions, const char*> bad[] = {{{.sectors = 3}, "sectors"}, {{.sectors = 65}, "sectors"},
                                                     {{.rule = EdgeRule::kThreshold, .threshold = 1}, "threshold"}};
  for (const auto& [options, key] : bad) {
    try {
      joined(places, 1, options);
      FAIL() << key;
    } catch (const InputError& error) {
      EXPECT_NE(error.found().find(key), std::string::npos) << error.found();
    }
  }
  EXPECT_THROW(joined(places, 0), InputError);
}

TEST(NodeGraph, CancellingStopsIt) {
  std::atomic<bool> cancel = true;
  RunOptions run;
  run.cancel = &cancel;
  EXPECT_FALSE(join_nodes(random_places(1000000, 1), 0.01, {}, nullptr, {}, run));
}

}  // namespace
}  // namespace cambium
