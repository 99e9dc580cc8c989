#include "polygonize/ordered_chunks.h"

#include <gtest/gtest.h>

#include <numeric>

namespace cambium {
namespace {

TEST(OrderedChunks, PartsComeInTheOrderOfTheNumbersAndCoverEachOnce) {
  for (const std::size_t n : {0, 1, 99, 100, 101, 12345}) {
    auto parts = in_chunks<std::vector<int>>(n, 100, [](auto& part, std::size_t begin, std::size_t end) {
      for (std::size_t i = begin; i < end; ++i) part.push_back(static_cast<int>(i));
    });
    EXPECT_EQ(parts.size(), (n + 99) / 100);
    std::vector<int> all{-1};   // what is there stays in front
    append_parts(parts, all);
    std::vector<int> expected(n + 1);
    std::iota(expected.begin(), expected.end(), -1);
    EXPECT_EQ(all, expected);
  }
}

}  // namespace
}  // namespace cambium
