#include "blobtree/choices.h"

#include "conformance_cases.h"
#include "random_blobtrees.h"
#include "strained_blobtrees.h"

#include <gtest/gtest.h>

#include <array>
#include <cmath>
#include <functional>
#include <stdexcept>

namespace cambium {
namespace {

constexpr std::uint32_t kDoesNotMatter = Choices::kDoesNotMatter, kBothInside = Choices::kBothInside;
using Winners = std::vector<std::uint32_t>;

struct Made {
  Field field;
  PrunedField whole;
  explicit Made(const BlobTree& tree) : field(tree), whole(field.whole()) {}
};

/// Spheres of radius 0.2 along x, 0.3 apart, below one operator.
Made row(int count, const std::function<Node(std::vector<NodeId>)>& op) {
  BlobTreeBuilder b;
  std::vector<NodeId> ids;
  for (int i = 0; i < count; ++i) ids.push_back(b.add(Sphere{{0.3 * i, 0, 0}, 0.2, 1}));
  return Made(b.build(b.add(op(ids))));
}

Winners chosen(const PrunedField& field, const Vec3& p) {
  ChoiceEvaluator evaluator;
  Choices choices;
  evaluator.choose(field, p, choices);
  return choices.winners;
}

Made axis_and_two_laterals() {
  BlobTreeBuilder b;
  const NodeId axis = b.add(Cone{{0, 0, -1}, {0, 0, 1}, 0.12, 0.1, 1});
  const NodeId left = b.add(Cone{{-0.08, 0, 0}, {-0.6, 0, 0.5}, 0.08, 0.07, 1});
  const NodeId right = b.add(Cone{{0.08, 0, 0}, {0.6, 0, 0.5}, 0.08, 0.07, 1});
  const Vec3 up = glm::normalize(Vec3(0.5, 0, 0.6));
  return Made(b.build(b.add(Fork{axis, {{left, {0, 0, 0}, {-up.x, 0, up.z}, 0.05, 0.4},
                                        {right, {0, 0, 0}, up, 0.05, 0.4}}, 0.4, 1})));
}

/// Every operator that chooses, over primitives without kinks, some of them below warps and under each other.
Made all_operators() {
  BlobTreeBuilder b;
  const auto ball = [&](double x, double y, double z) { return b.add(Sphere{{x, y, z}, 0.25, 1}); };
  const NodeId united = b.add(Union{{ball(0, 0, 0), ball(0.3, 0, 0), ball(0, 0.3, 0.1)}});
  const NodeId common = b.add(Intersection{{ball(0.1, 0, 0.3), ball(0.3, 0.1, 0.3)}});
  const NodeId cut = b.add(Difference{{ball(0.5, 0.3, 0), ball(0.5, 0.55, 0.1), b.add(HalfSpace{{0, 0, -0.1}, {0, 0.6, 0.8}, 0.5})}});
  const NodeId pair = b.add(Contact{{cut, ball(0.3, 0.4, 0)}, 0.45, 1.5});
  const NodeId three = b.add(Contact{{ball(0, 0.5, 0.2), pair, ball(0.2, 0.6, 0.3)}, 0.5, 3});
  const NodeId bent = b.add(Twist{{0.1, 0, 0}, {0, 0, 1}, 0.7, b.add(Contact{{ball(0.6, 0, 0), ball(0.6, 0.3, 0.1)}, 0.5, 0})});
  const Lateral first{three, {0.2, 0.3, 0.1}, {0, 1, 0}, 0.3, 0.4}, second{bent, {0.4, 0, 0}, {1, 0, 0}, 0.2, 0.3};
  const NodeId fork = b.add(Fork{b.add(Sum{{united, common}}), {first, second}, 0.5, 2});
  return Made(b.build(b.add(Union{{fork, b.add(ScaleField{0.9, ball(0.9, 0.2, 0)})}})));
}

TEST(Choices, OfAUnionAreTheLargestChild) {
  const Made made = row(3, [](auto ids) { return Union{ids}; });
  EXPECT_EQ(chosen(made.whole, {0.01, 0, 0}), Winners{0});
  EXPECT_EQ(chosen(made.whole, {0.31, 0, 0}), Winners{1});
  EXPECT_EQ(chosen(made.whole, {0.7, 0, 0}), Winners{2});
}

TEST(Choices, OfAnIntersectionAreTheSmallestChild) {
  const Made made = row(2, [](auto ids) { return Intersection{ids}; });
  EXPECT_EQ(chosen(made.whole, {0.1, 0, 0}), Winners{1});
  EXPECT_EQ(chosen(made.whole, {0.2, 0, 0}), Winners{0});
}

TEST(Choices, OfADifferenceAreTheFirstOrWhatCutsOrTheCap) {
  BlobTreeBuilder b;
  const NodeId strong = b.add(Sphere{{0, 0, 0}, 0.2, 3}), hole = b.add(Sphere{{0.2, 0, 0}, 0.1, 1});
  const Field field(b.build(b.add(Difference{{strong, hole}})));
  EXPECT_EQ(chosen(field.whole(), {-0.3, 0, 0}), Winners{0});
  EXPECT_EQ(chosen(field.whole(), {0.2, 0, 0}), Winners{1});
  const PrunedField away = field.prune({Vec3(-0.2, -0.02, -0.02), Vec3(-0.1, 0.02, 0.02)});   // from the hole: the cap stays
  EXPECT_EQ(chosen(away, {-0.11, 0, 0}), Winners{1});
  ChoiceEvaluator evaluator;
  EXPECT_EQ(evaluator.sample_as(away, {{1}}, {-0.11, 0, 0}).value, 1);
  EXPECT_GT(evaluator.sample_as(away, {{0}}, {-0.11, 0, 0}).value, 1);
  EXPECT_EQ(evaluator.sample_as(away, {{1}}, {-0.11, 0, 0}).gradient, Vec3(0));
}

TEST(Choices, OfAContactAreItsLeaderAndOfThreeTheOneThatPushes) {
  const Made two = row(2, [](auto ids) { return Contact{ids, 0.5, 0}; });
  EXPECT_EQ(chosen(two.whole, {0, 0.2, 0}), Winners{0});
  EXPECT_EQ(chosen(two.whole, {0.4, 0.2, 0}), Winners{1});
  EXPECT_EQ(chosen(two.whole, {0.151, 0, 0}), Winners{1u | kBothInside});
  const double surface = std::sqrt(0.2 * 0.2 - 0.15 * 0.15);   // where both are at it; a hair inside counts as outside
  EXPECT_EQ(chosen(two.whole, {0.15 - 1e-9, surface - 1e-8, 0}), Winners{0});
  EXPECT_EQ(chosen(two.whole, {0.15 - 1e-9, surface - 1e-5, 0}), Winners{0u | kBothInside});
  const Made three = row(3, [](auto ids) { return Contact{ids, 0.5, 0}; });
  EXPECT_EQ(chosen(three.whole, {0.29, 0.2, 0}), (Winners{1, 0}));
  EXPECT_EQ(chosen(three.whole, {0.31, 0.2, 0}), (Winners{1, 2}));
  EXPECT_EQ(chosen(three.whole, {0.1, 0.2, 0}), (Winners{0, 1}));
}

TEST(Choices, OfAForkAreTheLateralsAndWhetherTheAxisLeads) {
  const Made made = axis_and_two_laterals();
  EXPECT_EQ(chosen(made.whole, {-0.1, 0, 0.2}), (Winners{0, 0}));     // on the axis, towards the left
  EXPECT_EQ(chosen(made.whole, {0.1, 0, 0.2}), (Winners{1, 0}));
  EXPECT_EQ(chosen(made.whole, {0.5, 0, 0.5}), (Winners{1, 1}));
  EXPECT_EQ(chosen(made.whole, {0.03, 0, 0.05}).back(), 0u | kBothInside);
}

TEST(Choices, BelowAChildThatIsNotTakenDoNotMatter) {
  BlobTreeBuilder b;
  const NodeId pair = b.add(Contact{{b.add(Sphere{{0, 0, 0}, 0.2, 1}), b.add(Sphere{{0.3, 0, 0}, 0.2, 1})}, 0.5, 0});
  const NodeId cut = b.add(Difference{{pair, b.add(HalfSpace{{0, 0, 0}, {0, 0, -1}, 0.1})}});
  const Field field(b.build(cut));
  EXPECT_EQ(chosen(field.whole(), {0, 0, -0.2}), (Winners{0, 0}));
  EXPECT_EQ(chosen(field.whole(), {0.4, 0, -0.2}), (Winners{1, 0}));
  EXPECT_EQ(chosen(field.whole(), {0, 0, 0.01}), (Winners{kDoesNotMatter, 1}));
  EXPECT_EQ(chosen(field.whole(), {0.4, 0, 0.01}), (Winners{kDoesNotMatter, 1}));
}

// Bits of the value, and the same gradient: any field, anywhere.
TEST(Choices, OfAPointGiveTheFieldThere) {
  std::size_t checked = 0, choosing = 0;
  const auto look = [&](const BlobTree& tree, std::uint64_t seed) {
    const Field field(tree);
    if (!field.bounds().bounded()) return;
    Evaluator plain;
    ChoiceEvaluator evaluator;
    Draws draws(seed);
    Choices choices;
    for (int n = 0; n < 40; ++n) {
      const Box box = n < 10 ? field.bounds() : draws.box(field.bounds());
      const PrunedField pruned = n < 10 ? field.whole() : field.prune(box);
      for (int k = 0; k < 4; ++k) {
        const Vec3 p = draws.point(box);
        ASSERT_EQ(evaluator.choose(pruned, p, choices), plain.value(pruned, p)) << seed;
        const Sample is = plain.sample(pruned, p), as = evaluator.sample_as(pruned, choices, p);
        const double size = 1 + std::abs(is.value), slope = 1 + glm::length(is.gradient);
        ASSERT_NEAR(as.value, is.value, 1e-13 * size) << seed;
        ASSERT_NEAR(glm::length(as.gradient - is.gradient), 0, 1e-10 * slope) << seed;
        ASSERT_EQ(ChoiceEvaluator::smooth(pruned), choices.winners.empty());
        ++checked;
        choosing += !choices.winners.empty();
      }
    }
  };
  for (std::uint64_t seed = 0; seed < 300; ++seed) {
    SCOPED_TRACE(testing::Message() << "random, seed " << seed);
    ASSERT_NO_FATAL_FAILURE(look(random_blobtree(seed, 1 + static_cast<int>(seed % 5)), seed));
  }
  for (std::uint64_t seed = 0; seed < 56; ++seed) {
    SCOPED_TRACE(testing::Message() << "strained, seed " << seed);
    ASSERT_NO_FATAL_FAILURE(look(strained_blobtree(seed % strains().size(), 900 + seed).tree, seed));
  }
  for (const ConformanceCase& c : conformance_cases()) {
    SCOPED_TRACE(c.name);
    ASSERT_NO_FATAL_FAILURE(look(c.tree, 5));
  }
  EXPECT_GT(checked, 50000u);
  EXPECT_GT(choosing, checked / 4);
}

// Sides reach over the crease: their values are those of a smooth function, which differences show to have the gradient.
TEST(Choices, OfAnotherPointGiveASmoothFieldWithItsGradient) {
  ChoiceEvaluator evaluator;
  Draws draws(3);
  std::size_t across = 0;
  for (const Made& made : {all_operators(), axis_and_two_laterals(), row(3, [](auto ids) { return Contact{ids, 0.3, 4}; })}) {
    const Box box = made.field.bounds().padded(-0.15);
    for (int i = 0; i < 3000; ++i) {
      const Vec3 p = draws.point(box), q = p + 0.15 * draws.direction();
      Choices here, there;
      evaluator.choose(made.whole, p, here);
      evaluator.choose(made.whole, q, there);
      across += here != there;
      const Sample s = evaluator.sample_as(made.whole, there, p);
      const auto f = [&](const Vec3& at) { return evaluator.sample_as(made.whole, there, at).value; };
      for (int a = 0; a < 3; ++a) {
        Vec3 step(0.0);
        step[a] = 1e-5;
        const double forward = (f(p + step) - s.value) / 1e-5, backward = (s.value - f(p - step)) / 1e-5;
        ASSERT_NEAR(0.5 * (forward + backward), s.gradient[a], 2e-3) << i;
        ASSERT_NEAR(forward, backward, 8e-3) << i;   // no kink between: curvature alone
      }
    }
  }
  EXPECT_GT(across, 1500u);
}

TEST(Choices, GoOnOverTheCreaseOfAContactWhereTheFieldTurns) {
  const Made made = row(2, [](auto ids) { return Contact{ids, 0.5, 1.5}; });
  ChoiceEvaluator evaluator;
  Evaluator plain;
  const Vec3 before(0.15 - 1e-7, 0.16, 0), after(0.15 + 1e-7, 0.16, 0);
  EXPECT_GT(glm::length(plain.sample(made.whole, before).gradient - plain.sample(made.whole, after).gradient), 1);
  for (const std::uint32_t leader : {0u, 1u}) {
    const Sample a = evaluator.sample_as(made.whole, {{leader}}, before), b = evaluator.sample_as(made.whole, {{leader}}, after);
    EXPECT_LT(glm::length(a.gradient - b.gradient), 1e-4);
    EXPECT_LT(std::abs(a.value - b.value), 1e-5);
  }
}

TEST(Choices, AreNoneOfSumsChainsAndWarps) {
  BlobTreeBuilder b;
  const NodeId chain = b.add(Chain{{{{0, 0, 0}, 0.1}, {{0, 0, 1}, 0.08}, {{0.3, 0, 2}, 0.06}}, 1});
  const NodeId ball = b.add(Transform{Mat4(1.0), b.add(Sphere{{0, 0, 0}, 0.2, 1})});
  const Field plain(b.build(b.add(Ricci{{b.add(Sum{{chain, ball}}), b.add(Sphere{{0, 1, 0}, 0.2, 1})}, 2})));
  EXPECT_TRUE(ChoiceEvaluator::smooth(plain.whole()));
  EXPECT_TRUE(ChoiceEvaluator::smooth(PrunedField()));
  for (const Made& made : {row(2, [](auto ids) { return Union{ids}; }), row(2, [](auto ids) { return Intersection{ids}; }),
                           row(2, [](auto ids) { return Difference{ids}; }), row(2, [](auto ids) { return Contact{ids, 0.5, 0}; }),
                           axis_and_two_laterals()}) {
    EXPECT_FALSE(ChoiceEvaluator::smooth(made.whole));
  }
  const Made contact = row(2, [](auto ids) { return Contact{ids, 0.5, 0}; });
  EXPECT_TRUE(ChoiceEvaluator::smooth(contact.field.prune({Vec3(-0.4, -0.1, -0.1), Vec3(-0.2, 0.1, 0.1)})));   // of one child alone
}

TEST(Choices, OfAnotherTapeAreRefused) {
  const Made made = row(3, [](auto ids) { return Contact{ids, 0.5, 0}; });
  ChoiceEvaluator evaluator;
  for (const Winners& winners : {Winners{}, Winners{0}, Winners{3, 0}, Winners{0, 3}, Winners{0, 1, 0}}) {
    EXPECT_THROW(evaluator.sample_as(made.whole, {winners}, Vec3(0)), std::invalid_argument);
  }
  const std::array<Choices, 2> sides{Choices{{0, 1}}, Choices{{1}}};
  EXPECT_THROW(ChoiceEvaluator::touching(made.whole, sides), std::invalid_argument);
}

TEST(Choices, TellWhichChildrenMeet) {
  const Made three = row(3, [](auto ids) { return Contact{ids, 0.5, 0}; });
  const std::array<Choices, 2> sides{Choices{{0, 1}}, Choices{{1, 0}}};
  const auto met = ChoiceEvaluator::touching(three.whole, sides);
  using Child = ChoiceEvaluator::Touching::Child;
  EXPECT_EQ(met.children, (std::vector<Child>{{0, 0}, {0, 1}}));
  EXPECT_TRUE(met.apart.empty());
  ChoiceEvaluator evaluator;
  Evaluator plain;
  std::vector<Sample> children;
  const Vec3 p(0.13, 0.14, 0.02);
  EXPECT_EQ(evaluator.sample_children(three.whole, met, p, children), plain.value(three.whole, p));
  ASSERT_EQ(children.size(), 2u);
  for (int i = 0; i < 2; ++i) {
    BlobTreeBuilder b;
    const Field alone(b.build(b.add(Sphere{{0.3 * i, 0, 0}, 0.2, 1})));
    EXPECT_EQ(children[static_cast<std::size_t>(i)].value, alone.value(p));
    EXPECT_EQ(children[static_cast<std::size_t>(i)].gradient, alone.sample(p).gradient);
  }
  const std::array<Choices, 2> same{sides[0], sides[0]};
  EXPECT_TRUE(ChoiceEvaluator::touching(three.whole, same).children.empty());
}

TEST(Choices, GiveTheGradientsOfChildrenInTheWorldThroughWarps) {
  const Sphere one{{0.2, 0, 0.2}, 0.2, 1}, other{{0.2, 0.3, 0.3}, 0.2, 1};
  const auto warped = [](const std::function<NodeId(BlobTreeBuilder&)>& child) {
    BlobTreeBuilder b;
    const NodeId twisted = b.add(Twist{{0, 0, 0}, {0, 0, 1}, 1.3, child(b)});
    return Made(b.build(b.add(Taper{{0, 0, 0}, {1, 0, 0}, -1, 0.8, 1, 1.3, twisted})));
  };
  const Made made = warped([&](BlobTreeBuilder& b) { return b.add(Contact{{b.add(one), b.add(other)}, 0.5, 0}); });
  const std::array<Made, 2> alone{warped([&](BlobTreeBuilder& b) { return b.add(one); }),
                                  warped([&](BlobTreeBuilder& b) { return b.add(other); })};
  const std::array<Choices, 2> sides{Choices{{0}}, Choices{{1}}};
  const auto met = ChoiceEvaluator::touching(made.whole, sides);
  ChoiceEvaluator evaluator;
  Evaluator plain;
  Draws draws(4);
  std::vector<Sample> children;
  for (int i = 0; i < 200; ++i) {
    const Vec3 p = draws.point(made.field.bounds());
    evaluator.sample_children(made.whole, met, p, children);
    ASSERT_EQ(children.size(), 2u);
    for (std::size_t k = 0; k < 2; ++k) {
      const Sample s = plain.sample(alone[k].whole, p);
      EXPECT_EQ(children[k].value, s.value);
      EXPECT_NEAR(glm::length(children[k].gradient - s.gradient), 0, 1e-12);
    }
  }
}

}  // namespace
}  // namespace cambium
