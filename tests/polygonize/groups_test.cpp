#include "polygonize/groups.h"

#include "tests/blobtree/random_blobtrees.h"

#include <gtest/gtest.h>

#include <algorithm>

namespace cambium {
namespace {

TEST(Groups, HoldEveryItemOnceInItsGroupAndInOrder) {
  Draws draws(7);
  std::vector<std::size_t> group(1000);
  for (std::size_t& g : group) g = static_cast<std::size_t>(draws.below(37));
  const Groups groups(40, group.size(), [&](std::size_t i) { return group[i]; });
  std::size_t held = 0;
  for (std::size_t g = 0; g < 40; ++g) {
    const auto items = groups.of(g);
    EXPECT_TRUE(std::is_sorted(items.begin(), items.end()));
    for (const std::uint32_t i : items) EXPECT_EQ(group[i], g);
    held += items.size();
  }
  EXPECT_EQ(held, group.size());
  EXPECT_TRUE(groups.of(38).empty());
}

TEST(Groups, WithoutItemsOrGroupsAreEmpty) {
  EXPECT_TRUE(Groups().of(0).empty());
  const Groups none(3, 0, [](std::size_t) { return std::size_t{0}; });
  for (std::size_t g = 0; g < 5; ++g) EXPECT_TRUE(none.of(g).empty());
}

}  // namespace
}  // namespace cambium
