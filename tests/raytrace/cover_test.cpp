#include "raytrace/cover.h"

#include "raytrace/hash.h"
#include "tests/raytrace/scenes.h"

#include <gtest/gtest.h>
#include <tbb/global_control.h>

namespace cambium {
namespace {

std::vector<PrunedField> covered(const Field& field) { return *cover_for_tracing(field, {}, {}); }

TEST(Cover, CellsAreDisjointAndHoldEverySurfacePoint) {
  const Field field = scenes::forked();
  const auto cells = covered(field);
  ASSERT_GT(cells.size(), 20u);
  for (std::size_t i = 0; i < cells.size(); ++i) {
    for (std::size_t j = i + 1; j < cells.size(); ++j) {
      const Vec3 shared = Box::intersection(cells[i].box(), cells[j].box()).size();
      EXPECT_LE(std::min({shared.x, shared.y, shared.z}), 0) << i << " and " << j;
    }
  }
  // Points of the surface, by bisection between an inside point and random outside points.
  Evaluator evaluator;
  const PrunedField whole = field.prune(field.bounds());
  for (int i = 0; i < 400; ++i) {
    Vec3 inside(0, 0, 0.1 + 0.8 * unit_of(hash_of(1, i)));
    Vec3 outside = inside + 0.5 * glm::normalize(Vec3(unit_of(hash_of(2, i)) - 0.5, unit_of(hash_of(3, i)) - 0.5, 0.01));
    for (int k = 0; k < 60; ++k) {
      const Vec3 middle = 0.5 * (inside + outside);
      (field.value(middle) >= kIso ? inside : outside) = middle;
    }
    bool held = false;
    for (const PrunedField& cell : cells) {
      if (!cell.box().contains(inside)) continue;
      held = true;
      EXPECT_EQ(evaluator.value(cell, inside), evaluator.value(whole, inside));
    }
    EXPECT_TRUE(held) << inside.x << ' ' << inside.y << ' ' << inside.z;
  }
}

TEST(Cover, DoesNotDependOnThreads) {
  const Field field = scenes::forked();
  const auto many = covered(field);
  const tbb::global_control one(tbb::global_control::max_allowed_parallelism, 1);
  const auto single = covered(field);
  ASSERT_EQ(many.size(), single.size());
  for (std::size_t i = 0; i < many.size(); ++i) {
    EXPECT_EQ(many[i].box().lo, single[i].box().lo);
    EXPECT_EQ(many[i].box().hi, single[i].box().hi);
  }
}

TEST(Cover, AStraightThinTwigNeedsFewCells) {
  BlobTreeBuilder builder;
  const Field field(builder.build(scenes::add_chain(builder, {{{0, 0, 0}, 0.001}, {{0.3, 0.2, 0.1}, 0.001}})));
  EXPECT_LT(covered(field).size(), 400u);
  EXPECT_GT(covered(field).size(), 10u);
}

TEST(Cover, StopsAtItsLimitWithLargerCells) {
  TraceCoverOptions options;
  options.max_cells = 40;
  const auto cells = *cover_for_tracing(scenes::forked(), options, {});
  EXPECT_LE(cells.size(), 40u);
  EXPECT_GE(cells.size(), 5u);
}

TEST(Cover, GivesNothingWhenCancelled) {
  const std::atomic<bool> cancel{true};
  RunOptions run;
  run.cancel = &cancel;
  EXPECT_FALSE(cover_for_tracing(scenes::forked(), {}, run));
}

}  // namespace
}  // namespace cambium
