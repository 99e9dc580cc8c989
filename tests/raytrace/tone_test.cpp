#include "raytrace/tone.h"

#include <gtest/gtest.h>

#include <cmath>

namespace cambium {
namespace {

TEST(Tone, SrgbGoesBothWays) {
  for (double x = 0; x <= 1; x += 0.01) EXPECT_NEAR(linear_from_srgb(srgb_from_linear(x)), x, 1e-12);
  EXPECT_NEAR(srgb_from_linear(0.214), 0.5, 1e-3);
}

TEST(Tone, BrighterLightIsShownBrighterAndNeverBeyondWhite) {
  Vec3 last(-1e-9);
  for (double stops = -12; stops <= 24; stops += 0.25) {
    const Vec3 shown = display_from_linear(std::exp2(stops) * Vec3(1, 0.8, 0.6));
    for (int c = 0; c < 3; ++c) {
      EXPECT_GE(shown[c], last[c] - 1e-9);
      EXPECT_LE(shown[c], 1);
    }
    last = shown;
  }
}

TEST(Tone, GreyStaysGreyAndBlackBlack) {
  EXPECT_LT(glm::length(display_from_linear(Vec3(0.0))), 0.02);
  for (double light : {0.01, 0.18, 1.0, 10.0}) {
    const Vec3 shown = display_from_linear(Vec3(light));
    EXPECT_NEAR(shown.x, shown.y, 2e-3);
    EXPECT_NEAR(shown.z, shown.y, 2e-3);
  }
}

TEST(Tone, WhatIsNoNumberIsShownAsSomething) {
  for (const double bad : {std::nan(""), HUGE_VAL, -HUGE_VAL, -1.0}) {
    const Vec3 shown = display_from_linear({bad, 0.5, 0.5});
    for (int c = 0; c < 3; ++c) EXPECT_TRUE(shown[c] >= 0 && shown[c] <= 1);
  }
}

}  // namespace
}  // namespace cambium
