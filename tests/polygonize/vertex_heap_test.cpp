#include "polygonize/vertex_heap.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <random>

namespace cambium {
namespace {

/// All that is left, in the order it leaves.
std::vector<std::uint32_t> emptied(VertexHeap heap) {
  std::vector<std::uint32_t> order;
  for (; !heap.empty(); heap.pop()) order.push_back(heap.front());
  return order;
}

std::vector<float> random_costs(std::size_t count, std::uint32_t seed) {
  std::mt19937 random(seed);
  std::vector<float> costs(count);
  for (float& cost : costs) {
    const float mantissa = 1.0f + static_cast<float>(random() % 64) / 64;
    cost = random() % 7 == 0 ? VertexHeap::kNever : std::ldexp(mantissa, -20 + static_cast<int>(random() % 20));
  }
  return costs;
}

/// By grade, and within one by number.
std::vector<std::uint32_t> expected_order(const std::vector<float>& costs) {
  std::vector<std::uint32_t> order;
  for (std::uint32_t v = 0; v < costs.size(); ++v)
    if (costs[v] != VertexHeap::kNever) order.push_back(v);
  std::stable_sort(order.begin(), order.end(),
                   [&](std::uint32_t a, std::uint32_t b) { return VertexHeap::grade(costs[a]) < VertexHeap::grade(costs[b]); });
  return order;
}

TEST(VertexHeap, GradesRiseWithTheCostAndAreAFifthOfItWide) {
  for (float cost = 1e-30f; cost < 1e30f; cost *= 1.1f) {
    EXPECT_LE(VertexHeap::grade(cost), VertexHeap::grade(cost * 1.1f));
    EXPECT_LT(VertexHeap::grade(cost), VertexHeap::grade(cost * 1.26f));
  }
  EXPECT_LT(VertexHeap::grade(3e38f), VertexHeap::grade(VertexHeap::kNever));
  EXPECT_EQ(VertexHeap::grade(0), 0u);
}

TEST(VertexHeap, VerticesLeaveByGradeAndThenByNumber) {
  const auto costs = random_costs(3000, 1);
  EXPECT_EQ(emptied(VertexHeap(costs)), expected_order(costs));
}

TEST(VertexHeap, CostsMayRiseFallComeAndGo) {
  auto costs = random_costs(1000, 2);
  VertexHeap heap(costs);
  std::mt19937 random(3);
  for (int round = 0; round < 20; ++round) {
    const auto others = random_costs(1000, static_cast<std::uint32_t>(10 + round));
    for (int i = 0; i < 300; ++i) {
      const std::uint32_t v = random() % 1000;
      costs[v] = others[v];
      heap.set(v, costs[v]);
      ASSERT_EQ(heap.cost(v), costs[v]);
    }
    ASSERT_EQ(emptied(heap), expected_order(costs));
    ASSERT_EQ(heap.least(), costs[heap.front()]);
  }
}

TEST(VertexHeap, WhatIsNeverIsOut) {
  VertexHeap heap({VertexHeap::kNever, 2, VertexHeap::kNever});
  EXPECT_EQ(heap.front(), 1u);
  EXPECT_EQ(heap.cost(0), VertexHeap::kNever);
  heap.set(1, VertexHeap::kNever);
  EXPECT_TRUE(heap.empty());
  EXPECT_EQ(heap.least(), VertexHeap::kNever);
  heap.set(2, VertexHeap::kNever);
  heap.set(2, 5);
  EXPECT_EQ(heap.front(), 2u);
  EXPECT_TRUE(VertexHeap({}).empty());
}

}  // namespace
}  // namespace cambium
