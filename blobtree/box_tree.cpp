#include "blobtree/box_tree.h"

#include <tbb/blocked_range.h>
#include <tbb/parallel_for.h>
#include <tbb/parallel_invoke.h>

#include <algorithm>
#include <bit>
#include <cmath>
#include <limits>

namespace cambium {
namespace {

constexpr std::size_t kTaskLeaves = 256;   // fewer are not worth a task of their own

}  // namespace

BoxTree::BoxTree(std::size_t count, const std::function<Box(std::uint32_t)>& box_of, const RunOptions& run) {
  if (count == 0) return;
  leaves_ = std::bit_ceil((count + kLeaf - 1) / kLeaf);
  nodes_.resize(2 * leaves_ - 1);
  boxes_.resize(count);
  order_.resize(count);
  std::vector<FloatBox> boxes(count);
  std::vector<Entry> entries(count);
  tbb::parallel_for(tbb::blocked_range<std::size_t>(0, count, 4096), [&](const auto& range) {
    for (std::size_t i = range.begin(); i < range.end(); ++i) {
      boxes[i] = FloatBox(box_of(static_cast<std::uint32_t>(i)));
      entries[i].center = 0.5f * (boxes[i].lo + boxes[i].hi);
      entries[i].index = static_cast<std::uint32_t>(i);
    }
  });
  halve(entries, 0, leaves_, run);
  if (run.cancelled()) return;
  tbb::parallel_for(tbb::blocked_range<std::size_t>(0, count, 4096), [&](const auto& range) {
    for (std::size_t i = range.begin(); i < range.end(); ++i) {
      order_[i] = entries[i].index;
      boxes_[i] = boxes[order_[i]];
    }
  });
  tbb::parallel_for(std::size_t{0}, leaves_, [&](std::size_t leaf) {
    for (std::size_t i = first(leaf); i < first(leaf + 1); ++i) nodes_[leaves_ - 1 + leaf].extend(boxes_[i]);
  });
  for (std::size_t node = leaves_ - 1; node-- > 0;) {
    nodes_[node] = nodes_[2 * node + 1];
    nodes_[node].extend(nodes_[2 * node + 2]);
  }
}

void BoxTree::halve(std::vector<Entry>& entries, std::size_t begin_leaf, std::size_t end_leaf, const RunOptions& run) {
  if (end_leaf - begin_leaf <= 1 || (end_leaf - begin_leaf > kTaskLeaves && run.cancelled())) return;
  const std::size_t middle_leaf = (begin_leaf + end_leaf) / 2;
  const auto at = [&](std::size_t leaf) { return entries.begin() + static_cast<std::ptrdiff_t>(first(leaf)); };
  const auto begin = at(begin_leaf), middle = at(middle_leaf), end = at(end_leaf);
  if (begin == end) return;
  glm::vec3 lo = begin->center, hi = lo;
  for (auto e = begin; e != end; ++e) {
    lo = glm::min(lo, e->center);
    hi = glm::max(hi, e->center);
  }
  int axis = 0;
  for (int a = 1; a < 3; ++a) {
    if (hi[a] - lo[a] > hi[axis] - lo[axis]) axis = a;
  }
  if (middle != end) {
    std::nth_element(begin, middle, end, [axis](const Entry& a, const Entry& b) {
      return a.center[axis] != b.center[axis] ? a.center[axis] < b.center[axis] : a.index < b.index;
    });
  }
  const auto low = [&] { halve(entries, begin_leaf, middle_leaf, run); };
  const auto high = [&] { halve(entries, middle_leaf, end_leaf, run); };
  if (end_leaf - begin_leaf > kTaskLeaves) {
    tbb::parallel_invoke(low, high);
  } else {
    low();
    high();
  }
}

}  // namespace cambium
