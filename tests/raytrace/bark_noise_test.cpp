#include "raytrace/bark_noise.h"

#include "blobtree/place_hash.h"

#include <gtest/gtest.h>

#include <cmath>

namespace cambium {
namespace {

double drawn(int which, int i) { return unit_of(hash_of(9, static_cast<std::uint64_t>(which), static_cast<std::uint64_t>(i))); }

TEST(BarkNoise, HasTheDerivativesThatDifferencesShow) {
  const double step = 1e-5;
  for (int i = 0; i < 500; ++i) {
    const double x = 20 * drawn(0, i) - 4, y = 60 * drawn(1, i) - 30;
    const NoiseAt at = noise_at(x, y, 7, 3);
    EXPECT_LE(std::abs(at.f), 1);
    EXPECT_NEAR(at.by_x, (noise_at(x + step, y, 7, 3).f - noise_at(x - step, y, 7, 3).f) / (2 * step), 1e-6);
    EXPECT_NEAR(at.by_y, (noise_at(x, y + step, 7, 3).f - noise_at(x, y - step, 7, 3).f) / (2 * step), 1e-6);
  }
}

TEST(BarkNoise, ClosesAroundTheGirthAndHasNoMean) {
  double sum = 0, squares = 0;
  for (int i = 0; i < 20000; ++i) {
    const double x = 5 * drawn(0, i), y = 1e4 * (drawn(1, i) - 0.5);
    const double f = noise_at(x, y, 5, 11).f;
    EXPECT_NEAR(f, noise_at(x + 5, y, 5, 11).f, 1e-9);
    sum += f;
    squares += f * f;
  }
  EXPECT_NEAR(sum / 20000, 0, 0.01);
  EXPECT_GT(squares / 20000, 0.02);
}

TEST(BarkCells, KnowTheDistanceToTheirBorder) {
  for (int i = 0; i < 500; ++i) {
    const double x = 9 * drawn(2, i), y = 50 * drawn(3, i);
    const CellAt at = cell_at(x, y, 9, 5, 0.8, 1);
    ASSERT_GE(at.border.f, 0);
    const double length = std::hypot(at.border.by_x, at.border.by_y);
    EXPECT_NEAR(length, 1, 1e-9);
    // Just short of the border it is the same cell, and just beyond it another.
    const auto along = [&](double t) { return cell_at(x - t * at.border.by_x, y - t * at.border.by_y, 9, 5, 0.8, 1).random; };
    EXPECT_EQ(along(at.border.f - 1e-6), at.random);
    EXPECT_NE(along(at.border.f + 1e-6), at.random);
  }
}

TEST(BarkCells, MeasureAcrossRowsInUnitsOfColumns) {
  int confirmed = 0;
  for (int i = 0; i < 300; ++i) {
    const double x = 9 * drawn(4, i), y = 50 * drawn(5, i), step = 1e-6;
    const CellAt at = cell_at(x, y, 9, 5, 0.8, 4);
    // The gradient in equal units: d/dx, and d/dy over rows that are 4 columns long.
    EXPECT_NEAR(std::hypot(at.border.by_x, at.border.by_y / 4), 1, 1e-9);
    const double ahead = cell_at(x + step, y, 9, 5, 0.8, 4).border.f, behind = cell_at(x - step, y, 9, 5, 0.8, 4).border.f;
    confirmed += std::abs((ahead - behind) / (2 * step) - at.border.by_x) < 1e-6;
    EXPECT_NEAR(at.border.f, cell_at(x + 9, y, 9, 5, 0.8, 4).border.f, 1e-9);
  }
  EXPECT_GT(confirmed, 290);   // all but where another border becomes the nearest
}

TEST(BarkNumber, CarriesSlopesThroughArithmeticAndSteps) {
  const double u = 0.3, v = 0.7, step = 1e-6;
  const auto value = [](const auto& a, const auto& b) {
    using N = std::decay_t<decltype(a)>;
    return smooth(0.1, 1.4, a * b + 2.0 * a) - larger<N>(a, b) * (1.0 - b);
  };
  const Sloped at = value(Sloped(u, 1, 0), Sloped(v, 0, 1));
  EXPECT_NEAR(at.f, value(u, v), 1e-12);
  EXPECT_NEAR(at.u, (value(u + step, v) - value(u - step, v)) / (2 * step), 1e-6);
  EXPECT_NEAR(at.v, (value(u, v + step) - value(u, v - step)) / (2 * step), 1e-6);
}

}  // namespace
}  // namespace cambium
