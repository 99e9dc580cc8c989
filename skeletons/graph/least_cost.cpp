#include "skeletons/graph/least_cost.h"

#include <limits>
#include <queue>
#include <tuple>

namespace cambium {
namespace {

constexpr std::uint32_t kNone = std::numeric_limits<std::uint32_t>::max();
constexpr std::size_t kPollEvery = 4096;   // nodes, some milliseconds

/// A way to a node, not known yet to be the cheapest.
struct Offer {
  double cost;
  std::uint32_t node;
  bool operator>(const Offer& other) const { return std::tie(cost, node) > std::tie(other.cost, other.node); }
};

}  // namespace

std::optional<LeastCostPaths> least_cost_paths(std::span<const Vec3> positions, const NodeGraph& graph, const EdgeWeights& weights,
                                               std::uint64_t seed, const RunOptions& run) {
  const std::size_t n = graph.nodes();
  LeastCostPaths paths{std::vector<std::uint32_t>(n, kNone), std::vector<double>(n, kInfinity)};
  if (n == 0) return paths;
  std::vector<bool> is_final(n);
  std::priority_queue<Offer, std::vector<Offer>, std::greater<>> offers;
  paths.next[0] = 0;
  paths.cost[0] = 0;
  offers.push({0, 0});
  for (std::size_t settled = 0; !offers.empty();) {
    const Offer best = offers.top();
    offers.pop();
    const std::uint32_t u = best.node;
    if (is_final[u]) continue;
    is_final[u] = true;
    if (++settled % kPollEvery == 0 && run.cancelled()) return std::nullopt;
    for (const std::uint32_t v : graph.of(u)) {
      if (is_final[v]) continue;
      const double cost = best.cost + weights.of(seed, u, v, positions[u], positions[v]);
      if (cost < paths.cost[v]) {
        paths.cost[v] = cost;
        paths.next[v] = u;
        offers.push({cost, v});
      } else if (cost == paths.cost[v] && u < paths.next[v]) {
        paths.next[v] = u;
      }
    }
  }
  return paths;
}

}  // namespace cambium
