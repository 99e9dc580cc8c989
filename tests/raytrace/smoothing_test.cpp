#include "raytrace/smoothing.h"

#include "raytrace/sampler.h"

#include <gtest/gtest.h>

#include <cmath>
#include <utility>

namespace cambium {
namespace {

constexpr int kSide = 96;
constexpr double kPixelAngle = 0.001;

/// A wall seen straight on, 10 m away, with `samples` rays of light per pixel that are 1 with probability `open(x, y)`.
template <typename Open>
std::vector<AmbientPixel> wall(int samples, const Open& open, float albedo = 0.5f) {
  std::vector<AmbientPixel> pixels(kSide * kSide);
  for (int y = 0; y < kSide; ++y) {
    for (int x = 0; x < kSide; ++x) {
      AmbientPixel& pixel = pixels[y * kSide + x];
      pixel.normal = {0, -1, 0};
      pixel.from_eye = {10 * kPixelAngle * x, 10, -10 * kPixelAngle * y};
      pixel.hits = static_cast<float>(samples);
      pixel.covered = 1;
      for (int s = 0; s < samples; ++s) {
        const float light = unit_of(hash_of(3, std::uint64_t(y) * kSide + x, s)) < open(x, y) ? 1.0f : 0.0f;
        pixel.light += light;
        pixel.light_squared += light * light;
      }
      pixel.albedo = glm::vec3(albedo);
      pixel.lit = glm::vec3(albedo * pixel.light / float(samples));
    }
  }
  return pixels;
}

/// Root of the mean squared difference from what the light is, over columns x0 to x1.
template <typename Open>
double error(const std::vector<glm::vec3>& lit, const Open& open, int x0, int x1) {
  double squares = 0;
  for (int y = 0; y < kSide; ++y) {
    for (int x = x0; x < x1; ++x) squares += std::pow(lit[y * kSide + x].x / 0.5 - open(x, y), 2);
  }
  return std::sqrt(squares / (kSide * (x1 - x0)));
}

TEST(Smoothing, TakesTheNoiseOfOneToSixteenSamplesFromAnEvenWall) {
  const auto even = [](int, int) { return 0.6; };
  // Of few samples most of the noise; of many, what is left differs by too little noise to be told from shade.
  for (const auto& [samples, left] : {std::pair{1, 0.15}, {4, 0.2}, {16, 0.35}}) {
    const auto pixels = wall(samples, even);
    std::vector<glm::vec3> raw;
    for (const AmbientPixel& pixel : pixels) raw.push_back(pixel.lit);
    EXPECT_LT(error(smooth_ambient(pixels, kSide, kSide, kPixelAngle), even, 0, kSide), left * error(raw, even, 0, kSide)) << samples;
  }
}

TEST(Smoothing, KeepsAShadeThatTheSamplesTellOf) {
  const auto shaded = [](int x, int) { return x < kSide / 2 ? 0.95 : 0.1; };
  const auto lit = smooth_ambient(wall(16, shaded), kSide, kSide, kPixelAngle);
  EXPECT_LT(error(lit, shaded, kSide / 2 - 3, kSide / 2 + 3), 0.2);
  EXPECT_LT(error(lit, shaded, 0, kSide / 2 - 8), 0.03);
}

TEST(Smoothing, DoesNotMixTwoSurfaces) {
  const auto split = [](int x, int) { return x < kSide / 2 ? 1.0 : 0.0; };
  for (const char* how : {"turned away", "further back"}) {
    auto pixels = wall(1, split);
    for (int y = 0; y < kSide; ++y) {
      for (int x = kSide / 2; x < kSide; ++x) {
        AmbientPixel& pixel = pixels[y * kSide + x];
        if (how[0] == 't') pixel.normal = {1, 0, 0};
        else pixel.from_eye *= 1.05f;
      }
    }
    EXPECT_LT(error(smooth_ambient(pixels, kSide, kSide, kPixelAngle), split, 0, kSide), 1e-6) << how;
  }
}

TEST(Smoothing, LeavesTextureAlone) {
  auto pixels = wall(4, [](int, int) { return 1.0; });
  for (std::size_t i = 0; i < pixels.size(); ++i) {
    pixels[i].albedo = glm::vec3(0.1f + 0.8f * float(unit_of(hash_of(9, i))));
    pixels[i].lit = pixels[i].albedo;
  }
  const auto lit = smooth_ambient(pixels, kSide, kSide, kPixelAngle);
  for (std::size_t i = 0; i < pixels.size(); ++i) ASSERT_NEAR(lit[i].x, pixels[i].albedo.x, 1e-5);
}

TEST(Smoothing, ReachesNoFurtherThanItSays) {
  const auto even = [](int, int) { return 0.6; };
  auto pixels = wall(1, even);
  const auto before = smooth_ambient(pixels, kSide, kSide, kPixelAngle);
  pixels[0].lit = glm::vec3(0.3f);
  pixels[0].light = 0.6f;
  const auto after = smooth_ambient(pixels, kSide, kSide, kPixelAngle);
  int farthest = 0;
  for (int y = 0; y < kSide; ++y) {
    for (int x = 0; x < kSide; ++x) {
      if (before[y * kSide + x] != after[y * kSide + x]) farthest = std::max({farthest, x, y});
    }
  }
  EXPECT_GT(farthest, 8);
  EXPECT_LE(farthest, kSmoothingReach);
}

}  // namespace
}  // namespace cambium
