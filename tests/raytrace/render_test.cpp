#include "raytrace/render.h"

#include "blobtree/input_error.h"
#include "raytrace/tone.h"
#include "tests/raytrace/scenes.h"

#include <gtest/gtest.h>

#include <atomic>
#include <cmath>
#include <random>
#include <string>
#include <vector>

namespace cambium {
namespace {

RenderOptions small() {
  RenderOptions options;
  options.width = 48;
  options.height = 64;
  options.sampling.max = 8;
  return options;
}

std::set<Aov> every_aov() {
  std::set<Aov> aovs;
  for (const AovInfo& info : all_aovs()) aovs.insert(info.aov);
  return aovs;
}

/// The part of a film's values (color or an AOV) that a crop shows.
std::vector<float> cut(const std::vector<float>& values, const Film& whole, const PixelRect& crop) {
  const std::size_t channels = values.size() / whole.pixels();
  std::vector<float> part;
  for (int y = crop.y0; y < crop.y1; ++y) {
    const auto row = values.begin() + static_cast<std::ptrdiff_t>((std::size_t(y) * whole.width + crop.x0) * channels);
    part.insert(part.end(), row, row + static_cast<std::ptrdiff_t>(crop.width() * channels));
  }
  return part;
}

TEST(Render, IsTheSameForAnyThreadCount) {
  const Field field = scenes::forked();
  RenderOptions options = small();
  options.aovs = every_aov();
  RunOptions one;
  one.threads = 1;
  const auto a = render(field, options, one);
  ASSERT_TRUE(a);
  for (const int threads : {2, 4}) {
    RunOptions many;
    many.threads = threads;
    const auto b = render(field, options, many);
    ASSERT_TRUE(b);
    EXPECT_EQ(a->film.color, b->film.color);
    EXPECT_EQ(a->film.aovs, b->film.aovs);
    EXPECT_EQ(a->report.rays, b->report.rays);
  }
}

TEST(Render, TheTreeFillsThePictureAndAovsNameItsBranches) {
  RenderOptions options = small();
  options.light.ground = false;
  options.aovs = every_aov();
  const auto out = render(scenes::forked(), options, {});
  ASSERT_TRUE(out);
  const Film& film = out->film;
  const std::vector<float>&branch = film.aov(Aov::kBranch), &depth = film.aov(Aov::kDepth), &albedo = film.aov(Aov::kAlbedo),
        &normal = film.aov(Aov::kNormal);
  ASSERT_EQ(film.color.size(), 4u * 48 * 64);
  int first = 64, last = -1;
  bool zero = false, one = false;
  for (int y = 0; y < 64; ++y) {
    for (int x = 0; x < 48; ++x) {
      const std::size_t i = std::size_t(y) * 48 + x;
      for (int c = 0; c < 4; ++c) ASSERT_TRUE(std::isfinite(film.color[4 * i + c]) && film.color[4 * i + c] >= 0);
      if (branch[i] < 0) continue;
      first = std::min(first, y);
      last = std::max(last, y);
      zero |= branch[i] == 0;
      one |= branch[i] == 1;
      EXPECT_TRUE(std::isfinite(depth[i]));
      EXPECT_GT(albedo[3 * i], 0);
      EXPECT_NEAR(std::hypot(normal[3 * i], normal[3 * i + 1], normal[3 * i + 2]), 1, 1e-4);
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

TEST(Render, ACropIsBitIdenticalToThatPartOfTheWhole) {
  const Field field = scenes::forked();
  const auto renderer = Renderer::make(field, {});
  ASSERT_TRUE(renderer);
  RenderOptions options;
  options.width = 120;
  options.height = 150;
  options.aovs = every_aov();
  for (const char* what : {"smoothed", "not smoothed"}) {
    options.smooth = what == std::string("smoothed");
    const auto whole = renderer->render(options, {});
    ASSERT_TRUE(whole);
    std::mt19937 random(5);
    const auto below = [&](int end) { return std::uniform_int_distribution<int>(0, end - 1)(random); };
    for (int trial = 0; trial < 8; ++trial) {
      const int x = below(110), y = below(140);
      const PixelRect crop{x, y, x + 1 + below(120 - x), y + 1 + below(150 - y)};
      SCOPED_TRACE(testing::Message() << what << ' ' << crop.x0 << ',' << crop.y0 << ',' << crop.x1 << ',' << crop.y1);
      RenderOptions part = options;
      part.crop = crop;
      const auto made = renderer->render(part, {});
      ASSERT_TRUE(made);
      EXPECT_EQ(made->film.color, cut(whole->film.color, whole->film, crop));
      for (const auto& [aov, values] : made->film.aovs) {
        EXPECT_EQ(values, cut(whole->film.aov(aov), whole->film, crop)) << info_of(aov).name;
      }
    }
  }
}

TEST(Render, CancelledAfterAPassItIsThePictureOfThatManySamples) {
  const auto field = scenes::forked();
  const auto renderer = Renderer::make(field, {});
  ASSERT_TRUE(renderer);
  RenderOptions options = small();
  options.sampling.max = 16;
  for (const int stop : {1, 2, 4, 8}) {
    std::atomic<bool> cancel{false};
    RunOptions run;
    run.cancel = &cancel;
    const auto cut_short = renderer->render(options, run, [&](int samples) { cancel = samples == stop; });
    ASSERT_TRUE(cut_short);
    EXPECT_TRUE(cut_short->interrupted);
    EXPECT_EQ(cut_short->report.samples, stop);
    RenderOptions fewer = options;
    fewer.sampling.max = stop;
    const auto asked_for = renderer->render(fewer, {});
    ASSERT_TRUE(asked_for);
    EXPECT_FALSE(asked_for->interrupted);
    EXPECT_EQ(cut_short->film.color, asked_for->film.color) << stop;
  }
}

TEST(Render, TheEmptySkyTakesTheFewestSamplesAndTheOutlineTheMost) {
  RenderOptions options = small();
  options.sampling.max = 16;
  options.light.ground = false;
  options.aovs = {Aov::kSamples, Aov::kDepth};
  const auto out = render(scenes::sphere({0, 0, 0}, 1), options, {});
  ASSERT_TRUE(out);
  const std::vector<float>& samples = out->film.aov(Aov::kSamples);
  EXPECT_EQ(samples.front(), 1);
  EXPECT_EQ(samples.back(), 1);
  EXPECT_EQ(*std::max_element(samples.begin(), samples.end()), 16);
  EXPECT_LT(out->report.samples_per_pixel, 8);
}

TEST(Render, MattesOfAPixelAddUpToWhatItsSamplesHit) {
  RenderOptions options = small();
  options.aovs = {Aov::kCryptomatte, Aov::kDepth};
  options.camera.eye = Vec3(0, -3, 3);
  options.camera.target = Vec3(0, 0, 0);  // from above: the ground fills what the tree leaves
  const auto out = render(scenes::forked(), options, {});
  ASSERT_TRUE(out);
  const std::vector<float>& mattes = out->film.aov(Aov::kCryptomatte);
  int shared = 0;
  for (std::size_t i = 0; i < out->film.pixels(); ++i) {
    float covered = 0;
    for (int rank = 0; rank < 12; ++rank) covered += mattes[24 * i + 2 * rank + 1];
    EXPECT_NEAR(covered, 1, 1e-6) << i;
    shared += mattes[24 * i + 3] > 0;
  }
  EXPECT_GT(shared, 20);
  EXPECT_EQ(out->film.branches, (std::set<std::int32_t>{-1, 0, 1}));
  options.light.ground = false;
  options.camera.eye.reset();
  const auto before_sky = render(scenes::forked(), options, {});
  ASSERT_TRUE(before_sky);
  EXPECT_EQ(before_sky->film.aov(Aov::kCryptomatte)[1], 0);
  EXPECT_FALSE(before_sky->film.branches.contains(-1));
}

TEST(Render, ATransparentBackdropHasNoAlphaAndTheTreeAll) {
  RenderOptions options = small();
  options.light.ground = false;
  options.light.backdrop = Backdrop::kTransparent;
  const auto out = render(scenes::sphere({0, 0, 0}, 1), options, {});
  ASSERT_TRUE(out);
  EXPECT_TRUE(out->film.transparent);
  const auto rgba = [&](int x, int y) { return &out->film.color[4 * (std::size_t(y) * 48 + x)]; };
  for (int c = 0; c < 4; ++c) EXPECT_EQ(rgba(0, 0)[c], 0);
  EXPECT_EQ(rgba(24, 32)[3], 1);
  int partly = 0;
  for (std::size_t i = 0; i < out->film.pixels(); ++i) partly += out->film.color[4 * i + 3] > 0 && out->film.color[4 * i + 3] < 1;
  EXPECT_GT(partly, 40);
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
  options.sampling.min = 0;
  EXPECT_THROW(render(field, options, {}), InputError);
  options = small();
  options.sampling.min = 9;
  EXPECT_THROW(render(field, options, {}), InputError);
  options = small();
  options.sampling.max = 65536;
  EXPECT_THROW(render(field, options, {}), InputError);
  for (const PixelRect crop : {PixelRect{0, 0, 49, 64}, PixelRect{-1, 0, 8, 8}, PixelRect{8, 8, 8, 9}, PixelRect{9, 8, 8, 9}}) {
    options = small();
    options.crop = crop;
    EXPECT_THROW(render(field, options, {}), InputError);
  }
}

}  // namespace
}  // namespace cambium
