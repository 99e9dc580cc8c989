#include "blobtree/atom_index.h"

#include <tbb/parallel_invoke.h>

#include <algorithm>
#include <bit>
#include <utility>

namespace cambium {

namespace {

constexpr std::uint32_t kLeafItems = 12;

/// Entries of a hierarchy over n items, which halves exactly: so every subtree's place is known before it is built.
std::uint32_t entry_count(std::uint32_t n) {
  if (n <= kLeafItems) return 1;
  const std::uint32_t half = n / 2, low = entry_count(half);
  return 1 + low + (n % 2 == 0 ? low : entry_count(n - half));
}

}  // namespace

BoxIndex::BoxIndex(std::span<const FloatBox> boxes) {
  std::vector<Center> centers;
  centers.reserve(boxes.size());
  for (std::uint32_t i = 0; i < boxes.size(); ++i)
    if (!boxes[i].empty()) centers.push_back({0.5f * boxes[i].lo + 0.5f * boxes[i].hi, i});
  if (centers.empty()) return;
  entries_.resize(entry_count(static_cast<std::uint32_t>(centers.size())));
  items_.resize(centers.size());
  build(boxes, centers, 0, 0);
}

void BoxIndex::build(std::span<const FloatBox> boxes, std::span<Center> centers, std::uint32_t begin, std::uint32_t here) {
  Entry& entry = entries_[here];
  const auto count = static_cast<std::uint32_t>(centers.size());
  if (count <= kLeafItems) {
    for (std::uint32_t i = 0; i < count; ++i) {
      items_[begin + i] = centers[i].item;
      entry.box.extend(boxes[centers[i].item]);
    }
    entry.first = begin;
    entry.count = count;
    return;
  }
  glm::vec3 lo = centers[0].at, hi = lo;
  for (const Center& c : centers) lo = glm::min(lo, c.at), hi = glm::max(hi, c.at);
  const glm::vec3 size = hi - lo;
  const int axis = size.x >= size.y && size.x >= size.z ? 0 : size.y >= size.z ? 1 : 2;
  const std::uint32_t half = count / 2, low = here + 1, high = low + entry_count(half);
  std::nth_element(centers.begin(), centers.begin() + half, centers.end(), [axis](const Center& a, const Center& b) {
    return a.at[axis] != b.at[axis] ? a.at[axis] < b.at[axis] : a.item < b.item;
  });
  const auto build_low = [&] { build(boxes, centers.first(half), begin, low); };
  const auto build_high = [&] { build(boxes, centers.subspan(half), begin + half, high); };
  if (count > 4096) {
    tbb::parallel_invoke(build_low, build_high);
  } else {
    build_low();
    build_high();
  }
  entry.first = high;
  entry.box = entries_[low].box;
  entry.box.extend(entries_[high].box);
}

std::vector<std::uint32_t> BoxIndex::query(std::span<const FloatBox> boxes, const FloatBox& box) const {
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
      if (boxes[items_[i]].intersects(box)) hits.push_back(items_[i]);
  }
  std::sort(hits.begin(), hits.end());
  return hits;
}

std::size_t BoxIndex::memory_bytes() const {
  return items_.capacity() * sizeof(items_[0]) + entries_.capacity() * sizeof(entries_[0]);
}

std::size_t AncestorIndex::memory_bytes() const {
  std::size_t bytes = (node_.capacity() + depth_.capacity()) * sizeof(std::uint32_t) + levels_.capacity() * sizeof(levels_[0]);
  for (const auto& level : levels_) bytes += level.capacity() * sizeof(std::uint32_t);
  return bytes;
}

AncestorIndex::AncestorIndex(std::vector<std::uint32_t> node, std::vector<std::uint32_t> depth)
    : node_(std::move(node)), depth_(std::move(depth)) {
  node_.shrink_to_fit();
  depth_.shrink_to_fit();
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
