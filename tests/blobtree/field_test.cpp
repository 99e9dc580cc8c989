#include "blobtree/field.h"
#include "conformance_cases.h"
#include "random_blobtrees.h"

#include <gtest/gtest.h>

#include <functional>

namespace cambium {
namespace {

Field field_of(const std::function<NodeId(BlobTreeBuilder&)>& grow) {
  BlobTreeBuilder b;
  const NodeId root = grow(b);
  return Field(b.build(root));
}

TEST(Field, RefusesAHalfSpaceThatNothingBounds) {
  const HalfSpace half{{0, 0, 0}, {0, 0, 1}, 0.1};
  const Sphere ball{{0, 0, 0}, 1, 1};
  EXPECT_THROW(field_of([&](auto& b) { return b.add(half); }), InvalidNode);
  EXPECT_THROW(field_of([&](auto& b) { return b.add(Sum{{b.add(ball), b.add(half)}}); }), InvalidNode);
  EXPECT_THROW(field_of([&](auto& b) { return b.add(Union{{b.add(half), b.add(ball)}}); }), InvalidNode);
  EXPECT_THROW(field_of([&](auto& b) { return b.add(Difference{{b.add(half), b.add(ball)}}); }), InvalidNode);
  EXPECT_THROW(field_of([&](auto& b) { return b.add(Contact{{b.add(ball), b.add(half)}, 0.5, 0}); }), InvalidNode);
  EXPECT_THROW(field_of([&](auto& b) { return b.add(Twist{{0, 0, 0}, {0, 0, 1}, 1, b.add(half)}); }), InvalidNode);
  EXPECT_NO_THROW(field_of([&](auto& b) { return b.add(Intersection{{b.add(half), b.add(ball)}}); }));
  EXPECT_NO_THROW(field_of([&](auto& b) { return b.add(Difference{{b.add(ball), b.add(half)}}); }));
  EXPECT_NO_THROW(field_of([&](auto& b) {
    return b.add(Intersection{{b.add(ball), b.add(Twist{{0, 0, 0}, {0, 0, 1}, 1, b.add(half)})}});
  }));
  // Also where what bounds it may be negative.
  EXPECT_NO_THROW(field_of([&](auto& b) {
    return b.add(Intersection{{b.add(half), b.add(ScaleField{-1, b.add(ball)})}});
  }));
}

TEST(Field, OfNothingVisibleIsZero) {
  const Field field = field_of([](auto& b) { return b.add(Sphere{{1, 2, 3}, 0.5, 0}); });
  EXPECT_EQ(field.value({1, 2, 3}), 0);
  EXPECT_EQ(field.interval({{0, 0, 0}, {2, 3, 4}}).lo, 0);
  EXPECT_EQ(field.interval({{0, 0, 0}, {2, 3, 4}}).hi, 0);
}

// ---- cost: that of what is active, never that of the tree --------------------------------------------------------
Chain zigzag(int segments) {
  Chain chain;
  for (int i = 0; i <= segments; ++i) chain.nodes.push_back({{0.02 * (i % 2), 0.01 * (i % 3), 0.05 * i}, 0.02});
  return chain;
}

// sum(cone, contact(sum(cone, contact(...)), twig)): an axis of `depth` internodes in the galbraith profile.
NodeId galbraith_axis(BlobTreeBuilder& b, int depth) {
  NodeId top = b.add(Cone{{0, 0, 0.05 * depth}, {0, 0, 0.05 * depth + 0.05}, 0.02, 0.02, 1});
  for (int i = depth; i-- > 0;) {
    const Vec3 p(0, 0, 0.05 * i), next(0, 0, 0.05 * (i + 1));
    const NodeId twig = b.add(Cone{next, next + Vec3(0.04, 0, 0.02), 0.008, 0.006, 1});
    top = b.add(Sum{{b.add(Cone{p, next, 0.02, 0.02, 1}), b.add(Contact{{top, twig}, 0.5, 0})}});
  }
  return top;
}

// The same neighbourhood, in the middle of trees of very different length.
void expect_same_cost(const Field& small, double small_middle, const Field& large, double large_middle) {
  const auto around = [](double z) { return Box{{-0.03, -0.03, z - 0.03}, {0.05, 0.03, z + 0.03}}; };
  const PrunedField a = small.prune(around(small_middle)), b = large.prune(around(large_middle));
  EXPECT_GT(a.atom_count(), 1u);
  EXPECT_LE(a.atom_count(), 30u);
  EXPECT_EQ(a.atom_count(), b.atom_count());
  EXPECT_EQ(a.memory_bytes(), b.memory_bytes());  // the tape and what belongs to it
  Evaluator evaluator;
  for (int i = 0; i < 50; ++i) {
    const Vec3 offset(0.001 * (i % 7), 0.001 * (i % 5), 0.001 * (i % 11));
    EXPECT_NEAR(evaluator.value(a, Vec3(0, 0, small_middle) + offset), evaluator.value(b, Vec3(0, 0, large_middle) + offset), 1e-9);
  }
}

TEST(Field, PrunedChainDoesNotGrowWithItsLength) {
  expect_same_cost(field_of([](auto& b) { return b.add(zigzag(120)); }), 0.05 * 60,
                   field_of([](auto& b) { return b.add(zigzag(12000)); }), 0.05 * 6000);
}

TEST(Field, PrunedNestDoesNotGrowWithItsDepth) {
  expect_same_cost(field_of([](auto& b) { return galbraith_axis(b, 100); }), 0.05 * 50,
                   field_of([](auto& b) { return galbraith_axis(b, 10000); }), 0.05 * 5000);
}

TEST(Field, DeepNestsCostNoCallStack) {
  const Field field = field_of([](auto& b) {
    NodeId top = b.add(Sphere{{0, 0, 0}, 1, 1});
    for (int i = 0; i < 200000; ++i) top = i % 2 == 0 ? b.add(Sum{{top}}) : b.add(ScaleField{1, top});
    return top;
  });
  EXPECT_EQ(field.atom_count(), 1u);
  EXPECT_EQ(field.value({0, 0, 0}), 1);
  EXPECT_NEAR(field.value({1, 0, 0}), kIso, 1e-9);
}

TEST(Field, KeepsASegmentInFewBytes) {
  const std::size_t small = field_of([](auto& b) { return b.add(zigzag(2000)); }).memory_bytes();
  const std::size_t large = field_of([](auto& b) { return b.add(zigzag(22000)); }).memory_bytes();
  EXPECT_LT(static_cast<double>(large - small) / 20000, 48.0);   // of which 32 are its node
}

TEST(Field, KnowsTheSmallestRadiusInABox) {
  const Field field = field_of([](auto& b) {
    return b.add(Sum{{b.add(Sphere{{0, 0, 0}, 0.3, 1}), b.add(Sphere{{5, 0, 0}, 0.001, 1})}});
  });
  EXPECT_EQ(field.prune({{-1, -1, -1}, {1, 1, 1}}).smallest_radius(), 0.3);
  EXPECT_EQ(field.prune({{-1, -1, -1}, {6, 1, 1}}).smallest_radius(), 0.001);
}

TEST(Field, OfASolidThatIsCutHasNothingOfTheCutAwayFromIt) {
  for (const bool plane_first : {false, true}) {
    const Field field = field_of([&](auto& b) {
      const NodeId chain = b.add(Chain{{{{0, 0, 0}, 0.1}, {{0, 0, 2}, 0.1}}});
      const NodeId plane = b.add(HalfSpace{{0, 0, 1}, {0.1, 0, 1}, 0.02});
      return b.add(plane_first ? Intersection{{plane, chain}} : Intersection{{chain, plane}});
    });
    EXPECT_EQ(field.prune({{0, 0, 0.2}, {0.1, 0.1, 0.4}}).atom_count(), 1u);
    EXPECT_EQ(field.prune({{0, 0, 0.95}, {0.1, 0.1, 1.1}}).atom_count(), 2u);
    EXPECT_EQ(field.value({0, 0, 0.3}), 1);
    EXPECT_NEAR(field.value({0, 0, 1}), kIso, 1e-15);
    EXPECT_EQ(field.value({0, 0, 1.2}), 0);
  }
}

TEST(PrunedField, NarrowedIsTheFieldOfThePart) {
  Evaluator evaluator;
  for (std::uint64_t seed = 1; seed <= 200; ++seed) {
    const Field field(random_blobtree(seed, 4));
    if (field.bounds().empty()) continue;
    Draws draws(seed);
    const PrunedField whole = field.prune(draws.box(field.bounds()));
    const Box part = draws.box(whole.box());
    const PrunedField narrowed = whole.narrowed(part);
    EXPECT_EQ(narrowed.atom_count(), field.prune(part).atom_count()) << seed;
    for (int i = 0; i < 20; ++i) {
      const Vec3 p = draws.point(part);
      ASSERT_EQ(evaluator.value(narrowed, p), evaluator.value(whole, p)) << seed;
    }
  }
}

}  // namespace
}  // namespace cambium
