#include "raytrace/sky.h"

#include "raytrace/directions.h"
#include "raytrace/tone.h"

#include <gtest/gtest.h>

#include <cmath>
#include <numbers>

namespace cambium {
namespace {

constexpr double kDegree = std::numbers::pi / 180;

Daylight day(double turbidity, double elevation) { return Daylight(turbidity, direction_of(0.3, elevation * kDegree)); }

TEST(Daylight, TheZenithHasTheModelsLuminance) {
  // Eq. for Yz at turbidity 3, the sun 45 degrees up: 7.336 kcd/m2, in units of 12.5.
  const double chi = (4.0 / 9 - 3.0 / 120) * (std::numbers::pi / 2);
  const double expected = ((4.0453 * 3 - 4.9710) * std::tan(chi) - 0.2155 * 3 + 2.4192) / 12.5;
  EXPECT_NEAR(luminance(day(3, 45).radiance({0, 0, 1})), expected, 1e-3);
}

TEST(Daylight, TheZenithIsBlueAndTheHorizonPaler) {
  const Vec3 zenith = day(3, 45).radiance({0, 0, 1}), horizon = day(3, 45).radiance(direction_of(0.3 + std::numbers::pi, 0.02));
  EXPECT_GT(zenith.b, 1.5 * zenith.r);
  EXPECT_GT(horizon.r / horizon.b, 1.5 * zenith.r / zenith.b);
  EXPECT_GT(luminance(horizon), luminance(zenith));
}

TEST(Daylight, TheHorizonIsNotPink) {
  for (double turbidity : {3.0, 5.0}) {
    for (double azimuth = 0; azimuth < 6; azimuth += 0.5) {
      const Vec3 c = day(turbidity, 45).radiance(direction_of(azimuth, 0.03));
      EXPECT_GT(c.g, 0.985 * std::sqrt(c.r * c.b)) << turbidity << ' ' << azimuth;
    }
  }
}

TEST(Daylight, IsBrighterTowardsTheSun) {
  const Daylight sky = day(4, 30);
  const Vec3 near = sky.radiance(direction_of(0.3, 35 * kDegree));
  const Vec3 far = sky.radiance(direction_of(0.3 + std::numbers::pi, 35 * kDegree));
  EXPECT_GT(luminance(near), 2 * luminance(far));
}

TEST(Daylight, IsFiniteAndNeverNegativeWhereverTheSunIs) {
  for (double turbidity : {0.0, 2.0, 3.0, 6.0, 10.0, 50.0}) {
    for (double elevation = -90; elevation <= 90; elevation += 3) {
      const Daylight sky = day(turbidity, elevation);
      for (double up = -90; up <= 90; up += 7.5) {
        for (double azimuth = 0; azimuth < 6.3; azimuth += 0.3) {
          const Vec3 c = sky.radiance(direction_of(azimuth, up * kDegree));
          ASSERT_TRUE(c.r >= 0 && c.g >= 0 && c.b >= 0 && luminance(c) < 50)
              << turbidity << ' ' << elevation << ' ' << up << ": " << c.r << ' ' << c.g << ' ' << c.b;
        }
      }
      const Vec3 sun = daylight_sun(turbidity, elevation * kDegree, 0.005);
      ASSERT_TRUE(sun.r >= 0 && sun.g >= 0 && sun.b >= 0 && luminance(sun) < 5) << turbidity << ' ' << elevation;
    }
  }
}

TEST(Daylight, FadesWithoutAStepAsTheSunSetsToAHundredthAtSixDegrees) {
  double before = luminance(day(3, 3).radiance({0, 0, 1}));
  for (double elevation = 2.9; elevation > -8; elevation -= 0.1) {
    const double now = luminance(day(3, elevation).radiance({0, 0, 1}));
    EXPECT_LT(std::abs(now - before), 0.1 * before) << elevation;
    before = now;
  }
  EXPECT_NEAR(luminance(day(3, -6).radiance({0, 0, 1})) / luminance(day(3, 0).radiance({0, 0, 1})), 0.01, 1e-6);
}

TEST(DaylightSun, AtNoonItIsAsBrightAsMeasured) {
  // Direct normal illuminance of a clear summer noon: 80 to 105 klx; what white shows is that over pi, in units of 12.5 kcd/m2.
  const double klx = luminance(daylight_sun(2.5, 65 * kDegree, 0.00465)) * 12.5 * std::numbers::pi;
  EXPECT_GT(klx, 80);
  EXPECT_LT(klx, 105);
}

TEST(DaylightSun, ReddensAsItSetsAndIsGoneBelowTheHorizon) {
  double redness = 0, brightness = 10;
  for (double elevation : {60.0, 30.0, 15.0, 8.0, 4.0, 1.0}) {
    const Vec3 c = daylight_sun(3, elevation * kDegree, 0.00465);
    EXPECT_GT(c.r / c.b, redness) << elevation;
    EXPECT_LT(luminance(c), brightness) << elevation;
    redness = c.r / c.b;
    brightness = luminance(c);
  }
  EXPECT_EQ(daylight_sun(3, -0.3 * kDegree, 0.00465), Vec3(0.0));
  EXPECT_EQ(daylight_sun(3, -0.3 * kDegree, 0), Vec3(0.0));
}

TEST(DaylightSun, HazeTakesItsLight) {
  EXPECT_LT(luminance(daylight_sun(8, 0.7, 0.005)), 0.5 * luminance(daylight_sun(2, 0.7, 0.005)));
}

}  // namespace
}  // namespace cambium
