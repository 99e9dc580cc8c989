// Leaves in pictures: their shadows, their holes, and the light that they let through.
#include "raytrace/cryptomatte.h"
#include "raytrace/render.h"
#include "tests/raytrace/foliage_scenes.h"
#include "tests/raytrace/scenes.h"

#include <gtest/gtest.h>

#include <algorithm>

namespace cambium {
namespace {

/// The sun at the zenith, no other light.
Light noon() {
  Light light;
  light.sky = SkyKind::kGradient;
  light.sky_zenith = light.sky_horizon = Vec3(0.0);
  light.sun_elevation = 1.5707963;
  light.sun_color = Vec3(2.0);
  light.ground_height = 0;
  light.ground_color = Vec3(0.5);
  return light;
}

/// A view from straight above or below of what lies within a metre of the axis; the wood is a small ball far aside.
RenderOptions looking(double eye_height) {
  RenderOptions options;
  options.width = options.height = 64;
  options.sampling = {4, 4, 0, 0};
  options.light = noon();
  options.paths.bounces = 0;
  options.smooth = false;
  options.camera.eye = Vec3(0.001, 0, eye_height);
  options.camera.target = Vec3(0, 0, 1);
  options.camera.field_of_view = 2 * std::atan(1.5 / std::abs(eye_height - 1));
  options.aovs = {Aov::kBranch, Aov::kDepth, Aov::kAlbedo, Aov::kNormal};
  return options;
}

Field aside() { return scenes::sphere({100, 0, 0.2}, 0.1); }

Rendered rendered(const RenderOptions& options, FoliageScene foliage, int threads = 0) {
  const Field field = aside();
  RunOptions run;
  run.threads = threads;
  return *Renderer::make(field, run, std::move(foliage))->render(options, run);
}

/// Mean red over the pixels of a rectangle.
double mean(const Film& film, const PixelRect& part) {
  double sum = 0;
  for (int y = part.y0; y < part.y1; ++y)
    for (int x = part.x0; x < part.x1; ++x) sum += film.color[4 * (std::size_t(y) * film.width + x)];
  return sum / double(part.size());
}

FoliageMaterial matt(double color, double translucency) {
  FoliageMaterial material;
  material.color = Vec3(color);
  material.translucency = translucency;
  material.roughness = 1;
  return material;
}

const PixelRect kMiddle{28, 28, 36, 36};

/// What the ground shows at x, seen from below a leaf that is a metre up.
double ground_at(double x, const FoliageScene& foliage) {
  RenderOptions options = looking(4);
  options.camera.eye = Vec3(x, 0.001, 0.5);
  options.camera.target = Vec3(x, 0, 0);
  options.camera.field_of_view = 0.2;
  return mean(rendered(options, foliage).film, kMiddle);
}

TEST(FoliageLight, ALeafBetweenTheSunAndTheGroundCastsAShadowWithItsHole) {
  FoliageMaterial holed = matt(0.5, 0);
  holed.texture = scenes::holed();
  const double open = ground_at(0, {});
  EXPECT_GT(open, 0.1);
  EXPECT_LT(ground_at(0, scenes::level_leaf(4, 1, matt(0.5, 0))), 0.01 * open);
  EXPECT_NEAR(ground_at(0, scenes::level_leaf(4, 1, holed)), open, 1e-3 * open) << "light falls through the hole";
  EXPECT_LT(ground_at(1.6, scenes::level_leaf(4, 1, holed)), 0.01 * open) << "but not through the leaf around it";
}

TEST(FoliageLight, TheDarkSideShowsWhatTheLeafLetsThrough) {
  const auto from_below = [](double translucency) {
    return mean(rendered(looking(-2), scenes::level_leaf(2, 1, matt(0.5, translucency))).film, kMiddle);
  };
  const auto from_above = [](double translucency) {
    return mean(rendered(looking(4), scenes::level_leaf(2, 1, matt(0.5, translucency))).film, kMiddle);
  };
  EXPECT_LT(from_below(0), 1e-6);
  const double through = from_below(0.5), lit = from_above(0.5);
  EXPECT_GT(through, 0.1);
  EXPECT_NEAR(from_below(0.25), 0.5 * through, 0.02 * through);
  EXPECT_GT(lit, through) << "the lit side also has its coat";
  EXPECT_LT(lit, 1.3 * through);
  EXPECT_LT(from_above(0.9), from_above(0.1));
}

TEST(FoliageLight, LayersSayWhatIsSeen) {
  const Rendered out = rendered(looking(4), scenes::level_leaf(2, 1, matt(0.5, 0.4)));
  const std::size_t middle = 32 * 64 + 32, corner = 2 * 64 + 2;
  EXPECT_EQ(out.film.aov(Aov::kBranch)[middle], 3);
  EXPECT_EQ(out.film.aov(Aov::kBranch)[corner], -1);
  EXPECT_NEAR(out.film.aov(Aov::kDepth)[middle], 3, 0.01);
  EXPECT_NEAR(out.film.aov(Aov::kNormal)[3 * middle + 2], 1, 1e-3);
  EXPECT_NEAR(out.film.aov(Aov::kAlbedo)[3 * middle], 0.5, 0.06);
}

TEST(FoliageLight, CryptomatteKnowsLeavesAsOne) {
  RenderOptions options = looking(4);
  options.aovs = {Aov::kCryptomatte};
  const Rendered out = rendered(options, scenes::level_leaf(2, 1, matt(0.5, 0.4)));
  EXPECT_TRUE(out.film.branches.contains(kLeaves));
  EXPECT_FALSE(out.film.branches.contains(3));
}

TEST(FoliageLight, LeavesInFrontOfATransparentBackdropAreOpaqueButForTheirHoles) {
  RenderOptions options = looking(4);
  options.light.ground = false;
  options.light.backdrop = Backdrop::kTransparent;
  FoliageMaterial holed = matt(0.5, 0);
  holed.texture = scenes::holed();
  const Film film = rendered(options, scenes::level_leaf(2, 1, holed)).film;
  const auto alpha = [&](int x, int y) { return film.color[4 * (std::size_t(y) * 64 + x) + 3]; };
  EXPECT_EQ(alpha(32, 32), 0);
  EXPECT_EQ(alpha(1, 1), 0);
  EXPECT_EQ(alpha(32, 15), 1);
}

TEST(FoliageLight, ACatcherTakesALeafsShadow) {
  RenderOptions options = looking(4);
  options.light.catcher = true;
  options.light.backdrop = Backdrop::kTransparent;
  options.camera.eye = Vec3(0, -8, 4);
  options.camera.target = Vec3(0, 0, 0);
  options.camera.field_of_view = 0.5;
  const Film film = rendered(options, scenes::level_leaf(1, 0.5, matt(0.5, 0))).film;
  double covered = 0;
  for (std::size_t i = 3; i < film.color.size(); i += 4) covered += film.color[i] / 4096;
  const Film bare = rendered(options, scenes::level_leaf(1, 50, matt(0.5, 0))).film;   // out of the picture, and its shadow small
  double with_leaf_far = 0;
  for (std::size_t i = 3; i < bare.color.size(); i += 4) with_leaf_far += bare.color[i] / 4096;
  EXPECT_GT(covered, with_leaf_far + 0.02);
}

TEST(FoliageLight, LeavesAreFramedWithTheWoodButACloseUpIsNot) {
  const Field field = scenes::trunk();
  RenderOptions options;
  options.width = options.height = 48;
  options.sampling = {4, 4, 0, 0};
  options.aovs = {Aov::kBranch};
  FoliageScene wide = scenes::level_leaf(1, 1.5, matt(0.5, 0.3));
  wide.instances[0].axes = 4.0 * Mat3(Vec3(1, 0, 0), Vec3(0, 0, 1), Vec3(0, -1, 0));
  wide.instances[0].branch = 7;
  const Rendered out = *Renderer::make(field, {}, wide)->render(options, {});
  const std::vector<float>& branch = out.film.aov(Aov::kBranch);
  EXPECT_GT(std::count(branch.begin(), branch.end(), 7.0f), 200);
  for (int i = 0; i < 48; ++i) EXPECT_NE(branch[static_cast<std::size_t>(i)], 7.0f) << "the leaf is cut by the picture's edge";
  options.camera.frame = Box{Vec3(-0.1, -0.1, 0.2), Vec3(0.1, 0.1, 0.4)};
  wide.instances[0].position.y = 10;   // behind the trunk, for it to be seen
  const Rendered near = *Renderer::make(field, {}, wide)->render(options, {});
  EXPECT_EQ(near.film.aov(Aov::kBranch)[24 * 48 + 24], 0);
}

TEST(FoliageLight, IsTheSameForAnyThreadCount) {
  const Field field = scenes::forked();
  FoliageMaterial holed = matt(0.5, 0.4);
  holed.texture = scenes::holed();
  FoliageScene scene = scenes::level_leaf(0.3, 0.9, holed);
  for (int i = 0; i < 40; ++i)
    scene.instances.push_back({0, {0.1 * std::cos(i), 0.1 * std::sin(i), 0.3 + 0.02 * i}, Mat3(0.1 + 0.002 * i), i});
  RenderOptions options;
  options.width = 48;
  options.height = 64;
  options.sampling.max = 8;
  options.aovs = {Aov::kNormal, Aov::kCryptomatte};
  RunOptions one, four;
  one.threads = 1;
  four.threads = 4;
  const auto a = Renderer::make(field, one, scene)->render(options, one), b = Renderer::make(field, four, scene)->render(options, four);
  EXPECT_EQ(a->film.color, b->film.color);
  EXPECT_EQ(a->film.aovs, b->film.aovs);
  EXPECT_EQ(a->report.rays, b->report.rays);
}

}  // namespace
}  // namespace cambium
