#include "raytrace/tracer.h"

#include "blobtree/place_hash.h"
#include "tests/raytrace/scenes.h"

#include <gtest/gtest.h>

#include <numbers>

namespace cambium {
namespace {

Ray random_ray(const Box& box, double distance, int i) {
  const auto in_box = [&](int k) {
    Vec3 out;
    for (int c = 0; c < 3; ++c) out[c] = box.lo[c] + (box.hi[c] - box.lo[c]) * unit_of(hash_of(k, i, c));
    return out;
  };
  const double z = 2 * unit_of(hash_of(9, i)) - 1, angle = 2 * std::numbers::pi * unit_of(hash_of(10, i));
  const Vec3 from = box.center() + distance * Vec3(std::sqrt(1 - z * z) * std::cos(angle), std::sqrt(1 - z * z) * std::sin(angle), z);
  return {from, glm::normalize(in_box(1) - from)};
}

TEST(Tracer, FindsWhatDenseSamplingOfTheWholeFieldFinds) {
  const Field field = scenes::forked();
  const Tracer tracer(*cover_surface(field, {}, {}));
  const PrunedField whole = field.prune(field.bounds());
  Evaluator evaluator;
  int hits = 0;
  for (int i = 0; i < 150; ++i) {
    const Ray ray = random_ray(field.bounds(), 5, i);
    const auto part = clip(ray, field.bounds(), {0, kInfinity});
    ASSERT_TRUE(part);
    const double expected = scenes::sampled_root(evaluator, whole, ray, part->begin, part->end, 0.0005);
    const auto hit = tracer.intersect(evaluator, ray);
    EXPECT_EQ(tracer.occluded(evaluator, ray), hit.has_value());
    if (expected == kInfinity) {
      EXPECT_FALSE(hit) << i;
      continue;
    }
    ++hits;
    ASSERT_TRUE(hit) << i;
    EXPECT_NEAR(hit->t, expected, 1e-6);
    EXPECT_TRUE(tracer.occluded(evaluator, ray, expected + 0.01));
    EXPECT_FALSE(tracer.occluded(evaluator, ray, expected - 0.01));
  }
  EXPECT_GT(hits, 20);
}

TEST(Tracer, SeesAOneMillimetreTwigThirtyMetresAwayWithoutHoles) {
  const Field field = scenes::thin_twig();
  const Tracer tracer(*cover_surface(field, {}, {}));
  Evaluator evaluator;
  const Vec3 eye(0, -25, 1.7), from(0.1, 0.2, 30.0), to(0.25, 0.3, 30.05);
  for (int i = 0; i <= 2000; ++i) {
    const Vec3 on = glm::mix(from, to, i / 2000.0);
    const auto hit = tracer.intersect(evaluator, {eye, glm::normalize(on - eye)});
    ASSERT_TRUE(hit) << i;
    EXPECT_NEAR(hit->t, glm::length(on - eye), 0.003);
  }
}

TEST(Tracer, HasNoHolesBetweenCells) {
  // Every ray towards the axis hits, wherever cells meet.
  const Field field = scenes::trunk();
  const Tracer tracer(*cover_surface(field, {}, {}));
  Evaluator evaluator;
  for (int i = 0; i < 4000; ++i) {
    const double angle = 2 * std::numbers::pi * unit_of(hash_of(1, i));
    const Vec3 on(0.02, 0.02, 0.1 + 1.7 * i / 4000.0), eye(4 * std::cos(angle), 4 * std::sin(angle), on.z);
    EXPECT_TRUE(tracer.intersect(evaluator, {eye, glm::normalize(on - eye)})) << i;
  }
}

TEST(Tracer, OfNothingIsNeverHit) {
  const Tracer tracer({});
  Evaluator evaluator;
  EXPECT_FALSE(tracer.intersect(evaluator, {{0, 0, 0}, {0, 0, 1}}));
  EXPECT_FALSE(tracer.occluded(evaluator, {{0, 0, 0}, {0, 0, 1}}));
}

}  // namespace
}  // namespace cambium
