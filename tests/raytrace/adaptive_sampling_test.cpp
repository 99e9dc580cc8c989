#include "raytrace/adaptive_sampling.h"

#include "raytrace/pixel_filter.h"
#include "raytrace/sampler.h"

#include <gtest/gtest.h>

#include <atomic>
#include <cmath>
#include <functional>

namespace cambium {
namespace {

/// A picture as a function of the place in it, through the reconstruction filter: no field, no light.
class Drawing : public SampleSource {
 public:
  explicit Drawing(std::function<double(double x, double y)> shade, std::uint64_t seed = 7) : shade_(std::move(shade)), seed_(seed) {}

  CameraSample sample(int x, int y, std::uint32_t index) const override {
    const auto [dx, dy] = filter_.offset(PixelSampler(seed_, x, y).pair(index, Use::kPixel));
    CameraSample sample;
    sample.direct = Vec3(shade_(x + 0.5 + dx, y + 0.5 + dy));
    sample.rays = 1;
    return sample;
  }

 private:
  std::function<double(double, double)> shade_;
  std::uint64_t seed_;
  PixelFilter filter_{1.5};
};

constexpr int kSide = 64;
constexpr PixelRect kWhole{0, 0, kSide, kSide};

Frame taken(const Drawing& drawing, const Sampling& sampling, bool surface_everywhere = false) {
  Frame frame(kWhole, kWhole, {});
  PixelMask surface(kWhole);
  if (surface_everywhere) surface.set(kWhole);
  EXPECT_EQ(take_passes(frame, drawing, kWhole, surface, sampling, {}, {}), sampling.max);
  return frame;
}

TEST(AdaptiveSampling, PassesDoubleFromTheFewestToTheMost) {
  EXPECT_EQ(passes({.min = 1, .max = 16}), (std::vector<int>{1, 2, 4, 8, 16}));
  EXPECT_EQ(passes({.min = 3, .max = 16}), (std::vector<int>{3, 6, 12, 16}));
  EXPECT_EQ(passes({.min = 5, .max = 5}), std::vector<int>{5});
  EXPECT_EQ(passes({.min = 1, .max = 65535}).back(), 65535);
}

TEST(AdaptiveSampling, AnEvenPictureTakesTheFewest) {
  const Drawing even([](double, double) { return 0.4; });
  const Frame frame = taken(even, {.min = 1, .max = 16});
  EXPECT_EQ(frame.rays(), std::size_t{kSide * kSide});
  EXPECT_EQ(taken(even, {.min = 3, .max = 16}).rays(), std::size_t{3 * kSide * kSide});
  // Where the surface may be, it is looked for.
  EXPECT_EQ(taken(even, {.min = 1, .max = 16}, true).rays(), std::size_t{8 * kSide * kSide});
  EXPECT_EQ(taken(even, {.min = 1, .max = 2}, true).rays(), std::size_t{2 * kSide * kSide});
}

TEST(AdaptiveSampling, AnEdgeTakesTheMostAndTheRestStays) {
  const Frame frame = taken(Drawing([](double x, double) { return x < 30.3 ? 0.05 : 0.9; }), {.min = 1, .max = 16});
  for (int y = 0; y < kSide; ++y) {
    EXPECT_EQ(frame.sum(30, y).samples, 16);
    EXPECT_EQ(frame.sum(20, y).samples, 1);
    EXPECT_EQ(frame.sum(45, y).samples, 1);
  }
}

TEST(AdaptiveSampling, ATwigFarThinnerThanAPixelIsUnbroken) {
  // 0.12 pixels wide, oblique: on average a sample in fourteen meets it, and it darkens what is behind it by a tenth.
  const auto twig = [](double x, double y) { return std::abs(x - 10 - 0.61 * y) < 0.07 ? 0.02 : 0.9; };
  const Frame full = taken(Drawing(twig), {.min = 1024, .max = 1024});
  double wanted = 0, found = 0;
  int rows = 0, broken = 0;
  for (const std::uint64_t seed : {1, 2, 3, 4, 5, 6, 7, 8}) {
    const Frame frame = taken(Drawing(twig, seed), {.min = 1, .max = 64}, true);
    for (int y = 2; y < kSide - 2; ++y) {
      double in_row = 0;
      for (int x = 0; x < kSide; ++x) {
        wanted += full.sum(0, 0).mean_shown() - full.sum(x, y).mean_shown();
        in_row += frame.sum(0, 0).mean_shown() - frame.sum(x, y).mean_shown();
      }
      ++rows;
      broken += in_row <= 1e-4;   // nothing but rounding
      found += in_row;
    }
  }
  EXPECT_LT(broken, rows / 20);   // no sample met it there, and those around say that it matters less than the noise asked for
  // Pixels that miss it by luck take fewer samples than their neighbours: it comes out a little too bright, by less than the noise.
  EXPECT_NEAR(found / wanted, 1, 0.15);
}

TEST(AdaptiveSampling, APixelIsDoneWhenItsErrorIsBelowTheNoiseAskedFor) {
  // Grain finer than any pixel.
  const Drawing grain([](double x, double y) { return 0.2 + 0.25 * (std::sin(91 * x) * std::sin(87 * y) > 0); });
  std::size_t last = 0;
  for (const double noise : {0.05, 0.02, 0.01}) {
    const Frame frame = taken(grain, {.min = 1, .max = 4096, .noise = noise});
    EXPECT_GT(frame.rays(), last);
    last = frame.rays();
    int above = 0;
    for (int y = 0; y < kSide; ++y) {
      for (int x = 0; x < kSide; ++x) above += frame.sum(x, y).error() > noise;
    }
    EXPECT_EQ(above, 0) << noise;
  }
}

TEST(AdaptiveSampling, ACancelledPassLeavesTheFrameAsTheLastOneDid) {
  const Drawing edge([](double x, double y) { return x < 0.7 * y ? 0.05 : 0.9; });
  const Frame before = taken(edge, {.min = 1, .max = 4});
  std::atomic<bool> cancel{false};
  std::atomic<int> left{300};
  const Drawing counted([&](double x, double y) {
    if (cancel || left-- < 0) cancel = true;
    return x < 0.7 * y ? 0.05 : 0.9;
  });
  Frame frame(kWhole, kWhole, {});
  RunOptions run;
  run.cancel = &cancel;
  left = 1 << 30;
  const int finished = take_passes(frame, counted, kWhole, PixelMask(kWhole), {.min = 1, .max = 64}, run,
                                   [&](int samples) { if (samples == 4) left = 300; });
  EXPECT_EQ(finished, 4);
  for (int y = 0; y < kSide; ++y) {
    for (int x = 0; x < kSide; ++x) {
      ASSERT_EQ(frame.sum(x, y).samples, before.sum(x, y).samples);
      ASSERT_EQ(frame.sum(x, y).shown, before.sum(x, y).shown);
    }
  }
  EXPECT_EQ(frame.rays(), before.rays());
}

TEST(AdaptiveSampling, BeforeTheFirstPassIsFinishedThereIsNothing) {
  std::atomic<bool> cancel{false};
  const Drawing stops([&](double x, double) { cancel = cancel || x > 32; return 0.5; });
  Frame frame(kWhole, kWhole, {});
  RunOptions run;
  run.cancel = &cancel;
  EXPECT_EQ(take_passes(frame, stops, kWhole, PixelMask(kWhole), {}, run, {}), 0);
  EXPECT_EQ(frame.sum(0, 0).samples, 0);
}

TEST(AdaptiveSampling, TheSampledAreaGrowsByTwoPixelsADecision) {
  const PixelRect whole{0, 0, 100, 100};
  EXPECT_EQ(sampled_area({40, 40, 50, 60}, whole, {.min = 1, .max = 16}), (PixelRect{32, 32, 58, 68}));
  EXPECT_EQ(sampled_area({40, 40, 50, 60}, whole, {.min = 16, .max = 16}), (PixelRect{40, 40, 50, 60}));
  EXPECT_EQ(sampled_area({1, 1, 50, 99}, whole, {.min = 1, .max = 16}), (PixelRect{0, 0, 58, 100}));
}

}  // namespace
}  // namespace cambium
