// Two searches over atoms: which boxes meet a box, and the lowest common ancestor of two. Private to blobtree/.
#pragma once

#include "blobtree/float_box.h"

#include <cstdint>
#include <span>
#include <vector>

namespace cambium {

/// Bounding volume hierarchy over boxes that their owner keeps. Build O(n log n), in parallel; query O(hits + log n) for
/// boxes that are spread out.
class BoxIndex {
 public:
  BoxIndex() = default;
  /// Empty boxes are never found.
  explicit BoxIndex(std::span<const FloatBox> boxes);
  /// Indices of the boxes that meet `box`, ascending. `boxes` as given when it was built.
  std::vector<std::uint32_t> query(std::span<const FloatBox> boxes, const FloatBox& box) const;
  std::size_t memory_bytes() const;

 private:
  struct Entry {
    FloatBox box;
    std::uint32_t first = 0, count = 0;  ///< count > 0: a leaf over items_; else children at this + 1 and at first
  };
  struct Center {
    glm::vec3 at;
    std::uint32_t item = 0;
  };
  void build(std::span<const FloatBox> boxes, std::span<Center> centers, std::uint32_t begin, std::uint32_t here);
  std::vector<std::uint32_t> items_;
  std::vector<Entry> entries_;
};

/// Lowest common ancestor of two atoms as the shallowest node met between them in depth-first order.
class AncestorIndex {
 public:
  AncestorIndex() = default;
  /// node[i], depth[i]: lowest common ancestor of atoms i and i + 1. Memory O(n); build O(n).
  AncestorIndex(std::vector<std::uint32_t> node, std::vector<std::uint32_t> depth);
  /// i < j. Cost O(1) for near atoms, O(log n) scans of a block otherwise.
  std::uint32_t common(std::uint32_t i, std::uint32_t j) const;
  std::size_t memory_bytes() const;

 private:
  static constexpr std::uint32_t kBlock = 32;
  std::uint32_t shallower(std::uint32_t a, std::uint32_t b) const { return depth_[b] < depth_[a] ? b : a; }
  std::vector<std::uint32_t> node_, depth_;
  std::vector<std::vector<std::uint32_t>> levels_;  ///< levels_[k][b]: position of the shallowest in blocks b .. b + 2^k - 1
};

}  // namespace cambium
