#include "polygonize/minimal_edges.h"

#include "polygonize/cube_edges.h"

#include <tbb/parallel_for.h>

#include <algorithm>

namespace cambium {
namespace {

using Node = SurfaceOctree::Node;

struct Task {
  enum Kind : std::uint8_t { kCell, kFace, kEdge } kind = kCell;
  std::uint8_t axis = 0;
  std::array<Node, 4> nodes{};
};

constexpr int child_at(int a, int along_a, int b, int along_b, int c, int along_c) {
  return along_a << a | along_b << b | along_c << c;
}

class Walk {
 public:
  Walk(const SurfaceOctree& tree, MinimalEdges& found) : tree_(tree), found_(found) {}

  /// Regions reached `cuts` cuts below become tasks instead of being walked.
  void postpone(int cuts, std::vector<Task>& tasks) {
    cuts_ = cuts;
    tasks_ = &tasks;
    cell(tree_.root(), 0);
  }
  void run(const Task& task) {
    if (task.kind == Task::kCell) return cell(task.nodes[0], 0);
    if (task.kind == Task::kFace) return face(task.axis, {task.nodes[0], task.nodes[1]}, 0);
    edge(task.axis, task.nodes, 0);
  }

 private:
  bool postponed(Task::Kind kind, int axis, const std::array<Node, 4>& nodes, int depth) {
    if (!tasks_ || depth < cuts_) return false;
    tasks_->push_back({kind, static_cast<std::uint8_t>(axis), nodes});
    return true;
  }
  Node child(Node node, int child) const { return tree_.child(node, child); }

  void cell(Node node, int depth) {
    if (node.is_void() || node.is_leaf() || postponed(Task::kCell, 0, {node}, depth)) return;
    for (int c = 0; c < 8; ++c) cell(child(node, c), depth + 1);
    for (int a = 0; a < 3; ++a) {
      const int b = (a + 1) % 3, c = (a + 2) % 3;
      for (int k = 0; k < 4; ++k) {
        face(a, {child(node, child_at(a, 0, b, k & 1, c, k >> 1)), child(node, child_at(a, 1, b, k & 1, c, k >> 1))}, depth + 1);
      }
      for (int s = 0; s < 2; ++s) {
        std::array<Node, 4> around;
        for (int q = 0; q < 4; ++q) around[q] = child(node, child_at(a, s, b, q & 1, c, q >> 1));
        edge(a, around, depth + 1);
      }
    }
  }

  // Two nodes of one size, or one larger leaf, that meet in a face across axis a: the low one first.
  void face(int a, const std::array<Node, 2>& nodes, int depth) {
    if (nodes[0].is_void() || nodes[1].is_void() || (nodes[0].is_leaf() && nodes[1].is_leaf())) return;
    if (postponed(Task::kFace, a, {nodes[0], nodes[1]}, depth)) return;
    const int b = (a + 1) % 3, c = (a + 2) % 3;
    const auto part = [&](int side, int along_b, int along_c) {
      return nodes[side].is_leaf() ? nodes[side] : child(nodes[side], child_at(a, 1 - side, b, along_b, c, along_c));
    };
    for (int k = 0; k < 4; ++k) face(a, {part(0, k & 1, k >> 1), part(1, k & 1, k >> 1)}, depth + 1);
    for (int s = 0; s < 2; ++s) {
      std::array<Node, 4> along_b, along_c;
      for (int q = 0; q < 4; ++q) {
        along_b[q] = part(q >> 1, s, q & 1);   // axes of its quadrants: c, a
        along_c[q] = part(q & 1, q >> 1, s);   // a, b
      }
      edge(b, along_b, depth + 1);
      edge(c, along_c, depth + 1);
    }
  }

  void edge(int a, const std::array<Node, 4>& nodes, int depth) {
    bool leaves = true;
    for (const Node node : nodes) {
      if (node.is_void()) return;   // nothing crosses what it touches
      leaves = leaves && node.is_leaf();
    }
    if (leaves) return leaf_edge(a, nodes);
    if (postponed(Task::kEdge, a, nodes, depth)) return;
    const int b = (a + 1) % 3, c = (a + 2) % 3;
    for (int s = 0; s < 2; ++s) {
      std::array<Node, 4> parts;
      for (int q = 0; q < 4; ++q) {
        parts[q] = nodes[q].is_leaf() ? nodes[q] : child(nodes[q], child_at(a, s, b, 1 - (q & 1), c, 1 - (q >> 1)));
      }
      edge(a, parts, depth + 1);
    }
  }

  void leaf_edge(int a, const std::array<Node, 4>& nodes) {
    MinimalEdge found;
    found.axis = static_cast<std::uint8_t>(a);
    int finest_level = 256;
    for (int q = 0; q < 4; ++q) {
      found.leaves[q] = nodes[q].leaf();
      const int level = tree_.leaves()[nodes[q].leaf()].level;
      if (level < finest_level) finest_level = level, found.finest = static_cast<std::uint8_t>(q);
    }
    const int mask = tree_.leaves()[found.owner()].mask, e = found.edge_of_owner();
    if (!edge_crossed(mask, e)) return;
    found.low_inside = mask >> edge_low_corner(e) & 1;
    append_unsettled(tree_, found, found_.to_split);
    found_.edges.push_back(found);
  }

  const SurfaceOctree& tree_;
  MinimalEdges& found_;
  int cuts_ = 0;
  std::vector<Task>* tasks_ = nullptr;
};

constexpr int kTaskCuts = 8;   // below the root: thousands of tasks for a tree, most of them tiny

}  // namespace

std::optional<MinimalEdges> crossed_minimal_edges(const SurfaceOctree& tree, const RunOptions& run) {
  MinimalEdges result;
  std::vector<Task> tasks;
  Walk(tree, result).postpone(kTaskCuts, tasks);
  std::vector<MinimalEdges> parts(tasks.size());
  tbb::parallel_for(std::size_t{0}, tasks.size(), [&](std::size_t i) {
    if (!run.cancelled()) Walk(tree, parts[i]).run(tasks[i]);
  });
  if (run.cancelled()) return std::nullopt;
  std::vector<std::size_t> first(parts.size() + 1, result.edges.size());
  for (std::size_t i = 0; i < parts.size(); ++i) {
    first[i + 1] = first[i] + parts[i].edges.size();
    result.to_split.insert(result.to_split.end(), parts[i].to_split.begin(), parts[i].to_split.end());
  }
  std::sort(result.to_split.begin(), result.to_split.end());
  result.to_split.erase(std::unique(result.to_split.begin(), result.to_split.end()), result.to_split.end());
  result.edges.resize(first.back());
  tbb::parallel_for(std::size_t{0}, parts.size(), [&](std::size_t i) {
    std::copy(parts[i].edges.begin(), parts[i].edges.end(), result.edges.begin() + static_cast<std::ptrdiff_t>(first[i]));
    parts[i] = {};
  });
  return result;
}

std::optional<MinimalEdge> minimal_edge_of(const SurfaceOctree& tree, std::uint32_t leaf, int e) {
  const OctreeLeaf& own = tree.leaves()[leaf];
  if (!edge_crossed(own.mask, e)) return std::nullopt;
  MinimalEdge edge;
  edge.axis = static_cast<std::uint8_t>(e / 4);
  edge.low_inside = own.mask >> edge_low_corner(e) & 1;
  const int quadrant = 3 - e % 4;
  for (int q = 0; q < 4; ++q) {
    edge.leaves[q] = leaf;
    if (q == quadrant) continue;
    const auto found = tree.find_beside(own, edge.axis, quadrant, q);
    if (!found || tree.leaves()[*found].level < own.level) return std::nullopt;
    edge.leaves[q] = *found;
  }
  while (tree.leaves()[edge.leaves[edge.finest]].level != own.level) ++edge.finest;
  return edge;
}

void append_unsettled(const SurfaceOctree& tree, const MinimalEdge& edge, std::vector<std::uint32_t>& to_split) {
  const int finest = tree.leaves()[edge.owner()].level;
  for (int q = 0; q < 4; ++q) {
    const std::uint32_t leaf = edge.leaves[q];
    const bool spans = edge.leaves[q ^ 1] == leaf || edge.leaves[q ^ 2] == leaf;
    if (tree.must_split(leaf, edge.axis, q, finest, spans)) to_split.push_back(leaf);
  }
}

}  // namespace cambium
