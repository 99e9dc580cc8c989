#include "raytrace/environment.h"

#include "blobtree/input_error.h"
#include "raytrace/directions.h"
#include "blobtree/place_hash.h"
#include "raytrace/tone.h"

#include <gtest/gtest.h>

#include <cmath>
#include <filesystem>
#include <numbers>
#include <vector>

namespace cambium {
namespace {

constexpr double kPi = std::numbers::pi;

Pixels even(int width, int height, float value) {
  return {width, height, 3, std::vector<float>(std::size_t(width) * height * 3, value), false};
}

void set(Pixels& pixels, int column, int row, const Vec3& color) {
  for (int c = 0; c < 3; ++c) pixels.data[(std::size_t(row) * pixels.width + column) * 3 + c] = static_cast<float>(color[c]);
}

/// Dim, with a lamp and some texture.
Pixels room() {
  Pixels pixels = even(32, 16, 0.1f);
  for (int row = 0; row < 16; ++row) {
    for (int column = 0; column < 32; ++column) set(pixels, column, row, Vec3(0.1 + 0.02 * ((row * 7 + column * 3) % 5), 0.1, 0.3));
  }
  set(pixels, 20, 3, Vec3(90, 70, 50));
  return pixels;
}

/// Evenly over the sphere.
Vec3 even_direction(int i, int count) {
  const double up = 1 - 2 * (i + 0.5) / count, azimuth = i * kPi * (3 - std::sqrt(5.0));
  return {std::sqrt(1 - up * up) * std::cos(azimuth), std::sqrt(1 - up * up) * std::sin(azimuth), up};
}

TEST(Environment, TheTopRowIsUpAndTheMiddleLiesWhereItIsTurnedTo) {
  Pixels pixels = even(16, 8, 0);
  for (int column = 0; column < 16; ++column) set(pixels, column, 0, Vec3(1, 0, 0));
  for (int column : {7, 8}) set(pixels, column, 3, Vec3(0, 1, 0)), set(pixels, column, 4, Vec3(0, 1, 0));
  set(pixels, 4, 4, Vec3(0, 0, 1));
  const Environment turned(pixels, 1.0);
  EXPECT_NEAR(turned.radiance({0, 0, 1}).r, 1, 1e-6);
  EXPECT_NEAR(turned.radiance({0, 0, -1}).r, 0, 1e-6);
  EXPECT_NEAR(turned.radiance(direction_of(1.0, 0)).g, 1, 1e-6);
  // To the left of the middle, a quarter turn less half a pixel.
  EXPECT_NEAR(turned.radiance(direction_of(1.0 + 2 * kPi * 3.5 / 16, -kPi / 16)).b, 1, 1e-5);
}

TEST(Environment, ThePdfIntegratesToOne) {
  const Environment around(room(), 0.4);
  constexpr int kCount = 2000000;
  double sum = 0;
  for (int i = 0; i < kCount; ++i) sum += around.even_pdf(even_direction(i, kCount));
  EXPECT_NEAR(sum * 4 * kPi / kCount, 1, 2e-3);
}

TEST(Environment, SamplesGiveItsIrradianceWithoutBias) {
  const Environment around(room(), 0.4, 2);
  const Vec3 normal = glm::normalize(Vec3(0.3, -0.5, 0.6));
  constexpr int kCount = 1000000;
  Vec3 blind(0.0), guided(0.0);
  for (int i = 0; i < kCount; ++i) {
    const Vec3 direction = even_direction(i, kCount);
    blind += 4 * kPi * std::max(0.0, glm::dot(normal, direction)) * around.radiance(direction);
  }
  constexpr int kGuided = 40000;
  for (int i = 0; i < kGuided; ++i) {
    const std::array<double, 2> random{(i + 0.5) / kGuided, unit_of(hash_of(1, i))};
    for (const LightSample& s : {around.sample_even(random), around.sample_spots(random)}) {
      ASSERT_GT(s.pdf, 0);
      ASSERT_NEAR(glm::length(s.direction), 1, 1e-9);
      guided += std::max(0.0, glm::dot(normal, s.direction)) / s.pdf * s.radiance;
    }
  }
  for (int c = 0; c < 3; ++c) EXPECT_NEAR(guided[c] / kGuided, blind[c] / kCount, 0.02 * blind[c] / kCount) << c;
}

TEST(Environment, SpotsAreFoundByTheirOwnSamplesAndMissingInTheRest) {
  const Environment around(room());
  ASSERT_TRUE(around.has_spots());
  const Vec3 lamp = direction_of(-2 * kPi * 4.5 / 32, kPi * (0.5 - 3.5 / 16));
  EXPECT_NEAR(around.radiance(lamp).r, 90, 1e-3);
  EXPECT_LT(around.even_radiance(lamp).r, 20);
  for (int i = 0; i < 1000; ++i) {
    const LightSample s = around.sample_spots({(i + 0.5) / 1000, unit_of(hash_of(2, i))});
    EXPECT_GT(glm::dot(s.direction, lamp), std::cos(0.15));
    EXPECT_NEAR(s.radiance.r, 90 - around.even_radiance(lamp).r, 1e-3);
  }
  EXPECT_FALSE(Environment(even(8, 4, 2)).has_spots());
}

TEST(Environment, AnEvenOneShowsItsValueOnLevelGround) {
  const Environment around(even(8, 4, 0.7f));
  for (int c = 0; c < 3; ++c) EXPECT_NEAR(around.on_level_ground()[c], 0.7, 1e-6);
  EXPECT_EQ(around.spots_on_level_ground(), Vec3(0.0));
}

TEST(Environment, ABlackOneIsNeverSampled) {
  const Environment around(even(8, 4, 0));
  EXPECT_EQ(around.sample_even({0.3, 0.6}).pdf, 0);
  EXPECT_EQ(around.sample_spots({0.3, 0.6}).pdf, 0);
  EXPECT_EQ(around.even_pdf({0, 0, 1}), 0);
}

TEST(Environment, NegativeValuesCountAsDark) {
  const Environment around(even(8, 4, -3));
  EXPECT_EQ(around.radiance({1, 0, 0}), Vec3(0.0));
}

TEST(Environment, FilesThatAreNoPanoramaAreRefusedByName) {
  const auto folder = std::filesystem::temp_directory_path() / "cambium_environment_test";
  std::filesystem::create_directories(folder);
  const auto square = folder / "square.exr", wide = folder / "wide.exr";
  const ImageLayout layout{.channel_names = {"R", "G", "B"}, .sample_types = std::vector<SampleType>(3, SampleType::kFloat)};
  write_pixels(even(4, 4, 1), layout, square, ".exr");
  write_pixels(even(8, 4, 0.5f), layout, wide, ".exr");
  try {
    load_environment(square, 0, 1);
    ADD_FAILURE();
  } catch (const InputError& error) {
    EXPECT_EQ(error.location().file, square.string());
    EXPECT_EQ(error.found(), "an image of 4x4 pixels");
  }
  EXPECT_THROW(load_environment(folder / "none.exr", 0, 1), InputError);
  EXPECT_NEAR(load_environment(wide, 0, 3)->radiance({0, 1, 0}).g, 1.5, 1e-6);
  std::filesystem::remove_all(folder);
}

}  // namespace
}  // namespace cambium
