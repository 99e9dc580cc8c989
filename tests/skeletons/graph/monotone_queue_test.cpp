#include "skeletons/graph/monotone_queue.h"

#include <gtest/gtest.h>

#include <queue>
#include <random>

namespace cambium {
namespace {

TEST(MonotoneQueue, GivesCostsInTheOrderOfASortedOne) {
  std::mt19937_64 random(1);
  for (const double scale : {1e-300, 1e-9, 1.0, 1e12}) {
    std::uniform_real_distribution<double> step(0, scale);
    MonotoneQueue queue;
    std::priority_queue<double, std::vector<double>, std::greater<>> sorted;
    double last = 0;
    for (int i = 0; i < 20000; ++i) {
      if (i % 1000 < 600 || sorted.empty()) {
        const double cost = last + (i % 5 == 0 ? 0 : step(random));
        queue.push(cost, static_cast<std::uint32_t>(i));
        sorted.push(cost);
      } else {
        last = sorted.top();
        sorted.pop();
        ASSERT_EQ(queue.take().cost, last);
      }
    }
    while (!sorted.empty()) {
      ASSERT_FALSE(queue.empty());
      ASSERT_EQ(queue.take().cost, sorted.top());
      sorted.pop();
    }
    EXPECT_TRUE(queue.empty());
  }
}

TEST(MonotoneQueue, GivesEachNodeOnce) {
  MonotoneQueue queue;
  for (std::uint32_t i = 0; i < 1000; ++i) queue.push(i % 7, i);
  std::vector<bool> seen(1000);
  while (!queue.empty()) {
    const auto [cost, node] = queue.take();
    EXPECT_EQ(cost, node % 7);
    EXPECT_FALSE(seen[node]);
    seen[node] = true;
  }
  EXPECT_EQ(std::count(seen.begin(), seen.end(), true), 1000);
}

}  // namespace
}  // namespace cambium
