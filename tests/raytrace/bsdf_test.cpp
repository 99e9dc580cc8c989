#include "raytrace/bsdf.h"

#include "raytrace/directions.h"
#include "blobtree/place_hash.h"

#include <gtest/gtest.h>

#include <cmath>
#include <numbers>
#include <vector>

namespace cambium {
namespace {

constexpr double kPi = std::numbers::pi;
const Vec3 kUp(0, 0, 1);

Vec3 tilted(double angle, double azimuth = 0) { return direction_of(azimuth, kPi / 2 - angle); }

Bsdf flat(const Vec3& albedo, double roughness, double angle_out, bool coated = true) {
  return Bsdf({kUp, kUp, albedo, roughness, coated}, tilted(angle_out, 0.7));
}

/// Integral over the sphere of a function of direction, by a grid even in solid angle.
template <typename F>
auto over_sphere(const F& f, int side = 900) {
  auto sum = 0.0 * f(kUp);
  for (int i = 0; i < side; ++i) {
    for (int j = 0; j < side; ++j) {
      const double up = 1 - 2 * (i + 0.5) / side, azimuth = 2 * kPi * (j + 0.5) / side, level = std::sqrt(1 - up * up);
      sum += f(Vec3(level * std::cos(azimuth), level * std::sin(azimuth), up));
    }
  }
  return sum * (4 * kPi / (double(side) * side));
}

TEST(Bsdf, ThePdfIntegratesToOneButForWhatIsMirroredIntoTheGround) {
  for (double roughness : {0.4, 0.8, 1.0}) {
    for (double angle : {0.0, 0.6, 1.2}) {
      const Bsdf bsdf = flat(Vec3(0.3), roughness, angle);
      const double total = over_sphere([&](const Vec3& in) { return bsdf.pdf(in); });
      EXPECT_LE(total, 1.003) << roughness << ' ' << angle;
      EXPECT_GE(total, roughness < 0.5 ? 0.98 : 0.85) << roughness << ' ' << angle;
    }
  }
  EXPECT_NEAR(over_sphere([](const Vec3& in) { return flat(Vec3(0.3), 1, 0.5, false).pdf(in); }), 1, 1e-3);
}

TEST(Bsdf, AWhiteBodyGivesBackAllLight) {
  for (double roughness : {0.45, 0.6, 0.8, 1.0}) {
    for (double angle : {0.0, 0.5, 1.0, 1.4}) {
      const Bsdf bsdf = flat(Vec3(1.0), roughness, angle);
      EXPECT_NEAR(over_sphere([&](const Vec3& in) { return bsdf.value(in).r; }), 1, 0.012) << roughness << ' ' << angle;
      EXPECT_NEAR(bsdf.reflectance().r, 1, 1e-12);
    }
  }
}

TEST(Bsdf, WhatGoesOutIsItsReflectanceAndNeverMoreThanCameIn) {
  for (double roughness : {0.45, 0.8}) {
    for (double angle : {0.0, 0.8, 1.3, 1.5}) {
      const Bsdf bsdf = flat(Vec3(0.5, 0.2, 0.0), roughness, angle);
      const Vec3 out = over_sphere([&](const Vec3& in) { return bsdf.value(in); });
      for (int c = 0; c < 3; ++c) {
        EXPECT_NEAR(out[c], bsdf.reflectance()[c], 0.012) << roughness << ' ' << angle;
        EXPECT_LE(out[c], 1.0);
      }
    }
  }
}

TEST(Bsdf, IsReciprocal) {
  for (int i = 0; i < 200; ++i) {
    const auto number = [i](int k) { return unit_of(hash_of(7, i, k)); };
    const Vec3 a = tilted(1.5 * number(0), 6 * number(1)), b = tilted(1.5 * number(2), 6 * number(3));
    const double roughness = 0.2 + 0.8 * number(4);
    const Vec3 there = Bsdf({kUp, kUp, Vec3(0.4), roughness}, a).value(b) / b.z;
    const Vec3 back = Bsdf({kUp, kUp, Vec3(0.4), roughness}, b).value(a) / a.z;
    EXPECT_NEAR(there.r, back.r, 1e-9 * std::max(1.0, there.r));
  }
}

Bsdf sheet(double reflected, double through, double roughness, double angle_out, bool coated = true) {
  return Bsdf({kUp, kUp, Vec3(reflected), roughness, coated, Vec3(through)}, tilted(angle_out, 0.7));
}

TEST(Bsdf, AWhiteSheetSendsAllLightOnAndItsPartsToItsSides) {
  for (double angle : {0.0, 0.7, 1.3}) {
    const Bsdf white = sheet(0.6, 0.4, 0.6, angle), matt = sheet(0.6, 0.4, 1, angle, false);
    EXPECT_NEAR(over_sphere([&](const Vec3& in) { return white.value(in).r; }), 1, 0.012) << angle;
    EXPECT_NEAR(white.reflectance().r, 1, 1e-12);
    EXPECT_NEAR(over_sphere([&](const Vec3& in) { return in.z < 0 ? matt.value(in).r : 0; }), 0.4, 1e-3);
    EXPECT_NEAR(over_sphere([&](const Vec3& in) { return in.z > 0 ? matt.value(in).r : 0; }), 0.6, 1e-3);
  }
}

TEST(Bsdf, ASheetIsReciprocalThroughItself) {
  for (int i = 0; i < 200; ++i) {
    const auto number = [i](int k) { return unit_of(hash_of(9, i, k)); };
    const Vec3 above = tilted(1.5 * number(0), 6 * number(1)), below = -tilted(1.5 * number(2), 6 * number(3));
    const double roughness = 0.2 + 0.8 * number(4);
    const Vec3 there = Bsdf({kUp, kUp, Vec3(0.4), roughness, true, Vec3(0.3)}, above).value(below) / -below.z;
    const Vec3 back = Bsdf({-kUp, -kUp, Vec3(0.4), roughness, true, Vec3(0.3)}, below).value(above) / above.z;
    EXPECT_NEAR(there.r, back.r, 1e-12);
    EXPECT_GT(there.r, 0);
  }
}

TEST(Bsdf, SamplesOfASheetWeighWhatItSendsOnToBothSides) {
  const Bsdf bsdf = sheet(0.3, 0.5, 0.7, 0.6);
  EXPECT_NEAR(over_sphere([&](const Vec3& in) { return bsdf.pdf(in); }), 1, 0.05);
  double above = 0, below = 0;
  constexpr int kSide = 200;
  for (int i = 0; i < kSide * kSide; ++i) {
    const BsdfSample s = bsdf.sample({(i % kSide + 0.5) / kSide, (i / kSide + 0.5) / kSide});
    if (!(s.pdf > 0)) continue;
    EXPECT_NEAR(s.pdf, bsdf.pdf(s.direction), 1e-9 * s.pdf);
    (s.direction.z > 0 ? above : below) += s.weight.r / (kSide * kSide);
    if (s.direction.z < 0) {
      EXPECT_EQ(s.cosine_share, 0);
    }
  }
  EXPECT_NEAR(above, over_sphere([&](const Vec3& in) { return in.z > 0 ? bsdf.value(in).r : 0; }), 0.01);
  EXPECT_NEAR(below, over_sphere([&](const Vec3& in) { return in.z < 0 ? bsdf.value(in).r : 0; }), 0.01);
}

TEST(Bsdf, SamplesFallAsThePdfSays) {
  // In cells of cosine and azimuth, counts against the integrated density.
  constexpr int kUps = 6, kRound = 8, kSide = 400, kFine = 60;
  for (double roughness : {0.5, 0.9}) {
    const Bsdf bsdf = flat(Vec3(0.1), roughness, 0.9);
    std::vector<double> counted(kUps * kRound), expected(kUps * kRound);
    const auto cell = [](const Vec3& d) {
      const double turns = std::atan2(d.y, d.x) / (2 * kPi);
      return std::min(kUps - 1, int(d.z * kUps)) * kRound + std::min(kRound - 1, int((turns - std::floor(turns)) * kRound));
    };
    for (int i = 0; i < kSide * kSide; ++i) {
      const BsdfSample s = bsdf.sample({(i % kSide + 0.5) / kSide, (i / kSide + 0.5) / kSide});
      if (!(s.pdf > 0)) continue;
      ASSERT_NEAR(s.pdf, bsdf.pdf(s.direction), 1e-12);
      const Vec3 value = bsdf.value(s.direction);
      ASSERT_NEAR(s.weight.r, value.r / s.pdf, 1e-12);
      ASSERT_LT(s.weight.r, 1.6);
      counted[cell(s.direction)] += 1.0 / (kSide * kSide);
    }
    for (int i = 0; i < kUps * kFine; ++i) {
      for (int j = 0; j < kRound * kFine; ++j) {
        const double up = (i + 0.5) / (kUps * kFine), azimuth = 2 * kPi * (j + 0.5) / (kRound * kFine), level = std::sqrt(1 - up * up);
        const Vec3 d(level * std::cos(azimuth), level * std::sin(azimuth), up);
        expected[cell(d)] += bsdf.pdf(d) * 2 * kPi / (double(kUps) * kFine * kRound * kFine);
      }
    }
    for (std::size_t c = 0; c < counted.size(); ++c) EXPECT_NEAR(counted[c], expected[c], 0.003) << roughness << ' ' << c;
  }
}

TEST(Bsdf, TheSharesByCosineHaveTheMeanOne) {
  const Bsdf bsdf = flat(Vec3(0.2), 0.7, 0.8);
  double sum = 0;
  constexpr int kSide = 300;
  for (int i = 0; i < kSide * kSide; ++i) sum += bsdf.sample({(i % kSide + 0.5) / kSide, (i / kSide + 0.5) / kSide}).cosine_share;
  EXPECT_NEAR(sum / (kSide * kSide), 1, 0.005);
}

TEST(Bsdf, NoLightComesThroughFromBehind) {
  const Vec3 leaning = glm::normalize(Vec3(1, 0, 1));
  const Bsdf bsdf({kUp, leaning, Vec3(0.5), 0.8}, kUp);
  EXPECT_EQ(bsdf.value(glm::normalize(Vec3(1, 0, -0.01))), Vec3(0.0));
  EXPECT_EQ(bsdf.value(glm::normalize(Vec3(-1, 0, 0.5))), Vec3(0.0));
}

TEST(Bsdf, AtTheTerminatorALeaningNormalFadesWithoutAStep) {
  const Vec3 leaning = glm::normalize(Vec3(0.7, 0, 1));
  const Bsdf bsdf({kUp, leaning, Vec3(0.5), 0.9}, kUp);
  double before = 0;
  for (double up = 0; up < 0.3; up += 0.002) {
    const double now = bsdf.value(tilted(kPi / 2 - up)).r;
    EXPECT_LT(std::abs(now - before), 0.01) << up;
    before = now;
  }
  EXPECT_GT(before, 0.05);
}

TEST(Bsdf, ANormalThatTurnsAwayFromTheViewerIsBentBack) {
  const Bsdf bsdf({kUp, tilted(1.2), Vec3(0.5), 0.8}, tilted(1.3, kPi));
  EXPECT_GT(glm::dot(bsdf.shading_normal(), tilted(1.3, kPi)), 0);
  const Vec3 value = bsdf.value(kUp);
  EXPECT_TRUE(std::isfinite(value.r) && value.r > 0);
}

TEST(CoatAlbedo, IsFourPercentFromAboveAndMoreAtASlant) {
  EXPECT_NEAR(coat_albedo(1, 0.1), 0.04, 0.003);
  EXPECT_GT(coat_albedo(0.1, 0.1), 0.3);
  for (double alpha : {0.1, 0.5, 1.0}) EXPECT_LT(mean_coat_albedo(alpha), 0.12) << alpha;
}

}  // namespace
}  // namespace cambium
