#include "raytrace/sampler.h"

#include <gtest/gtest.h>

#include <set>

namespace cambium {
namespace {

TEST(PixelSampler, EverySixteenAreStratifiedInBothDimensionsAndInSquares) {
  for (int pixel = 0; pixel < 20; ++pixel) {
    for (Use use : {Use::kPixel, Use::kSun, Use::kOnward}) {
      std::set<int> columns, rows, squares;
      for (std::uint32_t s = 0; s < 16; ++s) {
        const auto [a, b] = PixelSampler(5, pixel, 3).pair(s, use);
        ASSERT_TRUE(a >= 0 && a < 1 && b >= 0 && b < 1);
        columns.insert(int(16 * a));
        rows.insert(int(16 * b));
        squares.insert(int(4 * a) * 4 + int(4 * b));
      }
      EXPECT_EQ(columns.size(), 16u);
      EXPECT_EQ(rows.size(), 16u);
      EXPECT_EQ(squares.size(), 16u);
    }
  }
}

TEST(PixelSampler, TheFirstFourLieInFourQuarters) {
  for (int pixel = 0; pixel < 50; ++pixel) {
    std::set<int> quarters;
    for (std::uint32_t s = 0; s < 4; ++s) {
      const auto [a, b] = PixelSampler(5, 1, pixel).pair(s, Use::kOnward);
      quarters.insert(int(2 * a) * 2 + int(2 * b));
    }
    EXPECT_EQ(quarters.size(), 4u);
  }
}

TEST(PixelSampler, BeyondSixteenBitsItGoesOnWithoutRepeating) {
  const PixelSampler sampler(5, 1, 3);
  std::set<std::array<double, 2>> pairs;
  for (std::uint32_t s = 0; s < 4 * 65536; ++s) pairs.insert(sampler.pair(s, Use::kOnward));
  EXPECT_EQ(pairs.size(), 4u * 65536);
  std::set<int> squares;
  for (std::uint32_t s = 3 * 65536; s < 3 * 65536 + 16; ++s) {
    const auto [a, b] = sampler.pair(s, Use::kOnward);
    squares.insert(int(4 * a) * 4 + int(4 * b));
  }
  EXPECT_EQ(squares.size(), 16u);
}

TEST(PixelSampler, TwoUsesFillWhatTheySpanTogether) {
  // 256 points in 16 x 16 squares: random ones leave some 162 of them occupied; bits that go hand in hand leave 16 or 32.
  std::set<Use> uses{Use::kPixel, Use::kLens, Use::kOnward, Use::kSun};
  for (int pixel = 0; pixel < 20; ++pixel) {
    const PixelSampler sampler(5, pixel, 3);
    for (const Use one : uses) {
      for (const Use other : uses) {
        if (one == other) continue;
        std::set<int> squares;
        for (std::uint32_t s = 0; s < 256; ++s)
          squares.insert(int(16 * sampler.pair(s, one)[0]) * 16 + int(16 * sampler.pair(s, other)[0]));
        EXPECT_GT(squares.size(), 120u);
      }
    }
  }
}

TEST(PixelSampler, IsAPureFunctionThatDiffersBetweenPixelsUsesAndSeeds) {
  const auto at = [](std::uint64_t seed, int x, Use use) { return PixelSampler(seed, x, 2).pair(0, use); };
  EXPECT_EQ(at(1, 1, Use::kSun), at(1, 1, Use::kSun));
  EXPECT_NE(at(1, 1, Use::kSun), at(1, 2, Use::kSun));
  EXPECT_NE(at(1, 1, Use::kSun), at(1, 1, Use::kOnward));
  EXPECT_NE(at(1, 1, Use::kSun), at(2, 1, Use::kSun));
}

}  // namespace
}  // namespace cambium
