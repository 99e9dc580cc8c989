#include "raytrace/ray_root.h"

#include "blobtree/place_hash.h"
#include "tests/raytrace/scenes.h"

#include <gtest/gtest.h>

#include <cmath>

namespace cambium {
namespace {

Vec3 random_in(const Box& box, std::uint64_t n) {
  Vec3 out;
  for (int c = 0; c < 3; ++c) out[c] = box.lo[c] + (box.hi[c] - box.lo[c]) * unit_of(hash_of(7, n, c));
  return out;
}

/// Rays through random pairs of points of the field's bounds, against dense sampling.
void expect_like_sampling(const Field& field, double step, int rays) {
  Evaluator evaluator;
  const Box box = field.bounds();
  const PrunedField pruned = field.prune(box);
  int hits = 0;
  for (int i = 0; i < rays; ++i) {
    const Vec3 a = random_in(box, 2 * i), b = random_in(box, 2 * i + 1);
    const Ray ray{a - 3.0 * (b - a), glm::normalize(b - a)};
    const auto segment = clip(ray, box, {0, kInfinity});
    ASSERT_TRUE(segment);
    const double expected = scenes::sampled_root(evaluator, pruned, ray, segment->begin, segment->end, step);
    const auto found = first_root(evaluator, pruned, ray, *segment);
    if (expected == kInfinity) {
      // Sampling may step over a chord that the root finder does not; then the point must at least be inside.
      if (found) {
        EXPECT_GE(evaluator.value(pruned, ray.at(*found)), kIso) << "ray " << i;
      }
    } else {
      ++hits;
      ASSERT_TRUE(found) << "ray " << i;
      EXPECT_NEAR(*found, expected, 2e-6 * pruned.smallest_radius()) << "ray " << i;
    }
  }
  EXPECT_GT(hits, rays / 20);
}

TEST(Clip, GivesThePartInTheBoxAndNothingBeside) {
  const Box box{Vec3(-1), Vec3(1)};
  const auto part = clip({{-3, 0, 0}, {1, 0, 0}}, box, {0, 100});
  ASSERT_TRUE(part);
  EXPECT_DOUBLE_EQ(part->begin, 2);
  EXPECT_DOUBLE_EQ(part->end, 4);
  EXPECT_FALSE(clip({{-3, 1.5, 0}, {1, 0, 0}}, box, {0, 100}));
  EXPECT_FALSE(clip({{-3, 0, 0}, {1, 0, 0}}, box, {0, 1.9}));
  EXPECT_FALSE(clip({{3, 0, 0}, {1, 0, 0}}, box, {0, 100}));
}

TEST(FirstRoot, AgreesWithDenseSamplingOnAChain) { expect_like_sampling(scenes::trunk(), 0.0005, 150); }
TEST(FirstRoot, AgreesWithDenseSamplingOnAFork) { expect_like_sampling(scenes::forked(), 0.0004, 120); }
TEST(FirstRoot, AgreesWithDenseSamplingOnASawnLog) { expect_like_sampling(scenes::sawn(), 0.0004, 120); }
TEST(FirstRoot, AgreesWithDenseSamplingOnAThinTwig) {
  // Across the whole cell of 300 radii: nothing is stepped over.
  const Field field = scenes::thin_twig();
  Evaluator evaluator;
  const PrunedField pruned = field.prune(field.bounds());
  for (int i = 0; i < 200; ++i) {
    const double along = unit_of(hash_of(1, i)), off = 0.00095 * (2 * unit_of(hash_of(2, i)) - 1);
    const Vec3 axis = Vec3(0.15, 0.1, 0.05), on = Vec3(0.1, 0.2, 30.0) + (0.1 + 0.8 * along) * axis;
    const Vec3 across = glm::normalize(glm::cross(axis, random_in({Vec3(-1), Vec3(1)}, i)));
    const Vec3 side = glm::normalize(glm::cross(across, axis));
    const Ray ray{on + off * side - 0.05 * across, across};
    const auto segment = clip(ray, field.bounds(), {0, 1});
    ASSERT_TRUE(segment);
    const auto t = first_root(evaluator, pruned, ray, *segment);
    ASSERT_TRUE(t) << "offset " << off;
    EXPECT_NEAR(*t, 0.05 - std::sqrt(1e-6 - off * off), 5e-9);
  }
}

TEST(FirstRoot, GrazingRaysHitJustInsideTheRadiusAndMissJustOutside) {
  const Field field = scenes::sphere({0, 0, 0}, 1);
  Evaluator evaluator;
  const PrunedField pruned = field.prune(field.bounds());
  for (double miss : {1e-3, 1e-5, 1e-8}) {
    const Ray over{{-1.5, 0, 1 + miss}, {1, 0, 0}};
    EXPECT_FALSE(first_root(evaluator, pruned, over, {0, 3})) << miss;
  }
  for (double depth : {1e-2, 1e-3, 1e-4}) {  // chords of 0.28, 0.09 and 0.028 radii
    const Ray through{{-1.5, 0, 1 - depth}, {1, 0, 0}};
    const auto t = first_root(evaluator, pruned, through, {0, 3});
    ASSERT_TRUE(t) << depth;
    EXPECT_NEAR(*t, 1.5 - std::sqrt(1 - (1 - depth) * (1 - depth)), 2e-6);
  }
}

TEST(FirstRoot, ARayThatStartsInsideHitsWhereItStarts) {
  const Field field = scenes::sphere({0, 0, 0}, 1);
  Evaluator evaluator;
  EXPECT_EQ(first_root(evaluator, field.prune(field.bounds()), {{0, 0, 0}, {0, 0, 1}}, {0.25, 2}), 0.25);
}

TEST(FirstRoot, ShadowRaysFromJustOffAConvexSurfaceLeaveIt) {
  BlobTreeBuilder builder;
  const Field field(builder.build(scenes::add_chain(builder, {{{0, 0, 0}, 0.2}, {{0, 0, 2}, 0.12}})));
  Evaluator evaluator;
  const PrunedField pruned = field.prune(field.bounds());
  for (int i = 0; i < 100; ++i) {
    const Vec3 outside = random_in(field.bounds(), i), axis(0, 0, 0.2 + 1.6 * unit_of(hash_of(3, i)));
    Vec3 towards = axis - outside;
    towards.z = 0;
    const Ray ray{{outside.x - 2 * towards.x, outside.y - 2 * towards.y, axis.z}, glm::normalize(towards)};
    const auto segment = clip(ray, field.bounds(), {0, 10});
    if (!segment) continue;
    const auto t = first_root(evaluator, pruned, ray, *segment);
    if (!t || *t == segment->begin) continue;  // missed, or started inside
    const Sample sample = evaluator.sample(pruned, ray.at(*t));
    const Vec3 normal = -glm::normalize(sample.gradient);
    const Vec3 start = ray.at(*t) + 1e-4 * 0.12 * normal;
    const Ray away{start, glm::normalize(normal + 0.9 * glm::normalize(glm::cross(normal, Vec3(0, 0, 1))))};
    const auto rest = clip(away, field.bounds(), {0, 10});
    ASSERT_TRUE(rest);
    EXPECT_FALSE(first_root(evaluator, pruned, away, *rest)) << i;
  }
}

TEST(FirstRoot, EndsForEverySegmentLengthNearTheShortestStep) {
  // Once: a last stretch between one and one and a half shortest steps was lengthened for ever.
  const Field field = scenes::sphere({0, 0, 0}, 1);
  Evaluator evaluator;
  const PrunedField pruned = field.prune(field.bounds());
  for (int i = 0; i <= 400; ++i) {
    const double length = 0.0002 * i;
    EXPECT_FALSE(first_root(evaluator, pruned, {{-0.5 * length, 0, 1.0001}, {1, 0, 0}}, {0, length}));
  }
}

}  // namespace
}  // namespace cambium
