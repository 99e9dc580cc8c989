// Vertices by what it costs to do without them, the least first; costs may change. Private to polygonize/.
#pragma once

#include <algorithm>
#include <bit>
#include <cstddef>
#include <cstdint>
#include <limits>
#include <utility>
#include <vector>

namespace cambium {

/// A heap of four children to the node, which knows where each vertex is. Costs are told apart by their first digits only, a fifth
/// of them; of those that are alike the lowest number leaves first. Neighbours in a mesh mostly have neighbouring numbers, so what
/// is done to one after the other is near by in memory: that halves the time of it.
class VertexHeap {
 public:
  static constexpr float kNever = std::numeric_limits<float>::infinity();

  /// By vertex; kNever leaves it out. Cost: linear.
  explicit VertexHeap(std::vector<float> costs) : costs_(std::move(costs)), places_(costs_.size(), kOut) {
    for (std::uint32_t v = 0; v < costs_.size(); ++v) {
      if (costs_[v] == kNever) continue;
      places_[v] = static_cast<std::uint32_t>(heap_.size());
      heap_.push_back(v);
    }
    for (std::size_t i = heap_.size() / kChildren + 1; i-- > 0;) sink(i);
  }

  /// Costs of one grade are alike. Ascending with the cost; costs are not negative.
  static std::uint32_t grade(float cost) { return std::bit_cast<std::uint32_t>(cost) >> 21; }

  bool empty() const { return heap_.empty(); }
  std::uint32_t front() const { return heap_.front(); }
  float cost(std::uint32_t v) const { return places_[v] == kOut ? kNever : costs_[v]; }
  float least() const { return heap_.empty() ? kNever : costs_[heap_.front()]; }
  void pop() { set(heap_.front(), kNever); }

  /// Puts it in, moves it, or with kNever takes it out.
  void set(std::uint32_t v, float cost) {
    std::uint32_t at = places_[v];
    if (at == kOut) {
      if (cost == kNever) return;
      at = static_cast<std::uint32_t>(heap_.size());
      heap_.push_back(v);
      places_[v] = at;
    } else if (cost == kNever) {
      const std::uint32_t last = heap_.back();
      heap_.pop_back();
      places_[v] = kOut;
      if (last == v) return;
      put(at, last);
      settle(at);
      return;
    }
    costs_[v] = cost;
    settle(at);
  }

 private:
  static constexpr std::size_t kChildren = 4;
  static constexpr std::uint32_t kOut = std::numeric_limits<std::uint32_t>::max();

  bool before(std::uint32_t a, std::uint32_t b) const {
    const std::uint32_t of_a = grade(costs_[a]), of_b = grade(costs_[b]);
    return of_a != of_b ? of_a < of_b : a < b;
  }
  void put(std::size_t at, std::uint32_t v) {
    heap_[at] = v;
    places_[v] = static_cast<std::uint32_t>(at);
  }
  void settle(std::size_t at) { sink(rise(at)); }
  std::size_t rise(std::size_t at) {
    const std::uint32_t v = heap_[at];
    for (; at > 0; at = (at - 1) / kChildren) {
      const std::uint32_t parent = heap_[(at - 1) / kChildren];
      if (!before(v, parent)) break;
      put(at, parent);
    }
    put(at, v);
    return at;
  }
  void sink(std::size_t at) {
    if (at >= heap_.size()) return;
    const std::uint32_t v = heap_[at];
    for (;;) {
      const std::size_t begin = kChildren * at + 1, end = std::min(begin + kChildren, heap_.size());
      std::size_t least = begin;
      for (std::size_t i = begin + 1; i < end; ++i)
        if (before(heap_[i], heap_[least])) least = i;
      if (begin >= end || !before(heap_[least], v)) break;
      put(at, heap_[least]);
      at = least;
    }
    put(at, v);
  }

  std::vector<float> costs_;
  std::vector<std::uint32_t> heap_, places_;
};

}  // namespace cambium
