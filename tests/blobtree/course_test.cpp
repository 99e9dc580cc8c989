// Bounds along straight ways: values and chords of dense samples are within them, for any nest of nodes; and they close in.
#include "blobtree/course.h"

#include "tests/blobtree/random_blobtrees.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <array>
#include <cmath>

namespace cambium {
namespace {

struct StraightWay {
  Vec3 middle, direction;
  double half = 0;
  Vec3 at(double t) const { return middle + t * direction; }
};

StraightWay way_in(const Box& box, Draws& draws) {
  const Vec3 a = draws.point(box), b = draws.point(box);
  return {0.5 * (a + b), glm::normalize(b - a), 0.5 * glm::distance(a, b)};
}

/// Samples along the way against its bounds. False, with a failure, at the first that is beyond.
bool expect_within(Evaluator& evaluator, const PrunedField& field, const StraightWay& way, std::uint64_t seed) {
  const Course course = evaluator.course(field, way.middle, way.direction, way.half);
  constexpr int kSamples = 24;
  std::array<double, kSamples + 1> t{}, f{};
  for (int i = 0; i <= kSamples; ++i) {
    t[i] = way.half * (2.0 * i / kSamples - 1);
    f[i] = evaluator.value(field, way.at(t[i]));
    EXPECT_GE(f[i], course.value.lo) << "tree " << seed;
    EXPECT_LE(f[i], course.value.hi) << "tree " << seed;
  }
  const double rounding = 1e-13 + 4e-16 * glm::length(way.middle) * std::max(std::abs(course.slope.lo), std::abs(course.slope.hi));
  for (int i = 1; i <= kSamples; ++i) {
    const double step = t[i] - t[i - 1], change = f[i] - f[i - 1];
    EXPECT_GE(change, course.slope.lo * step - rounding) << "tree " << seed << " of " << field.atom_count();
    EXPECT_LE(change, course.slope.hi * step + rounding) << "tree " << seed << " of " << field.atom_count();
  }
  return !testing::Test::HasFailure();
}

TEST(Course, HoldsTheValuesAndChordsOfRandomFields) {
  Evaluator evaluator;
  for (std::uint64_t seed = 1; seed <= 400; ++seed) {
    const Field field(random_blobtree(seed, 4));
    if (field.bounds().empty()) continue;
    Draws draws(seed);
    for (int i = 0; i < 12; ++i) {
      const PrunedField pruned = field.prune(draws.box(field.bounds()));
      const StraightWay way = way_in(pruned.box(), draws);
      StraightWay part = way;
      for (int k = 0; k < 4; ++k, part.half *= 0.2) {
        if (!expect_within(evaluator, pruned, part, seed)) return;
      }
    }
  }
}

TEST(Course, HoldsThoseOfEveryOperatorOverPrimitivesThatTouch) {
  Evaluator evaluator;
  for (int kind = 0; kind < BlobTreeGrower::kOperators; ++kind) {
    for (std::uint64_t seed = 1; seed <= 40; ++seed) {
      BlobTreeGrower grower(seed);
      const NodeId root = grower.op(kind, 1);
      const Field field(grower.finish(root));
      if (field.bounds().empty()) continue;
      Draws draws(seed + 1000);
      for (int i = 0; i < 12; ++i) {
        const PrunedField pruned = field.prune(field.bounds());
        StraightWay way = way_in(pruned.box(), draws);
        way.half *= std::pow(10.0, draws.in(-3, 0));
        if (!expect_within(evaluator, pruned, way, seed)) return;
      }
    }
  }
}

TEST(Course, SlopesCloseInInProportionToTheWay) {
  // A fork: ten times shorter, at least eight times closer, but where a crease is on the way.
  BlobTreeBuilder b;
  const NodeId trunk = b.add(Chain{{{{0, 0, 0}, 0.10}, {{0.02, 0, 1}, 0.08}, {{0, 0.03, 2}, 0.06}}});
  const NodeId limb = b.add(Chain{{{{0, 0, 1}, 0.06}, {{0.6, 0, 1.5}, 0.04}}});
  const Field field(b.build(b.add(Fork{trunk, {{limb, {0, 0, 1}, {0, 0, 1}, 0.04, 0.3}}})));
  const PrunedField pruned = field.prune(field.bounds());
  Evaluator evaluator;
  Draws draws(5);
  int closer = 0;
  for (int i = 0; i < 200; ++i) {
    const StraightWay way{draws.point({{-0.1, -0.1, 0.8}, {0.3, 0.1, 1.3}}), draws.direction(), 1e-5};
    const auto gap = [&](double half) {
      const Interval slope = evaluator.course(pruned, way.middle, way.direction, half).slope;
      return slope.hi - slope.lo;
    };
    closer += gap(1e-6) <= gap(1e-5) / 8 + 1e-6;
  }
  EXPECT_GT(closer, 170);
}

TEST(Course, OfABentBranchTellsThatItFallsOutwards) {
  BlobTreeBuilder b;
  const NodeId straight = b.add(Capsule{{0, 0, 0}, {0, 0, 1}, 0.05, 1});
  const Field field(b.build(b.add(Bend{{0, 0, 0}, {0, 0, 1}, {1, 0, 0}, 1, straight})));
  const PrunedField pruned = field.prune(field.bounds());
  Evaluator evaluator;
  Draws draws(7);
  int on_surface = 0;
  while (on_surface < 200) {
    const Vec3 p = draws.point(field.bounds());
    const Sample s = evaluator.sample(pruned, p);
    if (std::abs(s.value - kIso) > 0.05) continue;
    ++on_surface;
    EXPECT_GT(evaluator.course(pruned, {p, 0.005}, glm::normalize(s.gradient)).slope.lo, 0);
  }
}

TEST(Course, WhereNothingIsLeftThereIsNoSlope) {
  BlobTreeBuilder b;
  const NodeId ball = b.add(Sphere{{0, 0, 0}, 1, 1}), plane = b.add(HalfSpace{{0, 0, 0}, {0, 0, 1}, 0.1});
  const Field field(b.build(b.add(Intersection{{ball, plane}})));
  const Course course = Evaluator().course(field.prune(field.bounds()), {{0.5, 0, 0.5}, 0.1}, {1, 0, 0});
  EXPECT_EQ(course.value.hi, 0);
  EXPECT_EQ(course.slope.lo, 0);
  EXPECT_EQ(course.slope.hi, 0);
}

TEST(Course, OfAForkTakesLittleOfALateralOfWhichThereIsLittle) {
  BlobTreeBuilder b;
  const NodeId trunk = b.add(Chain{{{{0, 0, 0}, 0.10}, {{0, 0, 2}, 0.10}}});
  const NodeId limb = b.add(Chain{{{{0, 0, 1}, 0.06}, {{0.6, 0, 1.5}, 0.04}}});
  const NodeId far = b.add(Chain{{{{0, 0, 1}, 0.06}, {{-0.6, 0, 1.5}, 0.04}}});
  const Field field(b.build(b.add(Fork{trunk, {{limb, {0, 0, 1}, {0, 0, 1}, 0.04, 0.3}, {far, {0, 0, 1}, {0, 0, -1}, 0.04, 0.3}}})));
  const PrunedField pruned = field.prune(field.bounds());
  Evaluator evaluator;
  const Vec3 beside(0.14, 0, 1.06);   // where the limb leaves the trunk, and the other has all but ended
  const Vec3 up = glm::normalize(evaluator.sample(pruned, beside).gradient);
  const Interval slope = evaluator.course(pruned, {beside, 1e-3}, up).slope;
  EXPECT_GT(slope.lo, 0);
  EXPECT_LT(slope.hi - slope.lo, 0.5 * slope.hi);
}

TEST(Course, ThroughABallHoldsTheValuesAndChordsOfAllWaysInThatDirection) {
  Evaluator evaluator;
  for (std::uint64_t seed = 1; seed <= 400; ++seed) {
    const Field field(random_blobtree(seed, 4));
    if (field.bounds().empty()) continue;
    Draws draws(seed);
    for (int i = 0; i < 12; ++i) {
      const PrunedField pruned = field.prune(draws.box(field.bounds()));
      const Box& box = pruned.box();
      const Vec3 size = box.size(), direction = draws.direction();
      const Ball ball{draws.point(box), 0.5 * std::min({size.x, size.y, size.z}) * std::pow(10.0, draws.in(-3, 0))};
      const Course course = evaluator.course(pruned, ball, direction);
      for (int k = 0; k < 24; ++k) {
        const Vec3 p = ball.center + draws.in(0, 1) * ball.radius * draws.direction();
        const double step = draws.in(0.01, 1) * (std::sqrt(std::max(0.0, ball.radius * ball.radius - glm::dot(p - ball.center, p - ball.center) +
                                                                              std::pow(glm::dot(p - ball.center, direction), 2))) -
                                                 glm::dot(p - ball.center, direction));
        const Vec3 q = p + step * direction;
        if (!box.contains(p) || !box.contains(q)) continue;
        const double at_p = evaluator.value(pruned, p), at_q = evaluator.value(pruned, q);
        ASSERT_GE(at_p, course.value.lo) << "tree " << seed;
        ASSERT_LE(at_p, course.value.hi) << "tree " << seed;
        const double rounding = 1e-13 + 4e-16 * glm::length(p) * std::max(std::abs(course.slope.lo), std::abs(course.slope.hi));
        ASSERT_GE(at_q - at_p, course.slope.lo * step - rounding) << "tree " << seed << " of " << pruned.atom_count();
        ASSERT_LE(at_q - at_p, course.slope.hi * step + rounding) << "tree " << seed << " of " << pruned.atom_count();
      }
    }
  }
}

TEST(Course, OfNothingIsNothing) {
  Evaluator evaluator;
  const Course course = evaluator.course({}, {0, 0, 0}, {1, 0, 0}, 1);
  EXPECT_EQ(course.value.hi, 0);
  EXPECT_EQ(course.slope.hi, 0);
}

TEST(ContactPushSlope, HoldsDifferencesOfThePush) {
  const auto push = [](double f, double width, double lip) {
    if (f >= kIso) return kIso - f;
    if (f <= kIso - width) return 0.0;
    const double u = (kIso - f) / width, v = 1 - u;
    return width * (u * v * v + lip * u * u * v * v);
  };
  Draws draws(9);
  for (int i = 0; i < 2000; ++i) {
    const double width = draws.in(0.05, 0.5), lip = draws.chance(0.3) ? 0 : draws.in(0, 4), a = draws.in(-0.2, 0.8), b = a + draws.in(0, 0.5);
    const Interval slope = contact_push_slope({a, b}, width, lip);
    for (int k = 0; k < 20; ++k) {
      const double step = (b - a) / 20, from = a + k * step, change = push(from + step, width, lip) - push(from, width, lip);
      EXPECT_GE(change, slope.lo * step - 1e-15);
      EXPECT_LE(change, slope.hi * step + 1e-15);
    }
  }
}

}  // namespace
}  // namespace cambium
