#include "raytrace/render.h"

#include "blobtree/input_error.h"
#include "raytrace/tone.h"
#include "tests/raytrace/scenes.h"

#include <gtest/gtest.h>

#include <atomic>
#include <cmath>
#include <string>
#include <vector>

namespace cambium {
namespace {

RenderOptions small() {
  RenderOptions options;
  options.width = 48;
  options.height = 64;
  options.samples = 8;
  return options;
}

TEST(Render, IsTheSameForAnyThreadCount) {
  const Field field = scenes::forked();
  RunOptions one, many;
  one.threads = 1;
  many.threads = 4;
  const auto a = render(field, small(), one), b = render(field, small(), many);
  ASSERT_TRUE(a && b);
  EXPECT_EQ(a->film.color, b->film.color);
  EXPECT_EQ(a->film.normal, b->film.normal);
  EXPECT_EQ(a->film.branch, b->film.branch);
  EXPECT_EQ(a->report.rays, b->report.rays);
}

TEST(Render, TheTreeFillsThePictureAndAovsNameItsBranches) {
  RenderOptions options = small();
  options.light.ground = false;
  const auto out = render(scenes::forked(), options, {});
  ASSERT_TRUE(out);
  const Film& film = out->film;
  ASSERT_EQ(film.color.size(), 4u * 48 * 64);
  int first = 64, last = -1;
  bool zero = false, one = false;
  for (int y = 0; y < 64; ++y) {
    for (int x = 0; x < 48; ++x) {
      const std::size_t i = std::size_t(y) * 48 + x;
      for (int c = 0; c < 4; ++c) ASSERT_TRUE(std::isfinite(film.color[4 * i + c]) && film.color[4 * i + c] >= 0);
      if (film.branch[i] < 0) continue;
      first = std::min(first, y);
      last = std::max(last, y);
      zero |= film.branch[i] == 0;
      one |= film.branch[i] == 1;
      EXPECT_TRUE(std::isfinite(film.depth[i]));
      EXPECT_GT(film.albedo[3 * i], 0);
      EXPECT_NEAR(std::hypot(film.normal[3 * i], film.normal[3 * i + 1], film.normal[3 * i + 2]), 1, 1e-4);
    }
  }
  EXPECT_LE(first, 6);
  EXPECT_GE(last, 57);
  EXPECT_TRUE(zero && one);
}

TEST(Render, TheSideTurnedToTheSunIsBrighter) {
  RenderOptions options = small();
  options.width = options.height = 48;
  options.light.sun_azimuth = options.camera.azimuth + 1.57;  // from the right of the picture
  options.light.sun_elevation = 0.2;
  BarkMaterial plain{BarkStyle::kSmooth, Vec3(0.4), Vec3(0.4), 1, nullptr, 0.3};
  options.bark = {plain};
  options.light.ground = false;
  const auto out = render(scenes::sphere({0, 0, 0}, 1), options, {});
  ASSERT_TRUE(out);
  const auto brightness = [&](int x) { return out->film.color[4 * (24 * 48 + x)]; };
  EXPECT_GT(brightness(33), 1.5 * brightness(14));
}

TEST(Render, TheGroundTakesTheShadow) {
  RenderOptions options = small();
  options.camera.eye = Vec3(0, -0.001, 12);
  options.camera.target = Vec3(0, 0, 0);
  options.light.sun_azimuth = 0;  // from +x, so the shadow falls to -x
  options.light.sun_elevation = 0.785;
  options.light.ground_height = -1;
  const auto out = render(scenes::sphere({0, 0, 1}, 0.6), options, {});
  ASSERT_TRUE(out);
  // The centre of the shadow is at x = -2; the picture's right is +x. 12 m down, half the width is 13 tan(0.305) 48/64.
  const double half_width = 13 * std::tan(0.305) * 48 / 64;
  const int shadow = int(24 * (1 - 2 / half_width)), mirrored = int(24 * (1 + 2 / half_width));
  const auto brightness = [&](int x) { return out->film.color[4 * (32 * 48 + x)]; };
  EXPECT_LT(brightness(shadow), 0.5 * brightness(mirrored));
}

TEST(Render, TheSkysLightHasNoSpeckles) {
  RenderOptions options = small();
  options.light.sun_color = Vec3(0.0);  // its terminator is an edge
  options.bark = {{BarkStyle::kSmooth, Vec3(0.4), Vec3(0.4), 1, nullptr, 0.3}};
  options.light.ground = false;
  const auto out = render(scenes::sphere({0, 0, 0}, 1), options, {});
  ASSERT_TRUE(out);
  const Film& film = out->film;
  const auto shown = [&](int x, int y) {
    const float* c = &film.color[4 * (y * 48 + x)];
    return luminance(display_from_linear({c[0], c[1], c[2]}));
  };
  for (int y = 24; y < 40; ++y) {  // well inside the silhouette
    for (int x = 16; x < 32; ++x) {
      const double around = 0.25 * (shown(x - 1, y) + shown(x + 1, y) + shown(x, y - 1) + shown(x, y + 1));
      EXPECT_NEAR(shown(x, y), around, 0.03) << x << ' ' << y;
    }
  }
}

TEST(Render, StopsWhenCancelledAndReportsProgressUpwards) {
  const Field field = scenes::forked();
  std::atomic<bool> cancel{false};
  double last = 0;
  bool falls = false;
  std::vector<std::string> stages;
  RunOptions run;
  run.cancel = &cancel;
  run.progress = [&](std::string_view stage, double fraction) {
    if (stages.empty() || stages.back() != stage) {
      stages.emplace_back(stage);
      last = 0;
    }
    falls |= fraction < last;
    last = fraction;
  };
  EXPECT_TRUE(render(field, small(), run));
  EXPECT_FALSE(falls);
  EXPECT_NEAR(last, 1, 1e-9);
  EXPECT_EQ(stages, (std::vector<std::string>{"covering the surface", "render"}));
  run.progress = [&](std::string_view, double) { cancel = true; };
  EXPECT_FALSE(render(field, small(), run));
}

TEST(Render, RefusesImpossibleSizes) {
  const Field field = scenes::trunk();
  RenderOptions options = small();
  options.width = 0;
  EXPECT_THROW(render(field, options, {}), InputError);
  options = small();
  options.height = 65537;
  EXPECT_THROW(render(field, options, {}), InputError);
  options = small();
  options.samples = 0;
  EXPECT_THROW(render(field, options, {}), InputError);
}

}  // namespace
}  // namespace cambium
