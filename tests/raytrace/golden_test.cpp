// Five pictures as they were when someone looked at them and found them good.
//
// A picture is compared where noise is not: as the means of squares of four by four pixels, in displayed values. What changes the light,
// the bark, the lens or the film shows there; another order of samples does not. With CAMBIUM_WRITE_GOLDEN=1 in the environment
// the pictures are written anew instead: look at them before they are kept.
#include "raytrace/render.h"

#include "raytrace/environment.h"
#include "raytrace/image_file.h"
#include "tests/raytrace/scenes.h"

#include <gtest/gtest.h>

#include <cmath>
#include <cstdlib>
#include <filesystem>
#include <string>

namespace cambium {
namespace {

constexpr int kSquare = 4;
constexpr double kFarthest = 0.05;    // of a square's mean, displayed [0, 1]
constexpr double kMean = 0.006;       // of all squares

RenderOptions picture() {
  RenderOptions options;
  options.width = 96;
  options.height = 128;
  options.sampling = {.min = 4, .max = 64, .noise = 0.01};
  options.light.ground_height = 0.0;
  return options;
}

/// Means of the colour over premultiplied squares, row by row.
std::vector<double> squares(const Pixels& pixels) {
  const int across = pixels.width / kSquare, down = pixels.height / kSquare;
  std::vector<double> means(std::size_t(across) * down * pixels.channels);
  for (int y = 0; y < down * kSquare; ++y) {
    for (int x = 0; x < across * kSquare; ++x) {
      const std::size_t from = (std::size_t(y) * pixels.width + x) * pixels.channels;
      const std::size_t to = (std::size_t(y / kSquare) * across + x / kSquare) * pixels.channels;
      const double alpha = pixels.channels == 4 ? pixels.data[from + 3] : 1;
      for (int c = 0; c < pixels.channels; ++c)
        means[to + c] += pixels.data[from + c] * (c < 3 ? alpha : 1) / (kSquare * kSquare);
    }
  }
  return means;
}

void expect_golden(const std::string& name, const Field& field, const RenderOptions& options) {
  const auto rendered = render(field, options, {});
  ASSERT_TRUE(rendered);
  const std::filesystem::path golden = std::filesystem::path(CAMBIUM_SOURCE) / "tests/raytrace/golden" / (name + ".png");
  if (std::getenv("CAMBIUM_WRITE_GOLDEN")) {
    write_image(rendered->film, golden, {".png", 8});
    GTEST_SKIP() << "written: " << golden;
  }
  const std::filesystem::path made = std::filesystem::temp_directory_path() / ("cambium-" + name + ".png");
  write_image(rendered->film, made, {".png", 8});
  const Pixels now = read_pixels(made), then = read_pixels(golden);
  std::filesystem::remove(made);
  ASSERT_EQ(now.width, then.width);
  ASSERT_EQ(now.height, then.height);
  ASSERT_EQ(now.channels, then.channels);
  const std::vector<double> a = squares(now), b = squares(then);
  double farthest = 0, sum = 0;
  for (std::size_t i = 0; i < a.size(); ++i) {
    farthest = std::max(farthest, std::abs(a[i] - b[i]));
    sum += std::abs(a[i] - b[i]);
  }
  EXPECT_LT(farthest, kFarthest) << name;
  EXPECT_LT(sum / static_cast<double>(a.size()), kMean) << name;
}

TEST(Golden, AForkAndItsRidgeOnASunnyDay) {
  RenderOptions options = picture();
  options.camera.elevation = 0.2;
  options.light.sun_elevation = 0.6;
  expect_golden("fork", scenes::forked(), options);
}

TEST(Golden, ASawnLogUnderALamp) {
  RenderOptions options = picture();
  options.camera.elevation = 0.6;
  options.light.sun = false;
  options.light.sky = SkyKind::kGradient;
  options.light.sky_zenith = options.light.sky_horizon = Vec3(0.1);
  options.light.backdrop = Backdrop::kColor;
  options.light.backdrop_color = Vec3(0.02);
  AreaLight lamp;
  lamp.position = {1, 0.4, 1.4};
  lamp.direction = {-1, -0.4, -1};
  lamp.width = lamp.height = 0.5;
  lamp.radiance = Vec3(40, 35, 25);
  lamp.visible = false;
  options.light.area = {lamp};
  expect_golden("sawn", scenes::sawn(), options);
}

TEST(Golden, ABirchInAHallWithOneWindow) {
  RenderOptions options = picture();
  options.light.sun = false;
  options.light.sky = SkyKind::kEnvironment;
  Pixels hall{32, 16, 3, std::vector<float>(32 * 16 * 3, 0.06f), false};
  for (int y = 3; y < 8; ++y)
    for (int x = 12; x < 17; ++x)
      for (int c = 0; c < 3; ++c) hall.data[std::size_t(y * 32 + x) * 3 + c] = c == 2 ? 4.0f : 3.0f;
  options.light.environment = std::make_shared<const Environment>(hall, 0.6);
  options.bark = {BarkMaterial{.style = BarkStyle::kBirch, .color = {0.75, 0.72, 0.66}, .crack_color = {0.05, 0.04, 0.04}}};
  options.sampling.max = 128;
  options.camera.frame = Box{{-0.3, -0.3, 0.3}, {0.35, 0.3, 1.1}};
  expect_golden("birch", scenes::trunk(), options);
}

TEST(Golden, OnlyTheShadowOfAForkOnWhateverLiesBehind) {
  RenderOptions options = picture();
  options.camera.elevation = 0.5;
  options.light.catcher = true;
  options.light.backdrop = Backdrop::kTransparent;
  expect_golden("catcher", scenes::forked(), options);
}

TEST(Golden, TwoTrunksThroughAnOpenLens) {
  BlobTreeBuilder builder;
  const NodeId near = scenes::add_chain(builder, {{{1.2, -0.25, 0}, 0.12}, {{1.2, -0.25, 1.5}, 0.1}}, 0, 0);
  const NodeId far = scenes::add_chain(builder, {{{-1.5, 0.35, 0}, 0.2}, {{-1.5, 0.35, 1.8}, 0.16}}, 1, 0);
  RenderOptions options = picture();
  options.camera.eye = Vec3(3.2, 0, 0.9);
  options.camera.target = Vec3(0, 0, 0.8);
  options.camera.focal_length = 0.05;
  options.camera.f_number = 0.7;
  options.camera.focus = Vec3(1.2, -0.25, 0.8);
  options.sampling.max = 128;
  expect_golden("lens", Field(builder.build(builder.add(Union{{near, far}}))), options);
}

}  // namespace
}  // namespace cambium
