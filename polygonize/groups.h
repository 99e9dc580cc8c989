// Items by what they belong to: crossings by their leaf, work by the cell of the cover that it is evaluated in.
#pragma once

#include <cstddef>
#include <cstdint>
#include <span>
#include <vector>

namespace cambium {

class Groups {
 public:
  Groups() = default;
  /// group_of(i) < groups for each item i. Items of a group keep their order. Cost: linear.
  template <class GroupOf>
  Groups(std::size_t groups, std::size_t items, GroupOf&& group_of) : first_(groups + 1, 0), items_(items) {
    for (std::size_t i = 0; i < items; ++i) ++first_[group_of(i) + 1];
    for (std::size_t c = 0; c < groups; ++c) first_[c + 1] += first_[c];
    std::vector<std::uint32_t> at(first_.begin(), first_.end() - 1);
    for (std::size_t i = 0; i < items; ++i) items_[at[group_of(i)]++] = static_cast<std::uint32_t>(i);
  }
  std::span<const std::uint32_t> of(std::size_t group) const {
    if (group + 1 >= first_.size()) return {};
    return {items_.data() + first_[group], first_[group + 1] - first_[group]};
  }

 private:
  std::vector<std::uint32_t> first_, items_;
};

}  // namespace cambium
