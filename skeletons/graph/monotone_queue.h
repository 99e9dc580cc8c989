// A queue of costs that never fall below what was taken last: a radix heap (Ahuja, Mehlhorn, Orlin and Tarjan 1990) over the bits of
// floating-point numbers.
#pragma once

#include <algorithm>
#include <array>
#include <bit>
#include <cstddef>
#include <cstdint>
#include <vector>

namespace cambium {

class MonotoneQueue {
 public:
  struct Entry {
    double cost;
    std::uint32_t node;
  };

  bool empty() const { return size_ == 0; }
  /// cost: >= 0, and not less than that of the entry taken last.
  void push(double cost, std::uint32_t node) {
    bucket_of(cost).push_back({cost, node});
    ++size_;
  }
  /// The cheapest; of several that cost the same, any. Precondition: not empty. Cost: each entry is moved as many times as the ranges of
  /// costs around it are halved, and always forwards through memory.
  Entry take() {
    if (buckets_[0].empty()) refill();
    const Entry entry = buckets_[0].back();
    buckets_[0].pop_back();
    --size_;
    return entry;
  }

 private:
  /// Costs in bucket i differ from the last one taken in bit i - 1 and in none above; in bucket 0 they are the same. Bits of numbers not
  /// below 0 are ordered as the numbers are.
  std::vector<Entry>& bucket_of(double cost) { return buckets_[std::size_t(std::bit_width(std::bit_cast<std::uint64_t>(cost) ^ last_))]; }

  /// Deals the first bucket with entries out anew, around the cheapest of them.
  void refill() {
    std::size_t i = 1;
    while (buckets_[i].empty()) ++i;
    double least = buckets_[i].front().cost;
    for (const Entry& entry : buckets_[i]) least = std::min(least, entry.cost);
    last_ = std::bit_cast<std::uint64_t>(least);
    for (const Entry& entry : buckets_[i]) bucket_of(entry.cost).push_back(entry);
    buckets_[i].clear();
  }

  std::array<std::vector<Entry>, 65> buckets_;
  std::uint64_t last_ = 0;
  std::size_t size_ = 0;
};

}  // namespace cambium
