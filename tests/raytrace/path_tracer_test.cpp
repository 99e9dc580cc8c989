#include "raytrace/path_tracer.h"

#include "blobtree/input_error.h"
#include "raytrace/directions.h"
#include "raytrace/tone.h"
#include "tests/raytrace/scenes.h"

#include <gtest/gtest.h>

#include <cmath>
#include <memory>
#include <numbers>
#include <vector>

namespace cambium {
namespace {

std::vector<BarkMaterial> plain(double albedo) { return {{BarkStyle::kSmooth, Vec3(albedo), Vec3(albedo), 1, nullptr, 0.3}}; }

Light white_room(float radiance = 1) {
  Light light;
  light.sky = SkyKind::kEnvironment;
  light.environment = std::make_shared<const Environment>(Pixels{2, 1, 1, {radiance, radiance}, false});
  light.sun = false;
  light.ground = false;
  return light;
}

Light dark_room() {
  Light light;
  light.sky = SkyKind::kGradient;
  light.sky_zenith = light.sky_horizon = light.ground_color = Vec3(0.0);
  light.sun = false;
  light.ground = false;
  return light;
}

PathOptions smooth_bark(int bounces) {
  PathOptions options;
  options.bounces = bounces;
  options.relief = false;
  return options;
}

/// A scene and the means of its samples.
struct Studio {
  Studio(const Field& field, const Light& light, const PathOptions& options, double albedo = 0.5,
         std::optional<Ground> ground = std::nullopt)
      : tracer(*cover_surface(field, {}, {})), bark(plain(albedo)), paths(tracer, bark, light, ground, 1e-3, options) {}

  CameraSample take(const Ray& ray, int x, std::uint32_t index) {
    const PixelSampler sampler(11, x, 0);
    return paths.sample(evaluator, {ray.origin, glm::normalize(ray.direction)}, sampler, index);
  }
  struct Mean {
    Vec3 color{0.0}, direct{0.0}, albedo{0.0};
    double occlusion = 0, alpha = 0;
  };
  Mean mean(const Ray& ray, int samples) {
    Mean out;
    for (int i = 0; i < samples; ++i) {
      const CameraSample s = take(ray, i >> 12, static_cast<std::uint32_t>(i & 4095));
      const double share = 1.0 / samples;
      out.color += share * s.color();
      out.direct += share * s.direct;
      out.albedo += share * s.albedo;
      out.occlusion += share * s.occlusion;
      out.alpha += share * s.alpha;
    }
    return out;
  }

  Tracer tracer;
  Bark bark;
  PathTracer paths;
  Evaluator evaluator;
};

/// In the furnace nothing shows but its reflectance, which for this bark's is not quite 1.
TEST(PathTracer, InAWhiteRoomAConvexBodyShowsItsReflectanceAtAnyNumberOfBounces) {
  for (int bounces : {0, 1, 6}) {
    Studio studio(scenes::sphere({0, 0, 0}, 1), white_room(), smooth_bark(bounces), 0.95);
    for (double aside : {0.0, 0.5, 0.9, 0.99}) {
      const auto seen = studio.mean({{-4, aside, 0}, {1, 0, 0}}, 4096);
      ASSERT_GT(seen.albedo.g, 0.75);
      for (int c = 0; c < 3; ++c) EXPECT_NEAR(seen.color[c] / seen.albedo[c], 1, 0.01) << bounces << ' ' << aside;
    }
    EXPECT_NEAR(studio.mean({{-4, 2, 0}, {1, 0, 0}}, 4).color.r, 1, 1e-6);
  }
}

TEST(PathTracer, InAWhiteRoomNothingIsBrighterThanTheRoomAndBouncesFillTheFork) {
  Studio once(scenes::forked(), white_room(), smooth_bark(0), 0.9), often(scenes::forked(), white_room(), smooth_bark(12), 0.9);
  double dark = 0, filled = 0;
  for (double z = 0.3; z < 0.9; z += 0.1) {
    const Ray ray{{0.6, -3, z}, Vec3(-0.17, 1, 0)};
    const double a = once.mean(ray, 2048).color.g, b = often.mean(ray, 2048).color.g;
    EXPECT_LE(a, 1.01) << z;
    EXPECT_LE(b, 1.01) << z;
    EXPECT_GE(b, a - 0.01) << z;
    dark += 1 - a;
    filled += 1 - b;
  }
  EXPECT_LT(filled, dark);
}

TEST(PathTracer, GuidedAndBlindSkyRaysAgreeOnAnEnvironment) {
  // The even image is sampled by both; the gradient of the same radiance by rays alone.
  Light even = dark_room();
  even.sky_zenith = even.sky_horizon = Vec3(1.0);
  even.ground_color = Vec3(1.0);   // and so below the horizon
  Studio guided(scenes::trunk(), white_room(), smooth_bark(2)), blind(scenes::trunk(), even, smooth_bark(2));
  const Ray ray{{-3, 0.1, 1}, {1, 0, 0}};
  EXPECT_NEAR(guided.mean(ray, 8192).color.g, blind.mean(ray, 8192).color.g, 0.01);
}

TEST(PathTracer, TheSunLightsTheSideThatFacesIt) {
  Light light = dark_room();
  light.sun = true;
  light.sun_color = Vec3(2.0);
  light.sun_azimuth = std::numbers::pi / 2;   // from +y
  light.sun_elevation = 0;
  Studio studio(scenes::sphere({0, 0, 0}, 1), light, smooth_bark(0));
  const double towards = studio.mean({{-4, 0.7, 0}, {1, 0, 0}}, 64).direct.g;
  EXPECT_GT(towards, 0.5);
  EXPECT_EQ(studio.mean({{-4, -0.7, 0}, {1, 0, 0}}, 64).direct.g, 0);
  EXPECT_LT(studio.mean({{-4, 0.05, 0}, {1, 0, 0}}, 64).direct.g, 0.2 * towards);
}

TEST(PathTracer, NoSurfaceStandsInItsOwnLightHoweverLowTheSun) {
  // Convex, so that nothing else does.
  Light light = dark_room();
  light.sun = true;
  light.sun_color = Vec3(2.0);
  light.sun_azimuth = 0;
  light.sun_size = 1e-6;
  int facing = 0;
  for (const Field& field : {scenes::sphere({0, 0, 0}, 1), scenes::sphere({3, 2, 30}, 0.001), scenes::sawn()}) {
    const Box& box = field.bounds();
    for (const double elevation : {1e-2, 1e-3, 1e-4}) {
      light.sun_elevation = elevation;
      Studio studio(field, light, smooth_bark(0));
      for (int i = 0; i < 200; ++i) {
        const double along = 0.2 + 0.6 * i / 200;
        const Ray ray{{glm::mix(box.lo.x, box.hi.x, along), box.center().y, box.hi.z + 1}, {0, 0, -1}};
        const CameraSample seen = studio.take(ray, i, 0);
        const Vec3 to_sun(std::cos(elevation), 0, std::sin(elevation));
        if (seen.branch < 0 || glm::dot(seen.normal, to_sun) < 0.5 * elevation) continue;
        ++facing;
        EXPECT_GT(seen.direct.g, 0) << i << ' ' << elevation;
      }
    }
  }
  EXPECT_GT(facing, 500);
}

TEST(PathTracer, TheShadowOnTheGroundLiesAwayFromTheSunWithAPenumbraOfItsSize) {
  Light light = dark_room();
  light.ground = true;
  light.ground_color = Vec3(0.5);
  light.sun = true;
  light.sun_color = Vec3(1.0);
  light.sun_azimuth = 0;
  light.sun_elevation = std::numbers::pi / 4;
  light.sun_size = 0.1;
  Studio studio(scenes::sphere({0, 0, 2}, 0.5), light, smooth_bark(0), 0.5, Ground{0, 1e9});
  const auto lit = [&](double x) { return studio.mean({{x, -3, 5}, {0, 3, -5}}, 256).direct.g; };
  const double open = lit(6);
  EXPECT_NEAR(open, 0.5 * std::sqrt(0.5), 0.06);   // the soil is mottled
  EXPECT_NEAR(lit(-2), 0, 1e-12);
  EXPECT_GT(lit(2), 0.8 * open);
  // The rim of the shadow, 0.5 / sin(45 degrees) from its middle, is half lit.
  const double rim = lit(-2 - 0.5 * std::numbers::sqrt2);
  EXPECT_GT(rim, 0.2 * open);
  EXPECT_LT(rim, 0.8 * open);
}

TEST(PathTracer, ALampGivesItsIrradianceWhicheverWayItIsFound) {
  // So wide that rays of the surface find it often, so that both strategies count.
  Light light = dark_room();
  AreaLight lamp;
  lamp.shape = AreaLight::Shape::kDisc;
  lamp.position = {0, 0, 4};
  lamp.radius = 3;
  lamp.radiance = Vec3(1.0);
  light.area = {lamp};
  Studio studio(scenes::sphere({0, 0, 0}, 1), light, smooth_bark(0));
  const auto seen = studio.mean({{2, 0, 3}, {-2, 0, -2}}, 16384);   // its top
  EXPECT_NEAR(seen.color.g / seen.albedo.g, 0.5, 0.06);   // the coat takes some and gives some
  light.ground_color = Vec3(0.5);
  Studio matt(scenes::sphere({0, 0, -100}, 1), light, smooth_bark(0), 0.5, Ground{1, 1e9});
  const auto ground = matt.mean({{2, 0, 3}, {-2, 0, -2}}, 16384);
  EXPECT_NEAR(ground.color.r / ground.albedo.r, 0.5, 0.01);
}

TEST(PathTracer, TheGroundSendsItsColourToTheUndersideByOneBounceAndNotByNone) {
  Light light = dark_room();
  light.ground = true;
  light.ground_color = Vec3(0.6, 0.1, 0.1);
  light.sun = true;
  light.sun_color = Vec3(2.0);
  light.sun_elevation = 1.2;
  const Ray underside{{-4, 0, 0.2}, Vec3(4, 0, 1.1)};
  Studio none(scenes::sphere({0, 0, 2}, 0.7), light, smooth_bark(0), 0.5, Ground{0, 1e9});
  Studio one(scenes::sphere({0, 0, 2}, 0.7), light, smooth_bark(1), 0.5, Ground{0, 1e9});
  EXPECT_EQ(none.mean(underside, 256).color.r, 0);
  const Vec3 lit = one.mean(underside, 1024).color;
  EXPECT_GT(lit.r, 0.1);
  EXPECT_GT(lit.r, 4 * lit.g);
}

TEST(PathTracer, ACatcherShowsOnlyShadowAndAlphaIsTheLightThatIsMissing) {
  Light light;
  light.catcher = true;
  light.backdrop = Backdrop::kTransparent;
  light.sun_azimuth = 0;
  light.sun_elevation = std::numbers::pi / 4;
  Studio studio(scenes::sphere({0, 0, 2}, 0.5), light, smooth_bark(1), 0.5, Ground{0, 1e9});
  const auto on_ground = [&](double x) { return studio.mean({{x, -3, 5}, {0, 3, -5}}, 1024); };
  const auto shadow = on_ground(-2), open = on_ground(40);
  EXPECT_EQ(shadow.color, Vec3(0.0));
  const Lights lights(light);
  const double by_sun = luminance(lights.sharp_on_level_ground()) / luminance(lights.on_level_ground());
  EXPECT_GT(shadow.alpha, by_sun);
  EXPECT_LT(shadow.alpha, by_sun + 0.1);
  EXPECT_NEAR(open.alpha, 0, 0.003);
  EXPECT_EQ(studio.mean({{-4, 0, 5}, {1, 0, 0.5}}, 4).alpha, 0);
  EXPECT_EQ(studio.mean({{-4, 0, 2}, {1, 0, 0}}, 4).alpha, 1);
}

TEST(PathTracer, ACatcherBeforeAColourDarkensItAndNothingElse) {
  Light light;
  light.catcher = true;
  light.backdrop = Backdrop::kColor;
  light.backdrop_color = Vec3(0.2, 0.4, 0.6);
  light.sun_azimuth = 0;
  light.sun_elevation = std::numbers::pi / 4;
  Studio studio(scenes::sphere({0, 0, 2}, 0.5), light, smooth_bark(1), 0.5, Ground{0, 1e9});
  const auto on_ground = [&](double x) { return studio.mean({{x, -3, 5}, {0, 3, -5}}, 512).color; };
  const Vec3 open = on_ground(40), shadow = on_ground(-2);
  for (int c = 0; c < 3; ++c) EXPECT_NEAR(open[c], light.backdrop_color[c], 0.005);
  EXPECT_LT(shadow.g, 0.5 * open.g);
  EXPECT_NEAR(shadow.r / shadow.b, open.r / open.b, 1e-3);
}

TEST(PathTracer, OcclusionIsTheHiddenShareOfTheHemisphereWithinItsDistance) {
  PathOptions options = smooth_bark(1);
  options.occlusion_distance = 1;
  // The side of a ball just above the ground sees it in half of its hemisphere; far above, not within a metre.
  Light light;
  Studio low(scenes::sphere({0, 0, 0.5}, 0.05), light, options, 0.5, Ground{0.44, 1e9});
  EXPECT_NEAR(low.mean({{-4, 0, 0.5}, {1, 0, 0}}, 4096).occlusion, 0.48, 0.03);
  Studio high(scenes::sphere({0, 0, 3}, 0.05), light, options, 0.5, Ground{0, 1e9});
  EXPECT_NEAR(high.mean({{-4, 0, 3}, {1, 0, 0}}, 1024).occlusion, 0, 1e-9);
}

TEST(PathTracer, AClampBoundsWhatOneSampleBringsFromAround) {
  Light light = white_room(100);
  PathOptions options = smooth_bark(1);
  Studio open(scenes::trunk(), light, options);
  options.clamp = 2;
  Studio clamped(scenes::trunk(), light, options);
  const Ray ray{{-3, 0.1, 1}, {1, 0, 0}};
  EXPECT_GT(luminance(open.mean(ray, 256).color), 30);
  EXPECT_LE(luminance(clamped.mean(ray, 256).color), 4.001);   // light samples and rays, each
}

TEST(PathTracer, RefusesOptionsOutOfRange) {
  const auto refuses = [](const Light& light, const PathOptions& options) {
    EXPECT_THROW(Studio(scenes::trunk(), light, options), InputError);
  };
  refuses({}, {.bounces = -1});
  refuses({}, {.bounces = kMostBounces + 1});
  refuses({}, {.occlusion_distance = 0});
  refuses({}, {.clamp = 0});
  Light light;
  light.sky = SkyKind::kEnvironment;
  refuses(light, {});
  light = {};
  light.area = {AreaLight{.width = 0}};
  refuses(light, {});
  light.area = {AreaLight{.direction = Vec3(0.0)}};
  refuses(light, {});
}

TEST(PathTracer, SaysWhatItHit) {
  Studio studio(scenes::forked(), white_room(), {});
  const CameraSample s = studio.take({{3, 0, 0.9}, {-1, 0, 0}}, 0, 0);
  EXPECT_EQ(s.branch, 1);
  EXPECT_EQ(s.order, 1);
  EXPECT_NEAR(s.position.x + s.depth, 3, 1e-9);
  EXPECT_NEAR(glm::length(s.normal), 1, 1e-9);
  EXPECT_EQ(studio.take({{3, 0, 5}, {-1, 0, 0}}, 0, 0).branch, -1);
}

TEST(PathTracer, IsAPureFunctionOfPixelAndSample) {
  Studio a(scenes::forked(), Light(), {}, 0.5, Ground{0, 100}), b(scenes::forked(), Light(), {}, 0.5, Ground{0, 100});
  const Ray ray{{3, 0.1, 0.6}, {-1, 0, 0}};
  for (int x = 9; x >= 0; --x) b.take(ray, x, 3);   // what came before does not show
  for (int x = 0; x < 10; ++x) {
    const CameraSample s = a.take(ray, x, 2), t = b.take(ray, x, 2);
    EXPECT_EQ(s.color(), t.color());
    EXPECT_EQ(s.rays, t.rays);
  }
}

}  // namespace
}  // namespace cambium
