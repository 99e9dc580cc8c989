#include "skeletons/graph/node_graph.h"

#include "blobtree/input_error.h"
#include "skeletons/graph/component_repair.h"
#include "skeletons/graph/node_chunks.h"
#include "skeletons/graph/node_grid.h"
#include "skeletons/number_checks.h"

#include <algorithm>
#include <array>
#include <atomic>
#include <cmath>
#include <numeric>
#include <string>

namespace cambium {
namespace {

constexpr std::uint32_t kNone = 0xffffffff;
constexpr std::size_t kGrain = 2048;   // nodes, some milliseconds
constexpr double kGridSide = 1.5;     // spacings: little more than a node to a cell
/// Within that many spacings, times the cube root of the sectors, nine nodes are in a sector on average.
constexpr double kYaoReach = 1.5;

/// The nearest node of each sector around a node, of those that were offered.
class NearestInSectors {
 public:
  /// How far a row of cells along x is still of interest, squared; by the signs of y and z from the node to it, each 0, 1 (none) or 2.
  using RowBounds = std::array<std::array<double, 3>, 3>;

  NearestInSectors(std::span<const Vec3> directions, double reach) : directions_(directions), reach2_(reach * reach) {}

  void clear() {
    std::fill_n(distance2_.begin(), directions_.size(), reach2_);
    std::fill_n(node_.begin(), directions_.size(), kNone);
    farthest2_ = reach2_;
  }
  template <class Allowed>
  void offer(std::uint32_t node, const Vec3& way, const Allowed& allowed) {
    const double d2 = glm::dot(way, way);
    if (d2 > farthest2_) return;
    const std::size_t sector = sector_of(way);
    if (d2 > distance2_[sector] || (d2 == distance2_[sector] && node > node_[sector]) || d2 == 0 || !allowed(node)) return;
    distance2_[sector] = d2;
    node_[sector] = node;
  }
  /// Squared; beyond it nothing is of interest any more.
  double farthest2() { return farthest2_ = *std::max_element(distance2_.begin(), distance2_.begin() + std::ptrdiff_t(directions_.size())); }
  RowBounds row_bounds() const {
    RowBounds bounds{};
    if (!has_octants()) {
      for (auto& of_y : bounds) of_y.fill(farthest2_);
      return bounds;
    }
    for (std::size_t octant = 0; octant < 8; ++octant)
      for (const std::size_t y : {std::size_t{1}, octant & 2 ? std::size_t{0} : std::size_t{2}})
        for (const std::size_t z : {std::size_t{1}, octant & 4 ? std::size_t{0} : std::size_t{2}})
          bounds[y][z] = std::max(bounds[y][z], distance2_[octant]);
    return bounds;
  }
  std::span<const std::uint32_t> nodes() const { return {node_.data(), directions_.size()}; }

 private:
  bool has_octants() const { return directions_.size() == 8; }
  std::size_t sector_of(const Vec3& way) const { return has_octants() ? yao_octant(way) : std::size_t(yao_sector(directions_, way)); }

  std::span<const Vec3> directions_;
  double reach2_, farthest2_ = 0;
  std::array<double, 64> distance2_;
  std::array<std::uint32_t, 64> node_;
};

/// Offers nodes from the inside out, until none that is farther can be of interest.
template <class Allowed>
void search_around(std::uint32_t u, std::span<const Vec3> positions, const NodeGrid& grid, const Allowed& allowed, NearestInSectors& nearest) {
  const Vec3& p = positions[u];
  const NodeGrid::Cell cell = grid.cell_of(p);
  nearest.clear();
  for (int ring = 0;; ++ring) {
    const NearestInSectors::RowBounds bounds = nearest.row_bounds();
    const auto sign = [](int away) { return static_cast<std::size_t>(1 + (away > 0) - (away < 0)); };
    const auto skips = [&](int dy, int dz) {
      const double y = grid.distance_to(p, cell, 1, dy), z = grid.distance_to(p, cell, 2, dz);
      return y * y + z * z > bounds[sign(dy)][sign(dz)] * (1 + 1e-12);
    };
    grid.visit_ring(cell, ring, skips, [&](std::uint32_t v) { nearest.offer(v, positions[v] - p, allowed); });
    const double clearance = grid.clearance(p, cell, ring);
    if (clearance * clearance > nearest.farthest2()) return;
  }
}

/// Edges that start at a node, a fixed number of places for each, kNone where there is none.
struct Arcs {
  std::size_t places;
  std::vector<std::uint32_t> to;

  std::span<const std::uint32_t> of(std::uint32_t node) const { return {to.data() + node * places, places}; }
  bool leads(std::uint32_t from, std::uint32_t node) const {
    const auto arcs = of(from);
    return std::find(arcs.begin(), arcs.end(), node) != arcs.end();
  }
};

double yao_reach(const NodeGrid& grid, double spacing, int sectors) {
  return kYaoReach * std::cbrt(sectors) * std::max(spacing, grid.natural_spacing());
}

std::optional<Arcs> yao_arcs(const JoinRules& rules, double spacing, int sectors, const RunOptions& run) {
  const std::vector<Vec3> directions = yao_directions(sectors);
  const std::span<const Vec3> positions = rules.positions;
  const NodeGrid grid(positions, kGridSide * spacing);
  const double reach = yao_reach(grid, spacing, sectors);
  Arcs arcs{directions.size(), std::vector<std::uint32_t>(positions.size() * directions.size(), kNone)};
  const bool finished = in_node_chunks(positions.size(), kGrain, run, [&](std::size_t begin, std::size_t end) {
    NearestInSectors nearest(directions, reach);
    for (auto u = static_cast<std::uint32_t>(begin); u < end; ++u) {
      search_around(u, positions, grid, [&](std::uint32_t v) { return rules.allow(u, v); }, nearest);
      std::copy(nearest.nodes().begin(), nearest.nodes().end(), arcs.to.begin() + static_cast<std::ptrdiff_t>(u * arcs.places));
    }
  });
  if (!finished) return std::nullopt;
  return arcs;
}

/// From counts of what nodes have to where it begins, counts[n] being that of node n - 1; counts[0] is 0.
void begin_each(std::vector<std::uint32_t>& counts) { std::partial_sum(counts.begin(), counts.end(), counts.begin()); }

bool sort_neighbours(NodeGraph& graph, const RunOptions& run) {
  return in_node_chunks(graph.nodes(), kGrain, run, [&](std::size_t begin, std::size_t end) {
    for (std::size_t n = begin; n < end; ++n) std::sort(graph.to.begin() + graph.first[n], graph.to.begin() + graph.first[n + 1]);
  });
}

/// Each arc as an edge both ways.
std::optional<NodeGraph> both_ways(const Arcs& arcs, std::size_t nodes, const RunOptions& run) {
  NodeGraph graph;
  graph.first.assign(nodes + 1, 0);
  std::vector<std::uint32_t> returns(nodes, 0);   // arcs to a node that it has not itself
  const auto of_each_arc = [&](const auto& visit) {
    return in_node_chunks(nodes, kGrain, run, [&](std::size_t begin, std::size_t end) {
      for (auto u = static_cast<std::uint32_t>(begin); u < end; ++u) {
        std::uint32_t i = 0;
        for (const std::uint32_t v : arcs.of(u))
          if (v != kNone) visit(u, v, i++);
      }
    });
  };
  const auto count = [](std::uint32_t& counter, std::uint32_t by) {
    return std::atomic_ref<std::uint32_t>(counter).fetch_add(by, std::memory_order_relaxed);
  };
  if (!of_each_arc([&](std::uint32_t u, std::uint32_t v, std::uint32_t) {
        count(graph.first[u + 1], 1);
        if (!arcs.leads(v, u)) count(graph.first[v + 1], 1), count(returns[v], 1);
      }))
    return std::nullopt;
  begin_each(graph.first);
  graph.to.resize(graph.first.back());
  // A node's own arcs come first, returns are put in from its end backwards.
  if (!of_each_arc([&](std::uint32_t u, std::uint32_t v, std::uint32_t i) {
        graph.to[graph.first[u] + i] = v;
        if (!arcs.leads(v, u)) graph.to[graph.first[v + 1] - count(returns[v], kNone)] = u;   // counts down
      }))
    return std::nullopt;
  if (!sort_neighbours(graph, run)) return std::nullopt;
  return graph;
}

std::optional<NodeGraph> yao_graph(const JoinRules& rules, double spacing, int sectors, const RunOptions& run) {
  const std::optional<Arcs> arcs = yao_arcs(rules, spacing, sectors, run);
  if (!arcs) return std::nullopt;
  return both_ways(*arcs, rules.positions.size(), run);
}

std::optional<NodeGraph> near_pairs(const JoinRules& rules, double longest, const RunOptions& run) {
  const std::span<const Vec3> positions = rules.positions;
  const NodeGrid grid(positions, longest);
  NodeGraph graph;
  graph.first.assign(positions.size() + 1, 0);
  const auto of_each_pair = [&](const auto& visit) {
    return in_node_chunks(positions.size(), kGrain, run, [&](std::size_t begin, std::size_t end) {
      for (auto u = static_cast<std::uint32_t>(begin); u < end; ++u) {
        const NodeGrid::Cell cell = grid.cell_of(positions[u]);
        for (int ring = 0;; ++ring) {
          grid.visit_ring(cell, ring, [](int, int) { return false; }, [&](std::uint32_t v) {
            const Vec3 way = positions[v] - positions[u];
            if (v != u && glm::dot(way, way) <= longest * longest && rules.allow(u, v)) visit(u, v);
          });
          if (grid.clearance(positions[u], cell, ring) > longest) break;
        }
      }
    });
  };
  if (!of_each_pair([&](std::uint32_t u, std::uint32_t) { ++graph.first[u + 1]; })) return std::nullopt;
  begin_each(graph.first);
  graph.to.resize(graph.first.back());
  std::vector<std::uint32_t> found(positions.size(), 0);
  if (!of_each_pair([&](std::uint32_t u, std::uint32_t v) { graph.to[graph.first[u] + found[u]++] = v; })) return std::nullopt;
  if (!sort_neighbours(graph, run)) return std::nullopt;
  return graph;
}

}  // namespace

double longest_yao_edge(std::span<const Vec3> positions, double spacing, int sectors) {
  return yao_reach(NodeGrid(positions, kGridSide * spacing), spacing, sectors);
}

std::optional<NodeGraph> join_nodes(std::span<const Vec3> positions, double spacing, std::span<const std::uint16_t> parts,
                                    const Obstacles* obstacles, const EdgeOptions& options, const RunOptions& run) {
  require_positive(spacing, "spacing");
  if (options.rule == EdgeRule::kThreshold) require_number(options.threshold > 1, "threshold", options.threshold, "more than 1");
  const JoinRules rules{positions, parts, obstacles};
  std::optional<NodeGraph> graph = options.rule == EdgeRule::kThreshold ? near_pairs(rules, options.threshold * spacing, run)
                                                                        : yao_graph(rules, spacing, options.sectors, run);
  if (!graph || !reach_all(*graph, rules, spacing, run)) return std::nullopt;
  return graph;
}

}  // namespace cambium
