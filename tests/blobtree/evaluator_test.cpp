#include "blobtree/field.h"

#include <gtest/gtest.h>

#include <cmath>
#include <numbers>

namespace cambium {
namespace {

const Vec3 kX(1, 0, 0), kZ(0, 0, 1), kO(0.0);

std::vector<Contribution> contributions(const Field& field, const Vec3& p) {
  Evaluator evaluator;
  std::vector<Contribution> out(3);  // must be cleared
  evaluator.contributions(field.prune(Box{p, p}.padded(1e-3)), p, out);
  return out;
}

double turn_between(double a, double b) { return std::abs(std::remainder(a - b, 1.0)); }

TEST(Contributions, CarryWhatTheNodeWasGiven) {
  BlobTreeBuilder b;
  const NodeId given = b.add(Capsule{kO, 2.0 * kZ, 0.1, 0.8}), plain = b.add(Sphere{{0, 0, 1}, 0.2, 1});
  b.set_attributes(given, {7, 2, 10, kX});
  const Field field(b.build(b.add(Sum{{given, plain}})));
  for (int i = 0; i < 8; ++i) {
    const double turn = (i + 0.25) / 8, a = 2 * std::numbers::pi * turn;
    const auto c = contributions(field, {0.1 * std::cos(a), 0.1 * std::sin(a), 0.5});
    ASSERT_EQ(c.size(), 1u);
    EXPECT_NEAR(c[0].weight, 0.4, 1e-9);
    EXPECT_NEAR(c[0].u, turn, 1e-9);
    EXPECT_NEAR(c[0].v, 10.5, 1e-9);
    EXPECT_NEAR(c[0].radius, 0.1, 1e-12);
    EXPECT_EQ(c[0].branch, 7u);
    EXPECT_EQ(c[0].order, 2u);
  }
  const auto both = contributions(field, {0.1, 0, 1});
  ASSERT_EQ(both.size(), 2u);
  EXPECT_EQ(both[1].branch, 0u);
  EXPECT_EQ(both[1].order, 0u);
  EXPECT_NEAR(both[0].weight + both[1].weight, field.value({0.1, 0, 1}), 1e-12);
}

TEST(Contributions, LeaveOutWhatIsSubtractedOrNegative) {
  BlobTreeBuilder b;
  const NodeId body = b.add(Sphere{kO, 0.3, 1}), taken = b.add(Sphere{{0.3, 0, 0}, 0.2, 1}), dent = b.add(Sphere{{0, 0, 0.3}, 0.2, -0.5});
  b.set_attributes(body, {5, 1, 0, kX});
  const Field field(b.build(b.add(Sum{{b.add(Difference{{body, taken}}), dent}})));
  for (const Vec3& p : {Vec3(0.15, 0, 0), Vec3(0, 0, 0.2)}) {
    const auto c = contributions(field, p);
    ASSERT_EQ(c.size(), 1u);
    EXPECT_EQ(c[0].branch, 5u);
  }
  EXPECT_TRUE(contributions(field, {5, 5, 5}).empty());
}

// Along a curved chain u and v are continuous: u is carried without turning, v is the length from the first node.
TEST(Contributions, OfAChainAreContinuousAlongIt) {
  Chain chain;
  for (int i = 0; i <= 200; ++i)
    chain.nodes.push_back({{std::cos(0.02 * i), std::sin(0.02 * i), 0.3 * std::sin(0.03 * i)}, 0.1 - 0.0002 * i});
  BlobTreeBuilder b;
  const NodeId id = b.add(chain);
  b.set_attributes(id, {1, 0, 2, kZ});
  const Field field(b.build(id));
  double length = 2, last_u = -1, last_v = 0;
  for (std::size_t i = 0; i + 1 < chain.nodes.size(); ++i) {
    const Vec3 a = chain.nodes[i].position, d = chain.nodes[i + 1].position - a;
    for (const double t : {0.25, 0.75}) {
      const Vec3 across = glm::normalize(kZ - glm::dot(kZ, d) / glm::dot(d, d) * d);
      const auto c = contributions(field, a + t * d + 0.05 * across);
      ASSERT_EQ(c.size(), 1u);
      EXPECT_NEAR(c[0].v, length + t * glm::length(d), 0.2 * glm::length(d));
      EXPECT_NEAR(c[0].radius, 0.1 - 0.0002 * (static_cast<double>(i) + t), 1e-4);
      if (last_u >= 0) {
        ASSERT_LT(turn_between(c[0].u, last_u), 0.01);
        ASSERT_LT(std::abs(c[0].v - last_v), 1.2 * glm::length(d));
      }
      last_u = c[0].u, last_v = c[0].v;
    }
    length += glm::length(d);
  }
}

TEST(SurfaceTraits, TellCutsRidgesAndDentsApart) {
  BlobTreeBuilder b;
  const NodeId left = b.add(Capsule{{-0.09, 0, -1}, {-0.09, 0, 1}, 0.1, 1}), right = b.add(Capsule{{0.09, 0, -1}, {0.09, 0, 1}, 0.1, 1});
  const NodeId pair = b.add(Contact{{left, right}, 0.5, 0});
  const NodeId cut = b.add(Intersection{{pair, b.add(HalfSpace{{0, 0, 0.9}, kZ, 0.002})}});
  const NodeId root = b.add(Sum{{cut, b.add(Sphere{{0.12, -0.1, -0.5}, 0.05, -0.6})}});
  const Field field(b.build(root));
  Evaluator evaluator;
  const PrunedField whole = field.prune(field.bounds());
  // First surface point from outside along a line.
  const auto traits = [&](const Vec3& from, const Vec3& to) {
    double t = 0;
    while (t < 1 && evaluator.value(whole, glm::mix(from, to, t)) < kIso) t += 1e-4;
    EXPECT_LT(t, 1);
    return evaluator.surface_traits(whole, glm::mix(from, to, t));
  };
  const SurfaceTraits plain = traits({0.5, 0, 0}, {0.12, 0, 0});
  EXPECT_LT(plain.cut, 0.01);
  EXPECT_LT(plain.ridge, 0.1);
  EXPECT_LT(plain.dent, 0.01);
  EXPECT_GT(traits({0.12, 0, 1.5}, {0.12, 0, 0}).cut, 0.9);
  EXPECT_GT(traits({0, 0.4, 0}, {0, 0, 0}).ridge, 0.5);
  EXPECT_GT(traits({0.12, -0.5, -0.5}, {0.12, 0, -0.5}).dent, 0.1);
}

}  // namespace
}  // namespace cambium
