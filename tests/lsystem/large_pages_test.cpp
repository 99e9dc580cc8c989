#include "lsystem/large_pages.h"

#include <gtest/gtest.h>

#include <cstdint>
#include <numeric>
#include <vector>

namespace cambium {
namespace {

TEST(LargePages, WhatIsWrittenBeforeAndAfterStays) {
  std::vector<std::uint64_t> numbers(1000);
  numbers.reserve(3'000'000);
  std::iota(numbers.begin(), numbers.end(), 0);
  ask_for_large_pages(numbers.data() + numbers.size(), (numbers.capacity() - numbers.size()) * sizeof(numbers[0]));
  while (numbers.size() < 2'000'000) numbers.push_back(numbers.size());
  for (std::size_t i = 0; i < numbers.size(); i += 997) EXPECT_EQ(numbers[i], i);
}

TEST(LargePages, MemoryTooSmallForOneIsLeftAlone) {
  char few[100] = {1};
  ask_for_large_pages(few, sizeof few);
  ask_for_large_pages(nullptr, 0);
  EXPECT_EQ(few[0], 1);
}

}  // namespace
}  // namespace cambium
