#include "blobtree/box_tree.h"

#include "tests/blobtree/random_blobtrees.h"

#include <gtest/gtest.h>

#include <set>

namespace cambium {
namespace {

const Box kAround{Vec3(-2), Vec3(2)};

TEST(BoxTree, OverlapsAreThoseOfEveryPairAndEachOnce) {
  for (const std::size_t n : {1, 7, 8, 9, 100, 1000}) {
    Draws draws(n);
    std::vector<Box> boxes;
    for (std::size_t i = 0; i < n; ++i) {
      const Vec3 at = draws.point(kAround), half = std::pow(10.0, draws.in(-3, -0.3)) * Vec3(draws.in(0, 1), draws.in(0, 1), draws.in(0, 1));
      boxes.push_back({at - half, at + half});
    }
    const BoxTree tree(n, [&](std::uint32_t i) { return boxes[i]; });
    std::multiset<std::array<std::uint32_t, 2>> found, wanted;
    for (std::size_t leaf = 0; leaf < tree.leaf_count(); ++leaf) {
      tree.overlaps(leaf, [&](std::uint32_t i, std::uint32_t j) { found.insert({std::min(i, j), std::max(i, j)}); });
    }
    for (std::uint32_t i = 0; i < n; ++i)
      for (std::uint32_t j = i + 1; j < n; ++j)
        if (boxes[i].intersects(boxes[j])) wanted.insert({i, j});
    EXPECT_EQ(found, wanted) << n;
  }
}

TEST(BoxTree, ASearchVisitsEachBoxThatIsWantedOnce) {
  for (const std::size_t n : {0, 1, 9, 500}) {
    Draws draws(n + 1);
    std::vector<Box> boxes;
    for (std::size_t i = 0; i < n; ++i) {
      const Vec3 at = draws.point(kAround);
      boxes.push_back({at, at + Vec3(draws.in(0, 1), draws.in(0, 1), 0)});
    }
    const BoxTree tree(n, [&](std::uint32_t i) { return boxes[i]; });
    for (int k = 0; k < 50; ++k) {
      const FloatBox place(Box{draws.point(kAround), kAround.hi});
      std::multiset<std::uint32_t> found, wanted;
      tree.search([&](const FloatBox& box) { return box.intersects(place); }, [&](std::uint32_t i) { found.insert(i); });
      for (std::uint32_t i = 0; i < n; ++i)
        if (FloatBox(boxes[i]).intersects(place)) wanted.insert(i);
      EXPECT_EQ(found, wanted) << n;
    }
  }
}

}  // namespace
}  // namespace cambium
