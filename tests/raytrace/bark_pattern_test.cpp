#include "raytrace/bark_pattern.h"

#include "blobtree/place_hash.h"

#include <gtest/gtest.h>

#include <cmath>
#include <limits>

namespace cambium {
namespace {

constexpr BarkStyle kStyles[] = {BarkStyle::kRidged, BarkStyle::kPlated, BarkStyle::kSmooth, BarkStyle::kBirch};

BarkTexel<double> texel_at(BarkStyle style, double u, double v, double radius, double footprint = 0, double mature_radius = 0,
                           double scale = 1) {
  return bark_pattern<double>({style, scale, mature_radius, 3}, u, v, radius, footprint);
}

double drawn(int which, int i) { return unit_of(hash_of(4, static_cast<std::uint64_t>(which), static_cast<std::uint64_t>(i))); }

void expect_alike(const BarkTexel<double>& a, const BarkTexel<double>& b, double tolerance) {
  EXPECT_NEAR(a.height, b.height, tolerance);
  EXPECT_NEAR(a.outer, b.outer, tolerance);
  EXPECT_NEAR(a.inner, b.inner, tolerance);
  EXPECT_NEAR(a.warm, b.warm, tolerance);
  EXPECT_NEAR(a.roughness, b.roughness, tolerance);
}

/// Of a whole turn and of many rows.
BarkTexel<double> mean_over_a_patch(BarkStyle style, double radius, double footprint, double mature_radius) {
  BarkTexel<double> sum{0.0, 0, 0, 0, 0, 0, 0};
  constexpr int kSide = 160;
  for (int i = 0; i < kSide; ++i) {
    for (int j = 0; j < kSide; ++j) {
      const auto t = texel_at(style, (i + 0.5) / kSide, 40 * radius * (j + 0.5) / kSide, radius, footprint, mature_radius);
      sum = {sum.relief + t.relief, sum.height + t.height, sum.outer + t.outer, sum.inner + t.inner, sum.warm + t.warm,
             sum.roughness + t.roughness, sum.young + t.young};
    }
  }
  constexpr double k = 1.0 / (kSide * kSide);
  return {sum.relief * k, sum.height * k, sum.outer * k, sum.inner * k, sum.warm * k, sum.roughness * k, sum.young * k};
}

TEST(BarkPattern, HasNoSeamAtUZero) {
  for (BarkStyle style : kStyles) {
    for (double scale : {0.7, 1.0, 1.3}) {
      for (int i = 0; i < 200; ++i) {
        const double v = 0.0131 * i;
        expect_alike(texel_at(style, 1e-10, v, 0.1, 0, 0.12, scale), texel_at(style, 1 - 1e-10, v, 0.1, 0, 0.12, scale), 1e-4);
      }
    }
  }
}

TEST(BarkPattern, IsContinuousInTheRadiusOfATaperingBranch) {
  for (BarkStyle style : kStyles) {
    for (int i = 0; i < 2000; ++i) {
      const double radius = 0.02 * std::exp2(2.0 * i / 2000);
      expect_alike(texel_at(style, 0.37, 1.7, radius, 0, 0.05), texel_at(style, 0.37, 1.7, radius * (1 + 1e-7), 0, 0.05), 1e-3);
    }
  }
}

TEST(BarkPattern, HasHeightsInRangeAndDiffersBetweenStyles) {
  double spread[4] = {};
  for (int k = 0; k < 4; ++k) {
    double lo = 1, hi = 0;
    for (int i = 0; i < 3000; ++i) {
      const auto texel = texel_at(kStyles[k], drawn(0, i), 3 * drawn(1, i), 0.15);
      lo = std::min(lo, texel.height);
      hi = std::max(hi, texel.height);
      EXPECT_GE(texel.roughness, 0.05);
      EXPECT_LE(texel.roughness, 1);
      EXPECT_GE(texel.inner, 0);
      EXPECT_LE(texel.outer, 2);
    }
    EXPECT_GE(lo, 0);
    EXPECT_LE(hi, 1);
    spread[k] = hi - lo;
  }
  EXPECT_GT(spread[0], 0.8);  // furrows
  EXPECT_LT(spread[2], 0.5);  // smooth
}

TEST(BarkPattern, ThinStemsAreSmoothAndThickOnesFissured) {
  const auto deepest = [](double radius) {
    double lo = 0;
    for (int i = 0; i < 2000; ++i)
      lo = std::min(lo, texel_at(BarkStyle::kRidged, drawn(0, i), 3 * drawn(1, i), radius, 0, 0.06).relief / radius);
    return -lo;
  };
  EXPECT_LT(deepest(0.015), 0.03);
  EXPECT_GT(deepest(0.06), 0.05);
  EXPECT_EQ(texel_at(BarkStyle::kRidged, 0.1, 0.2, 0.015, 0, 0.06).young, 1);
  EXPECT_EQ(texel_at(BarkStyle::kRidged, 0.1, 0.2, 0.07, 0, 0.06).young, 0);
}

TEST(BarkPattern, FadesWhereAPixelCoversManyPlates) {
  for (BarkStyle style : kStyles) {
    const auto first = texel_at(style, 0.1, 0.2, 0.1, 10, 0.15);
    for (int i = 0; i < 50; ++i) expect_alike(texel_at(style, 0.02 * i, 0.1 * i, 0.1, 10, 0.15), first, 1e-12);
  }
}

TEST(BarkPattern, KeepsItsMeanFromNearToFar) {
  for (BarkStyle style : kStyles) {
    for (const double mature : {0.0, 0.18}) {
      const auto near = mean_over_a_patch(style, 0.12, 0, mature), far = texel_at(style, 0.5, 0.5, 0.12, 10, mature);
      for (const double footprint : {0.002, 0.006, 0.02}) {
        const auto between = mean_over_a_patch(style, 0.12, footprint, mature);
        EXPECT_NEAR(between.outer, near.outer, 0.035) << int(style) << " at " << footprint;
        EXPECT_NEAR(between.inner, near.inner, 0.035) << int(style) << " at " << footprint;
      }
      EXPECT_NEAR(far.outer, near.outer, 0.035) << int(style);
      EXPECT_NEAR(far.inner, near.inner, 0.035) << int(style);
      EXPECT_NEAR(far.warm, near.warm, 0.1) << int(style);
      EXPECT_NEAR(far.roughness, near.roughness, 0.02) << int(style);
    }
  }
}

TEST(BarkPattern, SlopesAreThoseOfDifferences) {
  const double step = 1e-7;
  for (BarkStyle style : kStyles) {
    int off = 0, steep = 0;
    constexpr int kTries = 2000;
    for (int i = 0; i < kTries; ++i) {
      const BarkPatternKind kind{style, 1, 0.2, 3};
      const double u = drawn(5, i), v = 4 * drawn(6, i), radius = 0.05 + 0.1 * drawn(7, i);
      const auto at = bark_pattern<Sloped>(kind, Sloped(u, 1, 0), Sloped(v, 0, 1), radius, 1e-4);
      const auto relief = [&](double du, double dv) { return bark_pattern<double>(kind, u + du, v + dv, radius, 1e-4).relief; };
      EXPECT_NEAR(at.relief.f, relief(0, 0), 1e-12);
      const double by_u = (relief(step, 0) - relief(-step, 0)) / (2 * step), by_v = (relief(0, step) - relief(0, -step)) / (2 * step);
      const double scale = 1e-4 + std::abs(by_u) + std::abs(by_v);
      off += std::abs(at.relief.u - by_u) > 0.01 * scale || std::abs(at.relief.v - by_v) > 0.01 * scale;
      steep += std::abs(by_u) > 0.001;
    }
    EXPECT_LT(off, kTries / 200) << int(style);   // on the edges of scales there is a step
    EXPECT_GT(steep, kTries / 50) << int(style);
  }
}

TEST(BarkPattern, TakesAnyNumbers) {
  const double inf = std::numeric_limits<double>::infinity(), nan = std::nan("");
  for (const double u : {0.0, 1e300, -1e18, inf, nan}) {
    for (const double v : {0.0, -1e300, 1e12, -inf, nan}) {
      for (const double radius : {0.0, -1.0, 1e-300, 1e300, inf, nan}) {
        const auto texel = texel_at(BarkStyle::kPlated, u, v, radius, 0, 0.1);
        EXPECT_TRUE(std::isfinite(texel.outer) && std::isfinite(texel.relief));
      }
    }
  }
}

}  // namespace
}  // namespace cambium
