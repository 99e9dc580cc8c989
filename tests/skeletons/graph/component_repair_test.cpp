#include "skeletons/graph/component_repair.h"

#include "tests/skeletons/graph/node_clouds.h"

#include <gtest/gtest.h>

#include <atomic>

namespace cambium {
namespace {

using namespace testing;

NodeGraph without_edges(std::size_t nodes) { return {std::vector<std::uint32_t>(nodes + 1, 0), {}}; }

double length_of_edges(const NodeGraph& graph, std::span<const Vec3> places) {
  double sum = 0;
  for (std::uint32_t u = 0; u < graph.nodes(); ++u)
    for (const std::uint32_t v : graph.of(u)) sum += 0.5 * glm::length(places[u] - places[v]);
  return sum;
}

/// Of the shortest tree over all places (Prim 1957).
double length_of_shortest_tree(std::span<const Vec3> places) {
  std::vector<double> away(places.size(), kInfinity);
  std::vector<bool> in_tree(places.size());
  double sum = 0;
  std::size_t last = 0;
  for (std::size_t count = 1; count < places.size(); ++count) {
    in_tree[last] = true;
    std::size_t nearest = places.size();
    for (std::size_t i = 0; i < places.size(); ++i) {
      if (in_tree[i]) continue;
      away[i] = std::min(away[i], glm::length(places[i] - places[last]));
      if (nearest == places.size() || away[i] < away[nearest]) nearest = i;
    }
    sum += away[nearest];
    last = nearest;
  }
  return sum;
}

TEST(ComponentRepair, OfNodesWithoutEdgesIsTheShortestTree) {
  for (const std::size_t count : {2u, 17u, 300u, 1500u}) {
    const std::vector<Vec3> places = random_places(count, static_cast<unsigned>(count));
    NodeGraph graph = without_edges(count);
    ASSERT_TRUE(reach_all(graph, {places, {}, nullptr}, 1e-3, {}));
    EXPECT_EQ(graph.repaired, count - 1);
    EXPECT_EQ(graph.edges(), count - 1);
    EXPECT_NEAR(length_of_edges(graph, places), length_of_shortest_tree(places), 1e-9);
  }
}

TEST(ComponentRepair, LeavesAGraphThatIsWholeAsItIs) {
  const std::vector<Vec3> places = random_places(3, 1);
  NodeGraph graph{{0, 1, 3, 4}, {1, 0, 2, 1}};
  const std::vector<std::uint32_t> before = graph.to;
  ASSERT_TRUE(reach_all(graph, {places, {}, nullptr}, 1, {}));
  EXPECT_EQ(graph.repaired, 0u);
  EXPECT_EQ(graph.to, before);
}

TEST(ComponentRepair, CancellingStopsIt) {
  const std::vector<Vec3> places = random_places(100000, 1);
  NodeGraph graph = without_edges(places.size());
  std::atomic<bool> cancel = true;
  RunOptions run;
  run.cancel = &cancel;
  EXPECT_FALSE(reach_all(graph, {places, {}, nullptr}, 1, run));
}

}  // namespace
}  // namespace cambium
