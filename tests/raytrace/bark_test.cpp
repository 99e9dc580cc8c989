#include "raytrace/bark.h"

#include "blobtree/place_hash.h"
#include "raytrace/texture_image.h"
#include "raytrace/tone.h"
#include "tests/raytrace/scenes.h"

#include <gtest/gtest.h>

#include <cmath>
#include <numbers>

namespace cambium {
namespace {

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
  BarkMaterial red{.style = BarkStyle::kSmooth, .color = {0.5, 0, 0}, .crack_color = {0.5, 0, 0}}, blue = red;
  blue.color = blue.crack_color = {0, 0, 0.5};
  const Bark bark({red, blue});
  BlobTreeBuilder builder;
  const NodeId a = scenes::add_chain(builder, {{{-0.5, 0, 0}, 0.1}, {{-0.12, 0, 0}, 0.1}}, 0, 0);
  const NodeId b = scenes::add_chain(builder, {{{0.5, 0, 0}, 0.1}, {{0.12, 0, 0}, 0.1}}, 1, 1);
  const Field field(builder.build(builder.add(Sum{{a, b}})));
  const Vec3 middle = color_at(bark, field, {0, 0, 0.05});
  EXPECT_NEAR(middle.x / middle.z, 1, 0.03);   // but for how warm either is
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
    EXPECT_GT(glm::dot(bumped, normal), 0.55);
    largest = std::max(largest, 1 - glm::dot(bumped, normal));
  }
  EXPECT_GT(largest, 1e-2);
}

/// Points on the surface of a field, by walking to it from random directions about a centre.
std::vector<Vec3> surface_points(const Field& field, const Vec3& center, double reach, int count) {
  Evaluator evaluator;
  const PrunedField whole = field.prune(field.bounds());
  std::vector<Vec3> points;
  for (std::uint64_t i = 0; points.size() < static_cast<std::size_t>(count) && i < 100000; ++i) {
    const Vec3 d(unit_of(hash_of(1, i)) - 0.5, unit_of(hash_of(2, i)) - 0.5, unit_of(hash_of(3, i)) - 0.5);
    struct {
      Vec3 origin, direction;
      Vec3 at(double t) const { return origin + t * direction; }
    } ray{center + reach * glm::normalize(d), -glm::normalize(d)};
    const double t = scenes::sampled_root(evaluator, whole, ray, 0, reach, 0.003);
    if (t < reach) points.push_back(ray.at(t));
  }
  return points;
}

// Over a fork too, where two barks blend: the gradient of the blend, not the blend of gradients.
TEST(Bark, TheShadingNormalIsThatOfTheReliefByDifferences) {
  int blended = 0;
  for (const Field& field : {scenes::trunk(), scenes::forked()}) {
    const PrunedField pruned = field.prune(field.bounds());
    BarkMaterial ridged{.style = BarkStyle::kRidged, .mature_radius = 0}, plated = ridged;
    plated.style = BarkStyle::kPlated;
    const Bark bark({ridged, plated});
    Evaluator evaluator;
    int off = 0;
    const auto points = surface_points(field, {0.02, 0, 0.5}, 0.4, 500);
    ASSERT_EQ(points.size(), 500u);
    for (const Vec3& p : points) {
      if (evaluator.surface_traits(pruned, p).ridge > 0.25) continue;   // there folds are added
      std::vector<Contribution> contributions;
      evaluator.contributions(pruned, p, contributions);
      blended += contributions.size() > 1;
      const Vec3 n = -glm::normalize(evaluator.sample(pruned, p).gradient);
      const double step = 1e-6;
      Vec3 gradient(0.0);
      for (int a = 0; a < 3; ++a) {
        Vec3 d(0.0);
        d[a] = step;
        gradient[a] = (bark.glance(evaluator, pruned, p + d, 1e-4).relief - bark.glance(evaluator, pruned, p - d, 1e-4).relief) / (2 * step);
      }
      gradient -= glm::dot(gradient, n) * n;
      if (glm::length(gradient) > 1.3) continue;   // held back
      off += glm::length(bark.look(evaluator, pruned, p, n, 1e-4).normal - glm::normalize(n - gradient)) > 0.03;
    }
    EXPECT_LT(off, 15);   // at the edges of scales, where relief steps
  }
  EXPECT_GT(blended, 50);
}

TEST(Bark, AGlanceIsALookWithoutItsNormal) {
  const Field field = scenes::forked();
  const PrunedField pruned = field.prune(field.bounds());
  const Bark bark({});
  Evaluator evaluator;
  for (const Vec3& p : surface_points(field, {0.02, 0, 0.5}, 0.4, 200)) {
    const BarkLook look = bark.look(evaluator, pruned, p, {0, 0, 1}, 5e-4), glance = bark.glance(evaluator, pruned, p, 5e-4);
    EXPECT_NEAR(glm::length(look.albedo - glance.albedo), 0, 1e-9);
    EXPECT_NEAR(look.relief, glance.relief, 1e-12);
    EXPECT_NEAR(look.roughness, glance.roughness, 1e-12);
    EXPECT_EQ(glance.normal, Vec3(0.0));
    EXPECT_GE(look.roughness, 0.05);
    EXPECT_LE(look.roughness, 1);
  }
}

TEST(Bark, FromAfarItHasTheMeanColourOfNearby) {
  const Field field = scenes::trunk();
  const PrunedField pruned = field.prune(field.bounds());
  const Bark bark({});
  Evaluator evaluator;
  Vec3 near(0.0), far(0.0);
  int count = 0;
  for (int i = 0; i < 120; ++i) {
    for (int j = 0; j < 120; ++j, ++count) {
      const double turn = 2 * std::numbers::pi * (i + 0.5) / 120, z = 0.1 + 0.8 * (j + 0.5) / 120;
      const Vec3 p = Vec3(0.05 * z, 0, z) + (0.2 - 0.04 * z) * Vec3(std::cos(turn), std::sin(turn), 0);
      near += bark.glance(evaluator, pruned, p, 0).albedo;
      far += bark.glance(evaluator, pruned, p, 1).albedo;
    }
  }
  for (int c = 0; c < 3; ++c) EXPECT_NEAR(near[c] / far[c], 1, 0.06);
}

/// A material of one texel of colour and one of normals.
BarkMaterial tilted_material(TextureUse convention, const Vec3& n) {
  BarkMaterial material;
  const glm::vec3 texel(0.5 * n + 0.5);
  material.texture = std::make_shared<const TextureImage>(Pixels{1, 1, 3, {0.4f, 0.5f, 0.6f}, false});
  material.normal_map = std::make_shared<const TextureImage>(Pixels{1, 1, 3, {texel.x, texel.y, texel.z}, true}, convention);
  material.roughness_map = std::make_shared<const TextureImage>(Pixels{1, 1, 1, {0.3f}, true}, TextureUse::kRoughness);
  return material;
}

TEST(Bark, ANormalMapLeansAsItsConventionSays) {
  BlobTreeBuilder builder;
  const Field field(builder.build(scenes::add_chain(builder, {{{0, 0, 0}, 0.1}, {{0, 0, 1}, 0.1}})));
  const PrunedField pruned = field.prune(field.bounds());
  const Vec3 p(0.1, 0, 0.5), n(1, 0, 0), lean = glm::normalize(Vec3(0.3, 0.4, 1));
  Evaluator evaluator;
  std::vector<Contribution> contributions;
  evaluator.contributions(pruned, p, contributions);
  const Vec3 right = glm::normalize(contributions.at(0).u_gradient), up = glm::normalize(contributions.at(0).v_gradient);
  EXPECT_NEAR(glm::length(glm::cross(right, up) - n), 0, 1e-9);   // seen from outside, u grows to the right where v grows up
  const auto seen = [&](TextureUse convention) { return Bark({tilted_material(convention, lean)}).look(evaluator, pruned, p, n); };
  const BarkLook opengl = seen(TextureUse::kNormalOpenGl), directx = seen(TextureUse::kNormalDirectX);
  EXPECT_NEAR(glm::length(opengl.normal - (lean.x * right + lean.y * up + lean.z * n)), 0, 1e-5);
  EXPECT_NEAR(glm::length(directx.normal - (lean.x * right - lean.y * up + lean.z * n)), 0, 1e-5);
  EXPECT_NEAR(glm::length(opengl.albedo - Vec3(0.4, 0.5, 0.6)), 0, 1e-6);
  EXPECT_NEAR(opengl.roughness, 0.3, 1e-6);
}

TEST(Bark, AThinStemHasItsYoungColour) {
  BarkMaterial material{.style = BarkStyle::kRidged, .color = {0.4, 0, 0}, .crack_color = {0.1, 0, 0}, .mature_radius = 0.06,
                        .young_color = Vec3(0, 0.4, 0)};
  const Bark bark({material});
  for (const double radius : {0.01, 0.1}) {
    BlobTreeBuilder builder;
    const Field field(builder.build(scenes::add_chain(builder, {{{0, 0, 0}, radius}, {{0, 0, 1}, radius}})));
    const Vec3 color = color_at(bark, field, {radius, 0, 0.5});
    EXPECT_EQ(color.x > color.y, radius > 0.05);
  }
}

}  // namespace
}  // namespace cambium
