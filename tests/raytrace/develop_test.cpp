#include "raytrace/develop.h"

#include "raytrace/framing.h"
#include "raytrace/smoothing.h"

#include <gtest/gtest.h>

namespace cambium {
namespace {

/// Half a wall, half nothing: every other sample hits.
class HalfHit : public SampleSource {
 public:
  CameraSample sample(int x, int y, std::uint32_t index) const override {
    CameraSample sample;
    sample.alpha = index % 2 ? 1 : 0;
    if (index % 2 == 0) return sample;
    sample.direct = Vec3(0.2);
    sample.albedo = Vec3(0.5);
    sample.ambient = Vec3(0.4);
    sample.normal = Vec3(0, -1, 0);
    sample.position = Vec3(x, y, 7);
    sample.uv = {0.25, 3};
    sample.depth = 2 + index;
    sample.branch = 5;
    sample.order = 1;
    sample.ridge = 0.5;
    sample.occlusion = 0.25;
    return sample;
  }
};

constexpr PixelRect kWhole{0, 0, 20, 30};

Film developed(const PixelRect& crop, const DevelopOptions& options) {
  Frame frame(kWhole, kWhole, {.first_hits = true});
  std::vector<std::uint32_t> pixels(kWhole.size());
  for (std::size_t i = 0; i < pixels.size(); ++i) pixels[i] = static_cast<std::uint32_t>(i);
  const RunOptions run;
  ProgressMeter progress(run, "render");
  EXPECT_TRUE(frame.take(HalfHit(), pixels, 4, progress, 1, {}));
  return develop(frame, crop, options);
}

DevelopOptions options_with(const std::set<Aov>& aovs) {
  Camera camera;
  camera.eye = Vec3(0, -3, 0);
  DevelopOptions options;
  options.view = frame(camera, {}, kWhole.width(), kWhole.height());
  options.aovs = aovs;
  return options;
}

TEST(Develop, ColourIsTheMeanOfAllSamplesTimesExposure) {
  for (const bool smooth : {true, false}) {
    DevelopOptions options = options_with({});
    options.exposure = 2;
    options.smooth = smooth;
    const Film film = developed(kWhole, options);
    for (int c = 0; c < 3; ++c) EXPECT_NEAR(film.color[c], 2 * 0.5 * (0.2 + 0.5 * 0.4), 1e-6);
    EXPECT_EQ(film.color[3], 0.5f);
    EXPECT_TRUE(film.aovs.empty());
  }
}

TEST(Develop, AovsAreOfTheNearestHitOrMeansOverHits) {
  std::set<Aov> every;
  for (const AovInfo& info : all_aovs()) every.insert(info.aov);
  const PixelRect crop{3, 4, 9, 6};
  const Film film = developed(crop, options_with(every));
  EXPECT_EQ(film.x, 3);
  EXPECT_EQ(film.y, 4);
  EXPECT_EQ(film.width, 6);
  EXPECT_EQ(film.full_height, 30);
  for (const AovInfo& info : all_aovs()) EXPECT_EQ(film.aov(info.aov).size(), film.pixels() * info.channels.size()) << info.name;
  EXPECT_EQ(film.aov(Aov::kDepth)[0], 3);
  EXPECT_EQ(film.aov(Aov::kPosition)[0], 3);
  EXPECT_EQ(film.aov(Aov::kPosition)[1], 4);
  EXPECT_EQ(film.aov(Aov::kPosition)[2], 7);
  EXPECT_EQ(film.aov(Aov::kNormal)[1], -1);
  EXPECT_EQ(film.aov(Aov::kAlbedo)[0], 0.5f);
  EXPECT_EQ(film.aov(Aov::kUv)[1], 3);
  EXPECT_EQ(film.aov(Aov::kBranch)[0], 5);
  EXPECT_EQ(film.aov(Aov::kOrder)[0], 1);
  EXPECT_EQ(film.aov(Aov::kRidge)[0], 0.5f);
  EXPECT_EQ(film.aov(Aov::kOcclusion)[0], 0.25f);
  EXPECT_EQ(film.aov(Aov::kSamples)[0], 4);
  EXPECT_EQ(film.aov(Aov::kCryptomatte)[1], 0.5f);
  EXPECT_EQ(film.branches, std::set<std::int32_t>{5});
}

TEST(Develop, NeedsTheSmoothingsReachAroundACrop) {
  const PixelRect whole{0, 0, 500, 500}, crop{200, 200, 210, 220};
  EXPECT_EQ(developed_area(crop, whole, true), crop.grown(kSmoothingReach));
  EXPECT_EQ(developed_area(crop, whole, false), crop);
  EXPECT_EQ(developed_area({0, 0, 10, 10}, whole, true), (PixelRect{0, 0, 10 + kSmoothingReach, 10 + kSmoothingReach}));
}

}  // namespace
}  // namespace cambium
