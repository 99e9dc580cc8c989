#include "raytrace/frame.h"

#include <gtest/gtest.h>

#include <atomic>

namespace cambium {
namespace {

/// Light that tells the pixel and the sample.
class Numbered : public SampleSource {
 public:
  CameraSample sample(int x, int y, std::uint32_t index) const override {
    CameraSample sample;
    sample.direct = Vec3(0.01 * x, 0.01 * y, 0.001 * index);
    sample.depth = 1 + index;
    sample.branch = x;
    sample.rays = 2;
    if (stop && x == 12 && y == 23) *stop = true;
    return sample;
  }
  std::atomic<bool>* stop = nullptr;
};

constexpr PixelRect kWhole{0, 0, 40, 40}, kArea{10, 20, 16, 25};

std::vector<std::uint32_t> every_pixel() {
  std::vector<std::uint32_t> pixels(kArea.size());
  for (std::size_t i = 0; i < pixels.size(); ++i) pixels[i] = static_cast<std::uint32_t>(i);
  return pixels;
}

bool take(Frame& frame, const Numbered& source, const std::vector<std::uint32_t>& pixels, int until, const RunOptions& run = {}) {
  ProgressMeter progress(run, "render");
  return frame.take(source, pixels, until, progress, 1, run);
}

TEST(Frame, ItsPixelsAreThoseOfTheWholePicture) {
  Frame frame(kWhole, kArea, {});
  ASSERT_TRUE(take(frame, {}, every_pixel(), 1));
  for (int y = kArea.y0; y < kArea.y1; ++y) {
    for (int x = kArea.x0; x < kArea.x1; ++x) {
      EXPECT_FLOAT_EQ(frame.sum(x, y).direct.x, 0.01f * float(x));
      EXPECT_FLOAT_EQ(frame.sum(x, y).direct.y, 0.01f * float(y));
    }
  }
  EXPECT_EQ(frame.rays(), 2 * kArea.size());
}

TEST(Frame, APixelTakesTheSamplesThatItDoesNotHaveYet) {
  Frame frame(kWhole, kArea, {.first_hits = true});
  const auto one = static_cast<std::uint32_t>(kArea.index(11, 21));
  ASSERT_TRUE(take(frame, {}, {one}, 2));
  ASSERT_TRUE(take(frame, {}, every_pixel(), 4));
  EXPECT_EQ(frame.rays(), 2 * 4 * kArea.size());
  EXPECT_EQ(frame.sum(11, 21).direct.x, frame.sum(11, 22).direct.x);
  EXPECT_EQ(frame.sum(11, 21).direct.z, frame.sum(11, 22).direct.z);
  EXPECT_EQ(frame.sum(11, 21).samples, 4);
  EXPECT_EQ(frame.first_hits(11, 21).depth, 1);
  EXPECT_EQ(frame.first_hits(11, 21).shares[0].samples, 4);
}

TEST(Frame, ACancelledPassIsTakenBack) {
  for (const int passes_before : {0, 1}) {
    std::atomic<bool> stop{false};
    Frame frame(kWhole, kArea, {.first_hits = true});
    if (passes_before) { EXPECT_TRUE(take(frame, {}, every_pixel(), 1)); }
    const std::size_t rays = frame.rays();
    Numbered source;
    source.stop = &stop;
    RunOptions run;
    run.cancel = &stop;
    EXPECT_FALSE(take(frame, source, every_pixel(), 8, run));
    EXPECT_EQ(frame.rays(), rays);
    for (int y = kArea.y0; y < kArea.y1; ++y) {
      for (int x = kArea.x0; x < kArea.x1; ++x) {
        EXPECT_EQ(frame.sum(x, y).samples, passes_before);
        EXPECT_EQ(frame.first_hits(x, y).shares[0].samples, passes_before);
      }
    }
  }
}

TEST(Frame, JudgesTheAmbientLightAsEvenOnlyIfItWillBeSmoothed) {
  class Flickering : public SampleSource {
   public:
    CameraSample sample(int, int, std::uint32_t index) const override {
      CameraSample sample;
      sample.depth = 1;
      sample.albedo = Vec3(0.5);
      sample.ambient = Vec3(index % 2);
      return sample;
    }
  };
  for (const bool even : {true, false}) {
    Frame frame(kWhole, kArea, {.even_ambient = even});
    const RunOptions run;
    ProgressMeter progress(run, "render");
    ASSERT_TRUE(frame.take(Flickering(), every_pixel(), 4, progress, 1, {}));
    EXPECT_EQ(frame.sum(10, 20).spread() < 1e-3, even);
  }
}

}  // namespace
}  // namespace cambium
