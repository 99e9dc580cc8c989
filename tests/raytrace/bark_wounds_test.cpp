#include "raytrace/bark_wounds.h"

#include "raytrace/tone.h"

#include <gtest/gtest.h>

#include <cmath>

namespace cambium {
namespace {

Contribution on_trunk(double u, double v) {
  Contribution c;
  c.weight = 0.5;
  c.u = u;
  c.v = v;
  c.radius = c.from_axis = 0.1;
  c.u_gradient = {0, 1 / (2 * 3.141592653589793 * 0.1), 0};
  c.v_gradient = {0, 0, 1};
  return c;
}

BarkLook wounded(const Contribution& c, const SurfaceTraits& traits, double footprint = 0, const BarkMaterial& material = {}) {
  BarkLook look;
  look.albedo = Vec3(0.25, 0.22, 0.18);
  Vec3 gradient(0.0);
  show_wounds(c, material, traits, footprint, 5, look, gradient);
  return look;
}

TEST(BarkWounds, ARidgeIsADarkLine) {
  double line = 0, beside = 0;
  for (int i = 0; i < 200; ++i) {
    const Contribution c = on_trunk(0.005 * i, 0.01 * i);
    line += luminance(wounded(c, {0, 1, 0}).albedo);
    beside += luminance(wounded(c, {0, 0.1, 0}).albedo);
  }
  EXPECT_LT(line, 0.5 * beside);
}

TEST(BarkWounds, WhiteBarkHasABlackBrowWellBesideTheLine) {
  const BarkMaterial birch{.style = BarkStyle::kBirch, .color = {0.7, 0.7, 0.7}, .crack_color = {0.03, 0.03, 0.03}};
  double brow = 0, fold = 0;
  for (int i = 0; i < 200; ++i) {
    const Contribution c = on_trunk(0.005 * i, 0.01 * i);
    brow += luminance(wounded(c, {0, 0.4, 0}, 0, birch).albedo);
    fold += luminance(wounded(c, {0, 0.4, 0}).albedo);
  }
  EXPECT_LT(brow, 0.6 * fold);
}

TEST(BarkWounds, AScarIsGreyWithinADarkerRim) {
  Vec3 wood(0.0), rim(0.0);
  for (int i = 0; i < 200; ++i) {
    const Contribution c = on_trunk(0.005 * i, 0.01 * i);
    wood += wounded(c, {0, 0, 0.9}).albedo / 200.0;
    rim += wounded(c, {0, 0, 0.47}).albedo / 200.0;
  }
  EXPECT_LT(wood.x - wood.z, 0.05);
  EXPECT_GT(luminance(wood), 1.3 * luminance(rim));
}

TEST(BarkWounds, ComeAndGoWithoutAStep) {
  for (int i = 0; i < 1000; ++i) {
    const double t = 0.001 * i, step = 1e-6;
    const Contribution c = on_trunk(0.3, 0.4);
    for (const SurfaceTraits& unit : {SurfaceTraits{1, 0, 0}, SurfaceTraits{0, 1, 0}, SurfaceTraits{0, 0, 1}}) {
      const auto at = [&](double k) { return wounded(c, {k * unit.cut, k * unit.ridge, k * unit.dent}); };
      EXPECT_NEAR(glm::length(at(t).albedo - at(t + step).albedo), 0, 1e-4);
      EXPECT_NEAR(at(t).roughness, at(t + step).roughness, 1e-4);
    }
  }
  EXPECT_EQ(wounded(on_trunk(0.3, 0.4), {}).albedo, Vec3(0.25, 0.22, 0.18));
}

TEST(BarkWounds, HaveNoSeamAtUZero) {
  for (int i = 0; i < 200; ++i) {
    const double v = 0.0173 * i;
    for (const SurfaceTraits& traits : {SurfaceTraits{1, 0, 0}, SurfaceTraits{0, 0.8, 0}, SurfaceTraits{0, 0, 0.5}}) {
      const Vec3 a = wounded(on_trunk(1e-10, v), traits).albedo, b = wounded(on_trunk(1 - 1e-10, v), traits).albedo;
      EXPECT_NEAR(glm::length(a - b), 0, 1e-4);
    }
  }
}

TEST(BarkWounds, LoseTheirDetailUnderALargePixel) {
  for (const SurfaceTraits& traits : {SurfaceTraits{0, 0.8, 0}, SurfaceTraits{0, 0, 0.9}}) {
    const Vec3 first = wounded(on_trunk(0, 0), traits, 1).albedo;
    for (int i = 1; i < 50; ++i) EXPECT_NEAR(glm::length(wounded(on_trunk(0.02 * i, 0.3 * i), traits, 1).albedo - first), 0, 1e-9);
  }
}

}  // namespace
}  // namespace cambium
