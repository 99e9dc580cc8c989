#include "skeletons/graph/graph_paths.h"

#include "skeletons/graph/endpoints.h"
#include "skeletons/graph/least_cost.h"
#include "skeletons/graph/poisson_disc.h"

#include <algorithm>

namespace cambium {
namespace {

/// What a graph's stream is drawn from for.
enum Purpose : std::uint64_t { kNodes = 1, kWeights, kEndpoints };

constexpr std::uint32_t kUnseen = ~std::uint32_t{0};

/// The union of ways to the root, gathered one way after the other.
class PathTree {
 public:
  PathTree(std::span<const Vec3> positions, const LeastCostPaths& ways) : positions_(positions), ways_(ways), index_(positions.size(), kUnseen) {
    paths_.positions.push_back(positions[0]);
    paths_.parents.push_back(0);
    index_[0] = 0;
  }

  void add(std::uint32_t endpoint) {
    way_.clear();
    for (std::uint32_t node = endpoint; index_[node] == kUnseen; node = ways_.next[node]) way_.push_back(node);
    for (auto node = way_.rbegin(); node != way_.rend(); ++node) {
      index_[*node] = static_cast<std::uint32_t>(paths_.positions.size());
      paths_.positions.push_back(positions_[*node]);
      paths_.parents.push_back(index_[ways_.next[*node]]);
    }
    paths_.endpoints.push_back(index_[endpoint]);
  }

  GraphPaths take() { return std::move(paths_); }

 private:
  std::span<const Vec3> positions_;
  const LeastCostPaths& ways_;
  std::vector<std::uint32_t> index_;     ///< in the paths, by node
  std::vector<std::uint32_t> way_;
  GraphPaths paths_;
};

std::vector<std::uint16_t> parts_of(const GraphVolume& volume, std::span<const Vec3> positions) {
  std::vector<std::uint16_t> parts;
  if (volume.parts() == 1) return parts;
  for (const Vec3& p : positions) parts.push_back(volume.part_of(p));
  parts[0] = 0;   // all subvolumes lead to the root
  return parts;
}

/// The node at the far end of a taproot: as far as can be from the root towards the volume's middle and beyond.
std::uint32_t taproot_end(const GraphVolume& volume, std::span<const Vec3> positions) {
  const Vec3 along = volume.bounds().center() - positions[0];
  const auto far = std::max_element(positions.begin(), positions.end(),
                                    [&](const Vec3& a, const Vec3& b) { return glm::dot(a, along) < glm::dot(b, along); });
  return static_cast<std::uint32_t>(far - positions.begin());
}

std::vector<std::uint32_t> way_from(std::uint32_t node, const LeastCostPaths& ways) {
  std::vector<std::uint32_t> way{node};
  while (way.back() != 0) way.push_back(ways.next[way.back()]);
  return way;
}

/// Those given, then those drawn.
std::vector<std::uint32_t> endpoints_of(const GraphTask& task, std::span<const Vec3> positions, std::span<const std::uint16_t> parts,
                                        const LeastCostPaths& ways) {
  const auto given = static_cast<std::uint32_t>(task.level->given_endpoints.size());
  const auto count = static_cast<std::size_t>(task.endpoints);
  const std::uint64_t stream = hash_of(task.stream, kEndpoints);
  std::vector<std::uint32_t> endpoints, drawn;
  for (std::uint32_t i = 1; i <= given; ++i) endpoints.push_back(i);
  if (task.level->placement == EndpointPlacement::kTaproot && positions.size() > 1) {
    const std::uint32_t end = taproot_end(*task.volume, positions);
    endpoints.push_back(end);
    drawn = draw_endpoints_around(positions, way_from(end, ways), task.shell, count, stream);
    std::erase_if(drawn, [&](std::uint32_t node) { return node <= given; });
  } else {
    const double shell = task.level->placement == EndpointPlacement::kShell ? task.shell : 0;
    drawn = draw_endpoints(*task.volume, positions, {parts, given + std::size_t{1}, shell}, count, stream);
  }
  endpoints.insert(endpoints.end(), drawn.begin(), drawn.end());
  return endpoints;
}

}  // namespace

std::optional<GraphPaths> plan_graph(const GraphTask& task, const GraphRules& rules, const RunOptions& run) {
  std::vector<Vec3> given{task.root};
  given.insert(given.end(), task.level->given_endpoints.begin(), task.level->given_endpoints.end());
  const auto nodes = poisson_disc(*task.volume, given, {task.level->nodes, task.level->spacing, hash_of(task.stream, kNodes)}, run);
  if (!nodes) return std::nullopt;
  const std::span<const Vec3> positions = nodes->positions;
  const auto parts = parts_of(*task.volume, positions);
  const auto graph = join_nodes(positions, nodes->spacing, parts, task.volume->obstacles().get(), rules.edges, run);
  if (!graph) return std::nullopt;
  const auto ways = least_cost_paths(positions, *graph, rules.weights, hash_of(task.stream, kWeights), run);
  if (!ways) return std::nullopt;

  PathTree tree(positions, *ways);
  const auto endpoints = endpoints_of(task, positions, parts, *ways);
  for (const std::uint32_t endpoint : endpoints) tree.add(endpoint);
  GraphPaths paths = tree.take();
  paths.nodes = positions.size();
  paths.edges = graph->edges();
  paths.repaired = graph->repaired;
  const std::size_t wanted = given.size() - 1 + static_cast<std::size_t>(task.endpoints);
  paths.endpoints_missing = wanted > endpoints.size() ? wanted - endpoints.size() : 0;
  return paths;
}

}  // namespace cambium
