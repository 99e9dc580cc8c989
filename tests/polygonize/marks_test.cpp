#include "polygonize/marks.h"

#include <gtest/gtest.h>

#include <atomic>

namespace cambium {
namespace {

TEST(Marks, ListsWhatManyThreadsAddedOnceAndInOrder) {
  constexpr std::size_t kCount = 300'000;
  Marks marks(kCount);
  std::atomic<std::size_t> new_ones{0};
  tbb::parallel_for(std::size_t{0}, 3 * kCount, [&](std::size_t i) {
    if (i % kCount % 7 == 0) new_ones += marks.add_new(i % kCount);
  });
  const std::vector<std::uint32_t> listed = marks.ascending();
  ASSERT_EQ(listed.size(), (kCount + 6) / 7);
  EXPECT_EQ(new_ones, listed.size());
  for (std::size_t i = 0; i < listed.size(); ++i) ASSERT_EQ(listed[i], 7 * i);
}

TEST(Marks, ForgetsWhatIsRemovedAndKeepsTheRestWhenItGrows) {
  Marks marks(5);
  for (const std::size_t i : {1, 2, 4}) marks.add(i);
  marks.remove({2});
  marks.resize(9);
  marks.add(8);
  EXPECT_EQ(marks.ascending(), (std::vector<std::uint32_t>{1, 4, 8}));
  EXPECT_TRUE(marks.has(4));
  EXPECT_FALSE(marks.has(2));
}

}  // namespace
}  // namespace cambium
