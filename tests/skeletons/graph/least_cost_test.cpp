#include "skeletons/graph/least_cost.h"

#include "tests/skeletons/graph/node_clouds.h"

#include <boost/graph/adjacency_list.hpp>
#include <boost/graph/dijkstra_shortest_paths.hpp>
#include <gtest/gtest.h>

#include <atomic>
#include <utility>

namespace cambium {
namespace {

using namespace testing;
using BoostGraph = boost::adjacency_list<boost::vecS, boost::vecS, boost::undirectedS, boost::no_property, boost::property<boost::edge_weight_t, double>>;

struct Joined {
  std::vector<Vec3> positions;
  NodeGraph graph;
};

Joined strewn_and_joined(std::size_t count, std::uint64_t seed, const EdgeOptions& options = {}) {
  PoissonDiscNodes nodes = poisson_disc(ball(1), {}, {.count = count, .seed = seed}, threads(1)).value();
  NodeGraph graph = join_nodes(nodes.positions, nodes.spacing, {}, nullptr, options, threads(1)).value();
  return {std::move(nodes.positions), std::move(graph)};
}

std::vector<double> costs_of_boost(const Joined& joined, const EdgeWeights& weights, std::uint64_t seed) {
  BoostGraph graph(joined.positions.size());
  for (std::uint32_t u = 0; u < joined.graph.nodes(); ++u)
    for (const std::uint32_t v : joined.graph.of(u))
      if (u < v) boost::add_edge(u, v, double(weights.of(seed, u, v, joined.positions[u], joined.positions[v])), graph);
  std::vector<double> costs(joined.positions.size());
  boost::dijkstra_shortest_paths(graph, boost::vertex(0, graph), boost::distance_map(costs.data()));
  return costs;
}

TEST(LeastCost, PathsCostAsMuchAsThoseOfBoost) {
  const WeightPaint paint({{.center = {2, 1, -3}, .radius = 0.8, .factor = 5}}, nullptr);
  const EdgeWeights kinds[] = {{}, {.low = 0.3, .high = 2, .times_length = true}, {.paint = &paint}, {.low = 1, .high = 1}};
  for (const std::size_t count : {30u, 500u, 20000u})
    for (const EdgeWeights& weights : kinds)
      for (const EdgeOptions& options : {EdgeOptions{}, EdgeOptions{.rule = EdgeRule::kThreshold}}) {
        const Joined joined = strewn_and_joined(count, 7, options);
        const LeastCostPaths paths = least_cost_paths(joined.positions, joined.graph, weights, 11, {}).value();
        EXPECT_EQ(paths.cost, costs_of_boost(joined, weights, 11));
      }
}

TEST(LeastCost, EachStepLeadsToTheLowestNodeThatIsOnACheapestWay) {
  for (const EdgeWeights& weights : {EdgeWeights{}, EdgeWeights{.low = 1, .high = 1}}) {
    const Joined joined = strewn_and_joined(3000, 2);
    const LeastCostPaths paths = least_cost_paths(joined.positions, joined.graph, weights, 5, {}).value();
    EXPECT_EQ(paths.next[0], 0u);
    EXPECT_EQ(paths.cost[0], 0);
    for (std::uint32_t u = 1; u < joined.graph.nodes(); ++u) {
      std::uint32_t lowest = 0xffffffff;
      for (const std::uint32_t v : joined.graph.of(u)) {
        const double cost = paths.cost[v] + weights.of(5, u, v, joined.positions[u], joined.positions[v]);
        EXPECT_GE(cost, paths.cost[u]);
        if (cost == paths.cost[u]) lowest = std::min(lowest, v);
      }
      EXPECT_EQ(paths.next[u], lowest);
    }
  }
}

TEST(LeastCost, OtherSeedsLeadOtherWays) {
  const Joined joined = strewn_and_joined(1000, 2);
  EXPECT_NE(least_cost_paths(joined.positions, joined.graph, {}, 1, {})->next, least_cost_paths(joined.positions, joined.graph, {}, 2, {})->next);
}

TEST(LeastCost, OfNoNodesOrOneIsNothingOrFree) {
  EXPECT_TRUE(least_cost_paths({}, NodeGraph{{0}, {}}, {}, 1, {})->next.empty());
  const Vec3 root[] = {{0, 0, 0}};
  EXPECT_EQ(least_cost_paths(root, NodeGraph{{0, 0}, {}}, {}, 1, {})->next, std::vector<std::uint32_t>{0});
}

TEST(LeastCost, CancellingStopsIt) {
  const Joined joined = strewn_and_joined(20000, 1);
  std::atomic<bool> cancel = true;
  RunOptions run;
  run.cancel = &cancel;
  EXPECT_FALSE(least_cost_paths(joined.positions, joined.graph, {}, 1, run));
}

}  // namespace
}  // namespace cambium
