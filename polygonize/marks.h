// A set of small numbers that several threads may add to at once.
#pragma once

#include "polygonize/ordered_chunks.h"

#include <atomic>
#include <cstdint>

namespace cambium {

class Marks {
 public:
  explicit Marks(std::size_t below = 0) : marked_(below, 0) {}

  void resize(std::size_t below) { marked_.resize(below, 0); }
  void add(std::size_t i) { std::atomic_ref(marked_[i]).store(1, std::memory_order_relaxed); }
  /// False if it was in already.
  bool add_new(std::size_t i) { return std::atomic_ref(marked_[i]).exchange(1, std::memory_order_relaxed) == 0; }
  bool has(std::size_t i) const { return marked_[i] != 0; }   ///< not while others add
  void remove(const std::vector<std::uint32_t>& listed) {
    for (const std::uint32_t i : listed) marked_[i] = 0;
  }

  std::vector<std::uint32_t> ascending() const {
    auto parts = in_chunks<std::vector<std::uint32_t>>(marked_.size(), 1 << 16, [&](auto& part, std::size_t begin, std::size_t end) {
      for (std::size_t i = begin; i < end; ++i)
        if (marked_[i]) part.push_back(static_cast<std::uint32_t>(i));
    });
    std::vector<std::uint32_t> all;
    append_parts(parts, all);
    return all;
  }

 private:
  std::vector<std::uint8_t> marked_;
};

}  // namespace cambium
