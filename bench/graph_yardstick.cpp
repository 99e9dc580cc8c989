#include "bench/graph_yardstick.h"

#include <algorithm>
#include <array>
#include <boost/graph/adjacency_list.hpp>
#include <boost/graph/dijkstra_shortest_paths.hpp>
#include <cmath>
#include <memory>
#include <nanoflann.hpp>
#include <random>
#include <set>
#include <unordered_map>
#include <utility>
#include <vector>

#include "bench/clock.h"
#include "skeletons/graph/edge_weights.h"
#include "skeletons/graph/node_graph.h"

namespace cambium::bench {
namespace {

constexpr std::size_t kDartsForNode = 2000;

class HashGrid {
 public:
  explicit HashGrid(double side) : side_(side) {}

  void add(const Vec3& p) { cells_[key(cell_of(p))].push_back(p); }
  bool holds_nearer(const Vec3& p, double distance) const {
    const Cell c = cell_of(p);
    for (int i = 0; i < 27; ++i) {
      const auto found = cells_.find(key({c[0] + i % 3 - 1, c[1] + i / 3 % 3 - 1, c[2] + i / 9 - 1}));
      if (found == cells_.end()) continue;
      for (const Vec3& q : found->second)
        if (glm::dot(p - q, p - q) < distance * distance) return true;
    }
    return false;
  }

 private:
  using Cell = std::array<std::int64_t, 3>;
  Cell cell_of(const Vec3& p) const { return {std::llround(p.x / side_), std::llround(p.y / side_), std::llround(p.z / side_)}; }
  static std::uint64_t key(const Cell& c) {
    return hash_of(0, static_cast<std::uint64_t>(c[0]) << 32 ^ static_cast<std::uint64_t>(c[1]), static_cast<std::uint64_t>(c[2]));
  }

  double side_;
  std::unordered_map<std::uint64_t, std::vector<Vec3>> cells_;
};

std::vector<Vec3> strewn(const GraphVolume& volume, std::size_t count, double spacing, std::uint64_t seed) {
  std::mt19937_64 random(seed);
  std::uniform_real_distribution<double> unit(0, 1);
  HashGrid grid(spacing);
  std::vector<Vec3> nodes;
  for (std::size_t dart = 0; nodes.size() < count && dart < kDartsForNode * count; ++dart) {
    Vec3 p;
    for (int k = 0; k < 3; ++k) p[k] = volume.bounds().lo[k] + volume.bounds().size()[k] * unit(random);
    if (!volume.contains(p) || grid.holds_nearer(p, spacing)) continue;
    grid.add(p);
    nodes.push_back(p);
  }
  return nodes;
}

struct Cloud {
  const std::vector<Vec3>& nodes;
  std::size_t kdtree_get_point_count() const { return nodes.size(); }
  double kdtree_get_pt(std::size_t i, std::size_t k) const { return nodes[i][static_cast<int>(k)]; }
  template <class Bounds>
  bool kdtree_get_bbox(Bounds&) const {
    return false;
  }
};

using Edges = std::set<std::pair<std::uint32_t, std::uint32_t>>;

Edges yao_edges(const std::vector<Vec3>& nodes, double longest) {
  using Tree = nanoflann::KDTreeSingleIndexAdaptor<nanoflann::L2_Simple_Adaptor<double, Cloud>, Cloud, 3, std::uint32_t>;
  const Cloud cloud{nodes};
  Tree tree(3, cloud, nanoflann::KDTreeSingleIndexAdaptorParams(10));
  tree.buildIndex();
  Edges edges;
  std::vector<std::pair<std::uint32_t, double>> near;
  for (std::uint32_t u = 0; u < nodes.size(); ++u) {
    near.clear();
    tree.radiusSearch(&nodes[u].x, longest * longest, near, nanoflann::SearchParams(32, 0, true));
    std::array<bool, 8> filled{};
    for (const auto& [v, d2] : near) {   // the nearest first
      if (v == u) continue;
      const std::size_t octant = yao_octant(nodes[v] - nodes[u]);
      if (std::exchange(filled[octant], true)) continue;
      edges.insert({std::min(u, v), std::max(u, v)});
    }
  }
  return edges;
}

double farthest(const std::vector<Vec3>& nodes, const Edges& edges, std::uint64_t seed) {
  using Graph = boost::adjacency_list<boost::vecS, boost::vecS, boost::undirectedS, boost::no_property,
                                      boost::property<boost::edge_weight_t, double>>;
  const EdgeWeights weights;
  Graph graph(nodes.size());
  for (const auto& [u, v] : edges) boost::add_edge(u, v, double(weights.of(seed, u, v, nodes[u], nodes[v])), graph);
  std::vector<double> costs(nodes.size());
  std::vector<Graph::vertex_descriptor> next(nodes.size());
  boost::dijkstra_shortest_paths(graph, boost::vertex(0, graph), boost::distance_map(costs.data()).predecessor_map(next.data()));
  return *std::max_element(costs.begin(), costs.end());
}

}  // namespace

GraphSeconds straightforward_graph(const GraphVolume& volume, std::size_t count, double spacing, std::uint64_t seed) {
  GraphSeconds seconds;
  const std::vector<Vec3> nodes = timed(seconds.nodes, [&] { return strewn(volume, count, spacing, seed); });
  const Edges edges = timed(seconds.edges, [&] { return yao_edges(nodes, 3 * spacing); });
  timed(seconds.paths, [&] { return farthest(nodes, edges, seed); });
  return seconds;
}

}  // namespace cambium::bench
