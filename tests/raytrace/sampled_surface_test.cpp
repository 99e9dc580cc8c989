#include "tests/raytrace/sampled_surface.h"

#include "tests/blobtree/random_blobtrees.h"
#include "tests/raytrace/scenes.h"

#include <gtest/gtest.h>

namespace cambium {
namespace {

Ray towards(const Box& box, Draws& draws) {
  const Vec3 from = box.center() + 1.5 * glm::length(box.size()) * draws.direction();
  return {from, glm::normalize(draws.point(box) - from)};
}

TEST(SampledSurface, AnswersAsAllItsLeavesTriedOneByOne) {
  Evaluator evaluator;
  int hits = 0;
  for (std::uint64_t seed = 1; seed <= 8; ++seed) {
    const Field field(random_blobtree(seed, 3));
    const SampledSurface surface(field);
    Draws draws(seed);
    for (int i = 0; i < 25; ++i) {
      const Ray ray = towards(field.bounds(), draws);
      const auto t = surface.first_reaching(evaluator, ray, kIso);
      hits += t.has_value();
      EXPECT_EQ(t, surface.first_reaching_in_any(evaluator, ray, kIso)) << "tree " << seed << ", ray " << i;
    }
  }
  EXPECT_GT(hits, 20);
}

TEST(SampledSurface, FindsABallWhereItIs) {
  const SampledSurface ball(scenes::sphere({0, 0, 0}, 1));
  Evaluator evaluator;
  for (const double off : {0.0, 0.5, 0.999, 1 - 1e-7}) {
    const auto t = ball.first_reaching(evaluator, {{-3, 0, off}, {1, 0, 0}}, kIso);
    ASSERT_TRUE(t) << off;
    EXPECT_NEAR(*t, 3 - std::sqrt(1 - off * off), 1e-11) << off;
  }
  EXPECT_FALSE(ball.first_reaching(evaluator, {{-3, 0, 1 + 1e-9}, {1, 0, 0}}, kIso));
  EXPECT_EQ(ball.first_reaching(evaluator, {{0, 0.1, 0}, {1, 0, 0}}, kIso), 0);
}

TEST(SampledSurface, LooksNoFartherThanTold) {
  const SampledSurface ball(scenes::sphere({0, 0, 0}, 1));
  Evaluator evaluator;
  const Ray ray{{-3, 0, 0}, {1, 0, 0}};
  EXPECT_TRUE(ball.first_reaching(evaluator, ray, kIso, 2.001));
  EXPECT_FALSE(ball.first_reaching(evaluator, ray, kIso, 1.999));
}

}  // namespace
}  // namespace cambium
