#include "skeletons/graph/least_cost.h"

#include "skeletons/graph/monotone_queue.h"

namespace cambium {
namespace {

constexpr std::uint32_t kNone = 0xffffffff;
constexpr std::size_t kPollEvery = 4096;   // nodes, some milliseconds

}  // namespace

std::optional<LeastCostPaths> least_cost_paths(std::span<const Vec3> positions, const NodeGraph& graph, const EdgeWeights& weights,
                                               std::uint64_t seed, const RunOptions& run) {
  const std::size_t n = graph.nodes();
  LeastCostPaths paths{std::vector<std::uint32_t>(n, kNone), std::vector<double>(n, kInfinity)};
  if (n == 0) return paths;
  MonotoneQueue queue;
  paths.next[0] = 0;
  paths.cost[0] = 0;
  queue.push(0, 0);
  for (std::size_t taken = 1; !queue.empty(); ++taken) {
    if (taken % kPollEvery == 0 && run.cancelled()) return std::nullopt;
    const auto [cost, u] = queue.take();
    if (cost > paths.cost[u]) continue;                 // a cheaper way has been found since
    for (const std::uint32_t v : graph.of(u)) {
      if (paths.cost[v] <= cost) continue;              // no way over u can be cheaper
      const double through = cost + weights.of(seed, u, v, positions[u], positions[v]);
      if (through < paths.cost[v]) {
        paths.cost[v] = through;
        paths.next[v] = u;
        queue.push(through, v);
      } else if (through == paths.cost[v] && u < paths.next[v]) {
        paths.next[v] = u;
      }
    }
  }
  return paths;
}

}  // namespace cambium
