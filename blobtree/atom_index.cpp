#include "blobtree/atom_index.h"

#include <algorithm>
#include <bit>
#include <utility>

namespace cambium {

BoxIndex::BoxIndex(std::vector<Box> boxes) : boxes_(std::move(boxes)) {
  for (std::uint32_t i = 0; i < boxes_.size(); ++i)
    if (!boxes_[i].empty()) items_.push_back(i);
  if (!items_.empty()) build(0, static_cast<std::uint32_t>(items_.size()));
}

void BoxIndex::build(std::uint32_t begin, std::uint32_t end) {  // halves exactly: recursion is log2 n deep
  Box box, centers;
  for (std::uint32_t i = begin; i < end; ++i) {
    box.extend(boxes_[items_[i]]);
    centers.extend(boxes_[items_[i]].center());
  }
  const std::size_t here = entries_.size();
  entries_.push_back({box, begin, end - begin});
  if (end - begin <= 8) return;
  const Vec3 size = centers.size();
  const int axis = size.x >= size.y && size.x >= size.z ? 0 : size.y >= size.z ? 1 : 2;
  const std::uint32_t middle = begin + (end - begin) / 2;
  std::nth_element(items_.begin() + begin, items_.begin() + middle, items_.begin() + end, [&](std::uint32_t a, std::uint32_t b) {
    const double ca = boxes_[a].lo[axis] + boxes_[a].hi[axis], cb = boxes_[b].lo[axis] + boxes_[b].hi[axis];
    return ca != cb ? ca < cb : a < b;
  });
  build(begin, middle);
  entries_[here].count = 0;
  entries_[here].first = static_cast<std::uint32_t>(entries_.size());
  build(middle, end);
}

std::vector<std::uint32_t> BoxIndex::query(const Box& box) const {
  std::vector<std::uint32_t> hits;
  if (entries_.empty()) return hits;
  std::uint32_t stack[64];
  int top = 0;
  stack[top++] = 0;
  while (top > 0) {
    const std::uint32_t at = stack[--top];
    const Entry& e = entries_[at];
    if (!e.box.intersects(box)) continue;
    if (e.count == 0) {
      stack[top++] = e.first;
      stack[top++] = at + 1;
      continue;
    }
    for (std::uint32_t i = e.first; i < e.first + e.count; ++i)
      if (boxes_[items_[i]].intersects(box)) hits.push_back(items_[i]);
  }
  std::sort(hits.begin(), hits.end());
  return hits;
}

AncestorIndex::AncestorIndex(std::vector<std::uint32_t> node, std::vector<std::uint32_t> depth)
    : node_(std::move(node)), depth_(std::move(depth)) {
  const std::size_t n = node_.size();
  std::vector<std::uint32_t> blocks;
  for (std::size_t begin = 0; begin < n; begin += kBlock) {
    std::uint32_t best = static_cast<std::uint32_t>(begin);
    for (std::size_t i = begin; i < std::min(n, begin + kBlock); ++i) best = shallower(best, static_cast<std::uint32_t>(i));
    blocks.push_back(best);
  }
  while (!blocks.empty()) {
    const std::size_t step = std::size_t{1} << levels_.size();
    levels_.push_back(blocks);
    if (2 * step > levels_[0].size()) break;
    std::vector<std::uint32_t> next(levels_[0].size() - 2 * step + 1);
    for (std::size_t b = 0; b < next.size(); ++b) next[b] = shallower(blocks[b], blocks[b + step]);
    blocks = std::move(next);
  }
}

std::uint32_t AncestorIndex::common(std::uint32_t i, std::uint32_t j) const {
  std::uint32_t best = i;
  const std::uint32_t first_block = i / kBlock + 1, end_block = j / kBlock;
  if (first_block >= end_block) {
    for (std::uint32_t k = i; k < j; ++k) best = shallower(best, k);
    return node_[best];
  }
  for (std::uint32_t k = i; k < first_block * kBlock; ++k) best = shallower(best, k);
  const std::uint32_t count = end_block - first_block;
  const auto level = static_cast<std::size_t>(std::bit_width(count) - 1);
  best = shallower(best, levels_[level][first_block]);
  best = shallower(best, levels_[level][end_block - (1u << level)]);
  for (std::uint32_t k = end_block * kBlock; k < j; ++k) best = shallower(best, k);
  return node_[best];
}

}  // namespace cambium
