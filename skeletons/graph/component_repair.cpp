#include "skeletons/graph/component_repair.h"

#include <numeric>
#include <optional>
#include <tuple>
#include <utility>
#include <vector>

namespace cambium {
namespace {

constexpr std::uint32_t kNone = 0xffffffff;
constexpr std::uint32_t kMixed = kNone;
constexpr std::uint32_t kLeaf = 16;            // nodes
constexpr double kAllowedReach = 8;            // spacings
constexpr std::size_t kPollSearches = 1024, kPollNodes = 65536;

using Edge = std::pair<std::uint32_t, std::uint32_t>;

/// The components of a graph, numbered from that of node 0 on.
struct Components {
  std::vector<std::uint32_t> of;
  std::uint32_t count = 0;
};

/// Nullopt if cancelled.
std::optional<Components> components_of(const NodeGraph& graph, const RunOptions& run) {
  Components components{std::vector<std::uint32_t>(graph.nodes(), kNone)};
  std::vector<std::uint32_t> waiting;
  std::size_t seen = 0;
  for (std::uint32_t start = 0; start < graph.nodes(); ++start) {
    if (components.of[start] != kNone) continue;
    const std::uint32_t component = components.count++;
    components.of[start] = component;
    waiting.push_back(start);
    while (!waiting.empty()) {
      const std::uint32_t u = waiting.back();
      waiting.pop_back();
      if (++seen % kPollNodes == 0 && run.cancelled()) return std::nullopt;
      for (const std::uint32_t v : graph.of(u))
        if (components.of[v] == kNone) components.of[v] = component, waiting.push_back(v);
    }
  }
  return components;
}

/// The cheapest edge found so far; of equally long ones the lowest.
struct Link {
  double distance2 = kInfinity;
  Edge edge{kNone, kNone};
  bool operator<(const Link& other) const { return std::tie(distance2, edge) < std::tie(other.distance2, other.edge); }
};

/// Halves nodes at the median of the longest side of their box, and knows of each half whether it is all of one component: to find
/// the nearest node that is of another (a k-d tree in the manner of minimum spanning trees; Bentley and Friedman 1978).
class StrangerTree {
 public:
  /// Cancelled, it is of no use.
  StrangerTree(std::span<const Vec3> positions, const RunOptions& run) : positions_(positions), run_(run), order_(positions.size()) {
    std::iota(order_.begin(), order_.end(), 0u);
    halve(0, static_cast<std::uint32_t>(order_.size()));
  }

  void set_components(std::span<const std::uint32_t> component) {
    component_ = component;
    for (std::size_t i = halves_.size(); i-- > 0;) {
      Half& half = halves_[i];
      if (half.second != 0) {
        const std::uint32_t a = halves_[i + 1].component, b = halves_[half.second].component;
        half.component = a == b ? a : kMixed;
      } else {
        half.component = component_[order_[half.begin]];
        for (std::uint32_t k = half.begin; k < half.end; ++k)
          if (component_[order_[k]] != half.component) half.component = kMixed;
      }
    }
  }

  /// Makes `best` the shortest edge from u to another component, if it is shorter.
  template <class Allow>
  void shorten(std::uint32_t u, Link& best, const Allow& allow) const { search(0, u, best, allow); }

 private:
  struct Half {
    Box box;
    std::uint32_t begin, end;
    std::uint32_t second = 0;          // the first half follows at once; 0: a leaf
    std::uint32_t component = kMixed;
  };

  std::uint32_t halve(std::uint32_t begin, std::uint32_t end) {
    const auto index = static_cast<std::uint32_t>(halves_.size());
    Half half{{}, begin, end};
    for (std::uint32_t k = begin; k < end; ++k) half.box.extend(positions_[order_[k]]);
    halves_.push_back(half);
    if (end - begin <= kLeaf || run_.cancelled()) return index;
    const Vec3 size = half.box.size();
    const int axis = size.x >= size.y && size.x >= size.z ? 0 : size.y >= size.z ? 1 : 2;
    const std::uint32_t middle = begin + (end - begin) / 2;
    const auto at = [&](std::uint32_t k) { return order_.begin() + k; };
    std::nth_element(at(begin), at(middle), at(end), [&](std::uint32_t a, std::uint32_t b) { return positions_[a][axis] < positions_[b][axis]; });
    halve(begin, middle);
    const std::uint32_t second = halve(middle, end);
    halves_[index].second = second;
    return index;
  }

  double distance2(std::uint32_t half, const Vec3& p) const {
    const Vec3 way = p - glm::clamp(p, halves_[half].box.lo, halves_[half].box.hi);
    return glm::dot(way, way);
  }

  template <class Allow>
  void search(std::uint32_t index, std::uint32_t u, Link& best, const Allow& allow) const {
    const Half& half = halves_[index];
    if (half.component == component_[u] || distance2(index, positions_[u]) > best.distance2) return;
    if (half.second != 0) {
      const bool second_first = distance2(half.second, positions_[u]) < distance2(index + 1, positions_[u]);
      search(second_first ? half.second : index + 1, u, best, allow);
      search(second_first ? index + 1 : half.second, u, best, allow);
      return;
    }
    for (std::uint32_t k = half.begin; k < half.end; ++k) {
      const std::uint32_t v = order_[k];
      if (component_[v] == component_[u]) continue;
      const Vec3 way = positions_[v] - positions_[u];
      const Link link{glm::dot(way, way), {std::min(u, v), std::max(u, v)}};
      if (link < best && allow(u, v)) best = link;
    }
  }

  std::span<const Vec3> positions_;
  const RunOptions& run_;
  std::span<const std::uint32_t> component_;
  std::vector<std::uint32_t> order_;
  std::vector<Half> halves_;
};

/// Of each component but the first, the shortest edge that leads out of it; shorter than `bound`.
template <class Allow>
bool links_out(const Components& components, const StrangerTree& tree, double bound, const Allow& allow, std::vector<Link>& links,
               const RunOptions& run) {
  std::vector<bool> wanted(components.count);
  for (std::uint32_t c = 1; c < components.count; ++c)
    if (links[c].edge.first == kNone) wanted[c] = true, links[c].distance2 = bound * bound;
  std::size_t searches = 0;
  for (std::uint32_t u = 0; u < components.of.size(); ++u) {
    const std::uint32_t c = components.of[u];
    if (!wanted[c]) continue;
    if (++searches % kPollSearches == 0 && run.cancelled()) return false;
    tree.shorten(u, links[c], allow);
  }
  return true;
}

/// Those that join what was not joined, the shortest first. Numbers the components anew.
std::vector<Edge> united(Components& components, std::vector<Link> links) {
  std::vector<std::uint32_t> leader(components.count);
  std::iota(leader.begin(), leader.end(), 0u);
  const auto find = [&](std::uint32_t c) {
    while (leader[c] != c) c = leader[c] = leader[leader[c]];
    return c;
  };
  std::sort(links.begin(), links.end());
  std::vector<Edge> edges;
  for (const Link& link : links) {
    if (link.edge.first == kNone) continue;
    const std::uint32_t a = find(components.of[link.edge.first]), b = find(components.of[link.edge.second]);
    if (a == b) continue;
    leader[std::max(a, b)] = std::min(a, b);
    edges.push_back(link.edge);
  }
  std::vector<std::uint32_t> number(components.count);
  std::uint32_t count = 0;
  for (std::uint32_t c = 0; c < components.count; ++c) number[c] = find(c) == c ? count++ : number[find(c)];   // leaders are the lowest
  for (std::uint32_t& c : components.of) c = number[c];
  components.count = count;
  return edges;
}

void add_edges(NodeGraph& graph, const std::vector<Edge>& edges) {
  std::vector<Edge> arcs;
  for (const auto& [u, v] : edges) arcs.push_back({u, v}), arcs.push_back({v, u});
  std::sort(arcs.begin(), arcs.end());
  std::vector<std::uint32_t> to;
  to.reserve(graph.to.size() + arcs.size());
  auto arc = arcs.begin();
  std::uint32_t begin = 0;
  for (std::uint32_t u = 0; u < graph.nodes(); ++u) {
    const auto place = static_cast<std::ptrdiff_t>(to.size());
    to.insert(to.end(), graph.to.begin() + begin, graph.to.begin() + graph.first[u + 1]);
    const auto middle = static_cast<std::ptrdiff_t>(to.size());
    for (; arc != arcs.end() && arc->first == u; ++arc) to.push_back(arc->second);
    std::inplace_merge(to.begin() + place, to.begin() + middle, to.end());
    begin = std::exchange(graph.first[u + 1], static_cast<std::uint32_t>(to.size()));
  }
  graph.to = std::move(to);
}

}  // namespace

bool reach_all(NodeGraph& graph, const JoinRules& rules, double spacing, const RunOptions& run) {
  std::optional<Components> found = components_of(graph, run);
  if (!found) return false;
  Components components = std::move(*found);
  if (components.count <= 1) return !run.cancelled();
  StrangerTree tree(rules.positions, run);
  if (run.cancelled()) return false;
  std::vector<Edge> added;
  while (components.count > 1) {
    tree.set_components(components.of);
    std::vector<Link> links(components.count);
    const auto allow = [&](std::uint32_t u, std::uint32_t v) { return rules.allow(u, v); };
    const auto allow_all = [](std::uint32_t, std::uint32_t) { return true; };
    if (!links_out(components, tree, kAllowedReach * spacing, allow, links, run)) return false;
    if (!links_out(components, tree, kInfinity, allow_all, links, run)) return false;
    const std::vector<Edge> edges = united(components, std::move(links));
    added.insert(added.end(), edges.begin(), edges.end());
  }
  add_edges(graph, added);
  graph.repaired = added.size();
  return true;
}

}  // namespace cambium
