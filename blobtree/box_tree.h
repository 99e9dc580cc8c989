// Many small boxes of any sizes, found again by place: which of them overlap, which something meets, which is nearest to a point. A
// balanced tree, halved at the median, so that large triangles beside tiny ones cost nothing extra. Knows nothing of what is in them.
#pragma once

#include "blobtree/float_box.h"
#include "blobtree/run_options.h"

#include <algorithm>
#include <array>
#include <cstddef>
#include <cstdint>
#include <functional>
#include <vector>

namespace cambium {

/// Immutable, shared by threads. Memory: about 36 bytes a box.
class BoxTree {
 public:
  static constexpr std::size_t kLeaf = 8;   ///< boxes in a leaf, at most

  BoxTree() = default;
  /// box_of(i) for i < count is called once each, from many threads; finite boxes only. In the current arena; the same tree at any
  /// thread count. Cost: count log count, a fifth of a microsecond a box.
  /// Cancelled, it is of no use.
  BoxTree(std::size_t count, const std::function<Box(std::uint32_t)>& box_of, const RunOptions& run = {});

  std::size_t size() const { return order_.size(); }
  std::size_t leaf_count() const { return leaves_; }
  /// The boxes of a leaf, by their numbers. Consecutive leaves are neighbours.
  const std::uint32_t* leaf_begin(std::size_t leaf) const { return order_.data() + order_.size() * leaf / leaves_; }
  const std::uint32_t* leaf_end(std::size_t leaf) const { return leaf_begin(leaf + 1); }

  /// Calls visit(i, j) for each pair of overlapping boxes that has its first in this leaf and its second there or in a later one.
  template <class Visit>
  void overlaps(std::size_t leaf, Visit&& visit) const;

  /// Calls visit(i) for each box that wanted(box) holds of; it must hold of every box around one that it holds of.
  template <class Wanted, class Visit>
  void search(Wanted&& wanted, Visit&& visit) const;

  /// The least distance2(i) of all boxes, looking only where box i is not farther from p than what was found before; `bound`
  /// (squared, metres) if nothing is nearer.
  template <class Distance2>
  double nearest2(const Vec3& p, double bound, Distance2&& distance2) const;

 private:
  struct Entry {
    glm::vec3 center;
    std::uint32_t index;
  };
  void halve(std::vector<Entry>& entries, std::size_t begin_leaf, std::size_t end_leaf, const RunOptions& run);
  std::size_t first(std::size_t leaf) const { return order_.size() * leaf / leaves_; }

  // A heap: node n has children 2n + 1 and 2n + 2; the last `leaves_` of them, a power of two, are the leaves.
  std::vector<FloatBox> nodes_;
  std::vector<FloatBox> boxes_;            // in order_
  std::vector<std::uint32_t> order_;
  std::size_t leaves_ = 0;
};

template <class Visit>
void BoxTree::overlaps(std::size_t leaf, Visit&& visit) const {
  const std::size_t begin = first(leaf), end = first(leaf + 1);
  const FloatBox& mine = nodes_[leaves_ - 1 + leaf];
  for (std::size_t i = begin; i < end; ++i)
    for (std::size_t j = i + 1; j < end; ++j)
      if (boxes_[i].intersects(boxes_[j])) visit(order_[i], order_[j]);
  struct Place {
    std::size_t node, begin_leaf, leaves;
  };
  std::array<Place, 64> stack;
  std::size_t waiting = 0;
  stack[waiting++] = {0, 0, leaves_};
  while (waiting > 0) {
    const Place at = stack[--waiting];
    if (at.begin_leaf + at.leaves <= leaf + 1 || !nodes_[at.node].intersects(mine)) continue;
    if (at.leaves > 1) {
      const std::size_t half = at.leaves / 2;
      stack[waiting++] = {2 * at.node + 2, at.begin_leaf + half, half};
      stack[waiting++] = {2 * at.node + 1, at.begin_leaf, half};
      continue;
    }
    const FloatBox& other = nodes_[at.node];
    const std::size_t from = first(at.begin_leaf), to = first(at.begin_leaf + 1);
    for (std::size_t i = begin; i < end; ++i) {
      if (!boxes_[i].intersects(other)) continue;
      for (std::size_t j = from; j < to; ++j)
        if (boxes_[i].intersects(boxes_[j])) visit(order_[i], order_[j]);
    }
  }
}

template <class Wanted, class Visit>
void BoxTree::search(Wanted&& wanted, Visit&& visit) const {
  if (order_.empty()) return;
  std::array<std::size_t, 64> stack;
  std::size_t waiting = 0;
  stack[waiting++] = 0;
  while (waiting > 0) {
    const std::size_t node = stack[--waiting];
    if (!wanted(nodes_[node])) continue;
    if (node < leaves_ - 1) {
      stack[waiting++] = 2 * node + 2;
      stack[waiting++] = 2 * node + 1;
      continue;
    }
    const std::size_t leaf = node - (leaves_ - 1);
    for (std::size_t i = first(leaf); i < first(leaf + 1); ++i)
      if (wanted(boxes_[i])) visit(order_[i]);
  }
}

template <class Distance2>
double BoxTree::nearest2(const Vec3& p, double bound, Distance2&& distance2) const {
  if (order_.empty()) return bound;
  struct Place {
    std::size_t node;
    double distance2;
  };
  std::array<Place, 64> stack;
  std::size_t waiting = 0;
  stack[waiting++] = {0, nodes_[0].distance2(p)};
  while (waiting > 0) {
    const Place at = stack[--waiting];
    if (!(at.distance2 < bound)) continue;
    if (at.node >= leaves_ - 1) {
      const std::size_t leaf = at.node - (leaves_ - 1);
      for (std::size_t i = first(leaf); i < first(leaf + 1); ++i) {
        if (boxes_[i].distance2(p) < bound) bound = std::min<double>(bound, distance2(order_[i]));
      }
      continue;
    }
    const std::size_t left = 2 * at.node + 1;
    const Place a{left, nodes_[left].distance2(p)}, b{left + 1, nodes_[left + 1].distance2(p)};
    const bool left_first = a.distance2 <= b.distance2;
    stack[waiting++] = left_first ? b : a;
    stack[waiting++] = left_first ? a : b;
  }
  return bound;
}

}  // namespace cambium
