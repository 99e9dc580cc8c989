#include "raytrace/bark.h"

#include "raytrace/bark_pattern.h"
#include "raytrace/hash.h"
#include "raytrace/texture_image.h"
#include "raytrace/tone.h"
#include "tests/raytrace/scenes.h"

#include <gtest/gtest.h>

#include <cmath>

namespace cambium {
namespace {

const BarkStyle kStyles[] = {BarkStyle::kRidged, BarkStyle::kPlated, BarkStyle::kSmooth, BarkStyle::kBirch};

TEST(BarkPattern, HasNoSeamAtUZero) {
  for (BarkStyle style : kStyles) {
    for (double scale : {0.7, 1.0, 1.3}) {
      for (int i = 0; i < 200; ++i) {
        const double v = 0.013 * i;
        const BarkTexel a = bark_pattern(style, scale, 1e-9, v, 0.1, 3, 0), b = bark_pattern(style, scale, 1 - 1e-9, v, 0.1, 3, 0);
        EXPECT_NEAR(a.height, b.height, 1e-4);
        EXPECT_NEAR(a.shade, b.shade, 1e-4);
        EXPECT_NEAR(a.mark, b.mark, 1e-4);
      }
    }
  }
}

TEST(BarkPattern, IsContinuousInTheRadiusOfATaperingBranch) {
  for (BarkStyle style : kStyles) {
    for (int i = 0; i < 2000; ++i) {
      const double radius = 0.02 * std::exp2(2.0 * i / 2000);
      const BarkTexel a = bark_pattern(style, 1, 0.37, 1.7, radius, 3, 0);
      const BarkTexel b = bark_pattern(style, 1, 0.37, 1.7, radius * (1 + 1e-6), 3, 0);
      EXPECT_NEAR(a.height, b.height, 1e-3) << radius;
    }
  }
}

TEST(BarkPattern, HasHeightsInRangeAndDiffersBetweenStyles) {
  double spread[4] = {};
  for (int k = 0; k < 4; ++k) {
    double lo = 1, hi = 0;
    for (int i = 0; i < 3000; ++i) {
      const double u = unit_of(hash_of(1, i)), v = 3 * unit_of(hash_of(2, i));
      const BarkTexel texel = bark_pattern(kStyles[k], 1, u, v, 0.15, 3, 0);
      lo = std::min(lo, texel.height);
      hi = std::max(hi, texel.height);
    }
    EXPECT_GE(lo, 0);
    EXPECT_LE(hi, 1);
    spread[k] = hi - lo;
  }
  EXPECT_GT(spread[0], 0.8);  // fissures
  EXPECT_LT(spread[2], 0.5);  // smooth
}

TEST(BarkPattern, FadesWhereAPixelCoversManyPlates) {
  for (BarkStyle style : kStyles) {
    const BarkTexel first = bark_pattern(style, 1, 0.1, 0.2, 0.1, 3, 10);
    for (int i = 0; i < 50; ++i) {
      EXPECT_NEAR(bark_pattern(style, 1, 0.02 * i, 0.1 * i, 0.1, 3, 10).height, first.height, 0.05);
    }
  }
}

Vec3 color_at(const Bark& bark, const Field& field, const Vec3& p) {
  Evaluator evaluator;
  return bark.glance(evaluator, field.prune(field.bounds()), p, 10.0).albedo;  // far away: the mean colour
}

TEST(Bark, OrdersAreVisiblyDifferentAndTheLastGoesOn) {
  const Bark bark({});
  std::vector<Vec3> colors;
  for (std::uint32_t order : {0u, 1u, 2u, 7u}) {
    BlobTreeBuilder builder;
    const Field field(builder.build(scenes::add_chain(builder, {{{0, 0, 0}, 0.1}, {{0, 0, 1}, 0.1}}, 0, order)));
    colors.push_back(color_at(bark, field, {0.1, 0, 0.5}));
  }
  EXPECT_GT(glm::length(colors[0] - colors[1]), 0.05);
  EXPECT_GT(glm::length(colors[1] - colors[2]), 0.05);
  EXPECT_LT(glm::length(colors[2] - colors[3]), 1e-12);
}

TEST(Bark, BlendsByFieldValueAcrossAJunction) {
  BarkMaterial red{BarkStyle::kSmooth, {0.5, 0, 0}, {0.5, 0, 0}, 1, nullptr, 0.3}, blue = red;
  blue.color = blue.crack_color = {0, 0, 0.5};
  const Bark bark({red, blue});
  BlobTreeBuilder builder;
  const NodeId a = scenes::add_chain(builder, {{{-0.5, 0, 0}, 0.1}, {{-0.12, 0, 0}, 0.1}}, 0, 0);
  const NodeId b = scenes::add_chain(builder, {{{0.5, 0, 0}, 0.1}, {{0.12, 0, 0}, 0.1}}, 1, 1);
  const Field field(builder.build(builder.add(Sum{{a, b}})));
  const Vec3 middle = color_at(bark, field, {0, 0, 0.05});
  EXPECT_NEAR(middle.x, middle.z, 1e-9);
  EXPECT_GT(middle.x, 0.1);
  EXPECT_GT(color_at(bark, field, {-0.4, 0, 0.1}).x, 0.3);
  EXPECT_NEAR(color_at(bark, field, {-0.4, 0, 0.1}).z, 0, 1e-12);
}

TEST(Bark, LooksTheSameFromWhatIsKnownOfAPoint) {
  const Bark bark({});
  BlobTreeBuilder builder;
  const NodeId a = scenes::add_chain(builder, {{{-0.5, 0, 0}, 0.1}, {{-0.05, 0, 0}, 0.1}}, 0, 0);
  const NodeId b = scenes::add_chain(builder, {{{0.5, 0, 0}, 0.1}, {{0.05, 0, 0}, 0.1}}, 1, 1);
  const Field field(builder.build(builder.add(Contact{{a, b}})));
  const PrunedField whole = field.prune(field.bounds());
  Evaluator evaluator;
  for (const double x : {-0.4, -0.03, 0.0, 0.2}) {
    const Vec3 p(x, 0.02, 0.1);
    std::vector<Contribution> contributions;
    evaluator.contributions(whole, p, contributions);
    const BarkLook known = bark.glance(contributions, evaluator.surface_traits(whole, p));
    const BarkLook seen = bark.look(evaluator, whole, p, {0, 0, 1});
    EXPECT_EQ(known.albedo, seen.albedo);
    EXPECT_EQ(known.roughness, seen.roughness);
    EXPECT_EQ(known.branch, seen.branch);
  }
}

TEST(Bark, ACutFaceShowsWood) {
  const Field field = scenes::sawn();
  const Bark bark({});
  const Vec3 face = color_at(bark, field, {0.05, 0, 0.5}), side = color_at(bark, field, {0.1, 0, 0.2});
  EXPECT_GT(luminance(face), luminance(side) * 1.3);
}

TEST(Bark, TheShadingNormalIsUnitAndTiltsOnlyModestly) {
  const Field field = scenes::trunk();
  const PrunedField pruned = field.prune(field.bounds());
  const Bark bark({});
  Evaluator evaluator;
  double largest = 0;
  for (int i = 0; i < 300; ++i) {
    const Vec3 normal = glm::normalize(Vec3(std::cos(0.1 * i), std::sin(0.1 * i), 0));
    const Vec3 p = Vec3(0.03, 0, 0.3 + 0.004 * i) + 0.17 * normal;
    const Vec3 bumped = bark.look(evaluator, pruned, p, normal, 1e-4).normal;
    EXPECT_NEAR(glm::length(bumped), 1, 1e-9);
    EXPECT_GT(glm::dot(bumped, normal), 0.6);
    largest = std::max(largest, 1 - glm::dot(bumped, normal));
  }
  EXPECT_GT(largest, 1e-3);
}

TEST(TextureImage, IsBilinearPeriodicAndAveragesUnderALargeFootprint) {
  Pixels pixels{2, 2, 3, {1, 0, 0, 0, 1, 0, 0, 0, 1, 1, 1, 1}, false};
  const TextureImage image(pixels);
  EXPECT_NEAR(image.lookup(0.25, 0.75, 0).x, 1, 1e-6);  // top left
  EXPECT_NEAR(image.lookup(0.75, 0.75, 0).y, 1, 1e-6);
  EXPECT_NEAR(image.lookup(0.5, 0.75, 0).x, 0.5, 1e-6);
  EXPECT_NEAR(glm::length(image.lookup(3.1, -2.3, 0) - image.lookup(0.1, 0.7, 0)), 0, 1e-6);
  EXPECT_NEAR(glm::length(image.lookup(0.3, 0.1, 8) - Vec3(0.5)), 0, 1e-6);
}

TEST(TextureImage, TurnsSrgbIntoLinearLight) {
  const TextureImage image(Pixels{1, 1, 3, {0.5f, 0.5f, 0.5f}, true});
  EXPECT_NEAR(image.lookup(0, 0, 0).x, 0.2140, 1e-3);
}

}  // namespace
}  // namespace cambium
