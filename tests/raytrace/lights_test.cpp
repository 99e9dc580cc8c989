#include "raytrace/lights.h"

#include "raytrace/directions.h"
#include "blobtree/place_hash.h"
#include "raytrace/tone.h"

#include <gtest/gtest.h>

#include <cmath>
#include <numbers>

namespace cambium {
namespace {

constexpr double kPi = std::numbers::pi;
constexpr int kSide = 200;

/// Irradiance over radiance and pi, at `from` on a surface with that normal.
double form_factor(const Lamp& lamp, const Vec3& from, const Vec3& normal) {
  double sum = 0;
  for (int i = 0; i < kSide * kSide; ++i) {
    const LightSample s = lamp.sample(from, {(i % kSide + 0.5) / kSide, (i / kSide + 0.5) / kSide});
    if (s.pdf > 0) sum += std::max(0.0, glm::dot(normal, s.direction)) * s.radiance.r / s.pdf;
  }
  return sum / (kSide * kSide * kPi);
}

AreaLight facing_down(AreaLight::Shape shape) {
  AreaLight light;
  light.shape = shape;
  light.position = {0, 0, 2};
  light.radiance = Vec3(1.0);
  return light;
}

TEST(Lamp, ADiscGivesTheAnalyticIrradianceBelowItsMiddle) {
  AreaLight light = facing_down(AreaLight::Shape::kDisc);
  light.radius = 1.5;
  EXPECT_NEAR(form_factor(Lamp(light), Vec3(0.0), {0, 0, 1}), 1.5 * 1.5 / (1.5 * 1.5 + 2 * 2), 1e-3);
}

TEST(Lamp, ARectangleGivesTheAnalyticIrradianceBelowItsCorner) {
  AreaLight light = facing_down(AreaLight::Shape::kRectangle);
  light.width = 3;
  light.height = 1;
  // The width lies along y: across the direction and the vertical there is no telling, and the sides are taken as they come.
  const Lamp lamp(light);
  const auto corner = [](double a, double b, double c) {
    const double x = a / c, y = b / c;
    return (x / std::sqrt(1 + x * x) * std::atan(y / std::sqrt(1 + x * x)) +
            y / std::sqrt(1 + y * y) * std::atan(x / std::sqrt(1 + y * y))) / (2 * kPi);
  };
  EXPECT_NEAR(form_factor(lamp, Vec3(0.0), {0, 0, 1}), 4 * corner(1.5, 0.5, 2), 1e-3);
}

TEST(Lamp, ASphereGivesTheAnalyticIrradiance) {
  AreaLight light = facing_down(AreaLight::Shape::kSphere);
  light.radius = 0.7;
  const double tilt = 0.6;
  EXPECT_NEAR(form_factor(Lamp(light), Vec3(0.0), {std::sin(tilt), 0, std::cos(tilt)}), 0.7 * 0.7 / 4 * std::cos(tilt), 1e-3);
}

TEST(Lamp, RaysMeetItWhereSamplesSayAndWithTheirPdf) {
  for (const auto shape : {AreaLight::Shape::kRectangle, AreaLight::Shape::kDisc, AreaLight::Shape::kSphere}) {
    AreaLight light = facing_down(shape);
    light.direction = {0.3, 0.2, -1};
    const Lamp lamp(light);
    const Vec3 from(0.4, -0.3, 0.1);
    for (int i = 0; i < 500; ++i) {
      const LightSample s = lamp.sample(from, {unit_of(hash_of(1, i)), unit_of(hash_of(2, i))});
      ASSERT_GT(s.pdf, 0);
      const auto met = lamp.met({from, s.direction});
      ASSERT_TRUE(met);
      EXPECT_NEAR(met->distance, s.distance, 1e-4);
      EXPECT_NEAR(met->pdf, s.pdf, 1e-6 * s.pdf);
    }
    EXPECT_FALSE(lamp.met({from, {0, 0, -1}}));
    EXPECT_FALSE(lamp.met({from, {1, 0, 0}}));
  }
}

TEST(Lamp, ShinesToItsFrontOnly) {
  const Lamp lamp(facing_down(AreaLight::Shape::kRectangle));
  EXPECT_EQ(lamp.sample({0, 0, 5}, {0.4, 0.4}).pdf, 0);
  EXPECT_FALSE(lamp.met({{0, 0, 5}, {0, 0, -1}}));
  EXPECT_EQ(Lamp(facing_down(AreaLight::Shape::kSphere)).sample({0, 0.1, 2}, {0.4, 0.4}).pdf, 0);
}

TEST(MisWeight, SharesOfTwoStrategiesAddUpToOne) {
  EXPECT_DOUBLE_EQ(mis_weight(0.3, 1.7) + mis_weight(1.7, 0.3), 1);
  EXPECT_EQ(mis_weight(0, 0), 0);
  EXPECT_EQ(mis_weight(2, 0), 1);
}

TEST(Lights, TheSunLiesWhereItsAnglesSayAndIsAsLargeAsAsked) {
  Light light;
  light.sun_azimuth = 1.1;
  light.sun_elevation = 0.4;
  light.sun_size = 0.05;
  const Lights lights(light);
  double widest = 0;
  for (int i = 0; i < 1000; ++i) {
    const LightSample s = lights.sun({unit_of(hash_of(1, i)), unit_of(hash_of(2, i))});
    widest = std::max(widest, std::acos(std::min(1.0, glm::dot(s.direction, direction_of(1.1, 0.4)))));
  }
  EXPECT_LE(widest, 0.0501);
  EXPECT_GT(widest, 0.049);
  EXPECT_GT(luminance(lights.sun_disc(direction_of(1.1, 0.43))), 100);
  EXPECT_EQ(lights.sun_disc(direction_of(1.1, 0.46)), Vec3(0.0));
}

TEST(Lights, WithoutSunThereIsNone) {
  Light light;
  light.sun = false;
  EXPECT_FALSE(Lights(light).sunlit());
  light.sun = true;
  light.sun_color = Vec3(0.0);
  EXPECT_FALSE(Lights(light).sunlit());
  light.sun_color.reset();
  light.sun_elevation = -0.1;
  EXPECT_FALSE(Lights(light).sunlit());
}

TEST(Lights, AnEvenGradientShowsItselfOnLevelGround) {
  Light light;
  light.sky = SkyKind::kGradient;
  light.sky_zenith = light.sky_horizon = Vec3(0.3, 0.5, 0.8);
  light.sun = false;
  const Lights lights(light);
  for (int c = 0; c < 3; ++c) EXPECT_NEAR(lights.on_level_ground()[c], light.sky_zenith[c], 1e-9);
}

TEST(Lights, TheHorizonIsNoStep) {
  for (const SkyKind sky : {SkyKind::kDaylight, SkyKind::kGradient}) {
    Light light;
    light.sky = sky;
    const Lights lights(light);
    double before = luminance(lights.around(direction_of(2.0, -0.2)));
    for (double up = -0.2; up < 0.2; up += 0.001) {
      const double now = luminance(lights.around(direction_of(2.0, up)));
      EXPECT_LT(std::abs(now - before), 0.03);
      before = now;
    }
  }
}

}  // namespace
}  // namespace cambium
