#include "raytrace/pixel_filter.h"

#include <gtest/gtest.h>

#include <cmath>
#include <numbers>

namespace cambium {
namespace {

double window(double x, double radius) {  // x from the middle
  const double a = std::numbers::pi * (x / radius + 1);
  return 0.35875 - 0.48829 * std::cos(a) + 0.14128 * std::cos(2 * a) - 0.01168 * std::cos(3 * a);
}

TEST(PixelFilter, SamplesLieAsTheWindowWeighs) {
  const PixelFilter filter(1.5);
  constexpr int kCount = 20000, kBins = 24;
  double found[kBins] = {}, wanted[kBins] = {}, total = 0;
  for (int i = 0; i < kCount; ++i) {
    const double x = filter.offset({(i + 0.5) / kCount, 0.5})[0];
    ASSERT_LE(std::abs(x), 1.5);
    found[std::min(kBins - 1, static_cast<int>((x / 1.5 + 1) / 2 * kBins))] += 1.0 / kCount;
    const double even = 3 * (i + 0.5) / kCount - 1.5;
    wanted[i * kBins / kCount] += window(even, 1.5);
    total += window(even, 1.5);
  }
  for (int bin = 0; bin < kBins; ++bin) EXPECT_NEAR(found[bin], wanted[bin] / total, 1e-3) << bin;
}

TEST(PixelFilter, IsSymmetricMonotoneAndTheSameInBothDirections) {
  const PixelFilter filter(2);
  double last = -2.1;
  for (double u = 0; u <= 1; u += 0.01) {
    const auto [x, y] = filter.offset({u, u});
    EXPECT_EQ(x, y);
    EXPECT_NEAR(x, -filter.offset({1 - u, 0})[0], 1e-9);
    EXPECT_GT(x, last);
    last = x;
  }
}

TEST(PixelFilter, OfNoRadiusIsThePixelsMiddle) {
  const PixelFilter filter(0);
  for (double u : {0.0, 0.3, 0.999}) EXPECT_EQ(filter.offset({u, u}), (std::array<double, 2>{0, 0}));
}

}  // namespace
}  // namespace cambium
