// Values that only some nodes have, found by the node's id.
#pragma once

#include "blobtree/nodes.h"

#include <algorithm>
#include <bit>
#include <cstddef>
#include <cstdint>
#include <utility>
#include <vector>

namespace cambium {

/// Values by ascending ids; a bit per id says who has one. Memory: the values, and two bits per id up to the last.
/// Cost: find is constant, set is constant for ids in ascending order and linear otherwise.
template <class Value>
class IdTable {
 public:
  /// nullptr if the node has none.
  const Value* find(NodeId id) const {
    const std::size_t block = id / kIdsPerBlock;
    if (block >= blocks_.size() || !(blocks_[block].present & bit_of(id))) return nullptr;
    return &values_[place_of(id)];
  }

  void set(NodeId id, Value value) {
    const std::size_t block = id / kIdsPerBlock;
    if (block >= blocks_.size()) blocks_.resize(block + 1, {0, static_cast<std::uint32_t>(values_.size())});
    const std::size_t place = place_of(id);
    if (blocks_[block].present & bit_of(id)) {
      values_[place] = std::move(value);
      return;
    }
    values_.insert(values_.begin() + static_cast<std::ptrdiff_t>(place), std::move(value));
    blocks_[block].present |= bit_of(id);
    for (std::size_t later = block + 1; later < blocks_.size(); ++later) ++blocks_[later].before;
  }

  /// By ascending ids.
  const std::vector<Value>& values() const { return values_; }

  void shrink_to_fit() {
    values_.shrink_to_fit();
    blocks_.shrink_to_fit();
  }

  /// Bytes of both arrays, capacity included; not what the values themselves hold.
  std::size_t memory_bytes() const { return values_.capacity() * sizeof(Value) + blocks_.capacity() * sizeof(Block); }

 private:
  static constexpr NodeId kIdsPerBlock = 64;
  struct Block {
    std::uint64_t present;
    std::uint32_t before;                  ///< values of all earlier blocks
  };
  static std::uint64_t bit_of(NodeId id) { return std::uint64_t{1} << (id % kIdsPerBlock); }
  std::size_t place_of(NodeId id) const {
    const Block& block = blocks_[id / kIdsPerBlock];
    return block.before + static_cast<std::size_t>(std::popcount(block.present & (bit_of(id) - 1)));
  }

  std::vector<Value> values_;
  std::vector<Block> blocks_;
};

}  // namespace cambium
