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

// Where a chain turns, the nearest parameter stands still outside of the bend and skips inside of it; metres along it do not.
TEST(Contributions, MetresRunEvenlyRoundABendAndOverTheTips) {
  const double turn = 0.6;
  const Vec3 first = kX, second(std::cos(turn), std::sin(turn), 0), node = 1.0 * first, tip = node + 1.0 * second;
  BlobTreeBuilder b;
  const NodeId id = b.add(Chain{{{kO, 0.1}, {node, 0.1}, {tip, 0.1}}});
  b.set_attributes(id, {0, 0, 5, kZ});
  const Field field(b.build(id));
  const Vec3 outwards = glm::normalize(Vec3(std::sin(turn / 2), -std::cos(turn / 2), 0));
  for (const double side : {1.0, -1.0, 0.0}) {
    // From across the middle of one piece to across the middle of the other, along their surface.
    const Vec3 out1 = side == 0 ? kZ : side * Vec3(0, -1, 0), out2 = side == 0 ? kZ : side * Vec3(std::sin(turn), -std::cos(turn), 0);
    const Vec3 corner = node + (side == 0 ? 0.1 * kZ : side * 0.1 / std::cos(turn / 2) * outwards);
    const Vec3 from = 0.5 * first + 0.1 * out1, to = node + 0.5 * second + 0.1 * out2;
    const double way = glm::distance(from, corner) + glm::distance(corner, to);
    double last = contributions(field, from)[0].v;
    EXPECT_NEAR(last, 5.5, 0.02);
    const int steps = 400;
    for (int i = 1; i <= steps; ++i) {
      const double at = way * i / steps, split = glm::distance(from, corner);
      const Vec3 p = at < split ? glm::mix(from, corner, at / split) : glm::mix(corner, to, (at - split) / (way - split));
      const auto c = contributions(field, p);
      ASSERT_EQ(c.size(), 1u);
      EXPECT_NEAR((c[0].v - last) / (way / steps), 1, 0.12) << "side " << side << " step " << i;
      last = c[0].v;
    }
    EXPECT_NEAR(last, 6.5, 0.02);
  }
  for (const double beyond : {0.0, 0.05, 0.0999}) {
    const auto c = contributions(field, tip + beyond * second + std::sqrt(0.01 - beyond * beyond) * kZ);
    EXPECT_NEAR(c[0].v, 7 + beyond, 1e-9);
    EXPECT_NEAR(c[0].from_axis, std::sqrt(0.01 - beyond * beyond), 1e-9);
    EXPECT_NEAR(contributions(field, -beyond * first + std::sqrt(0.01 - beyond * beyond) * kZ)[0].v, 5 - beyond, 1e-9);
  }
}

TEST(Contributions, HaveGradientsThatDifferencesConfirm) {
  BlobTreeBuilder b;
  const NodeId straight = b.add(Chain{{{{0, 0, -1}, 0.2}, {{0, 0, 1.5}, 0.15}, {{0, 0, 4}, 0.1}}}), ball = b.add(Sphere{{0.3, 0.1, 0.6}, 0.2, 0.7});
  const NodeId bent = b.add(Bend{kO, 2.0 * kZ, kX, 0.5, b.add(RoundCone{{0.4, 0.2, 0.2}, {0.4, 0.2, 1.4}, 0.15, 0.12})});
  const Field field(b.build(b.add(Sum{{straight, ball, bent}})));
  for (const Vec3& p : {Vec3(0.18, 0.05, 0.7), Vec3(0.22, 0.15, 0.9), Vec3(0.2, 0.2, 0.5)}) {
    const auto here = contributions(field, p);
    ASSERT_GE(here.size(), 2u);
    for (const Vec3& direction : {kX, Vec3(0, 1, 0), kZ}) {
      const double step = 1e-6;
      const auto ahead = contributions(field, p + step * direction), behind = contributions(field, p - step * direction);
      ASSERT_EQ(ahead.size(), here.size());
      ASSERT_EQ(behind.size(), here.size());
      for (std::size_t i = 0; i < here.size(); ++i) {
        EXPECT_NEAR(glm::dot(here[i].weight_gradient, direction), (ahead[i].weight - behind[i].weight) / (2 * step), 1e-5);
        EXPECT_NEAR(glm::dot(here[i].u_gradient, direction), std::remainder(ahead[i].u - behind[i].u, 1.0) / (2 * step), 1e-5);
        EXPECT_NEAR(glm::dot(here[i].v_gradient, direction), (ahead[i].v - behind[i].v) / (2 * step), 1e-5);
      }
    }
  }
}

TEST(Contributions, NameTheirPrimitiveTheSameEverywhere) {
  BlobTreeBuilder b;
  const NodeId left = b.add(Chain{{{kO, 0.1}, {kX, 0.1}, {2.0 * kX, 0.1}}}), right = b.add(Sphere{{2.1, 0, 0}, 0.1, 1});
  const Field field(b.build(b.add(Sum{{left, right}})));
  const auto a = contributions(field, {0.2, 0, 0.05}), c = contributions(field, {1.5, 0, 0.05}), both = contributions(field, {2.05, 0, 0.05});
  ASSERT_EQ(both.size(), 2u);
  EXPECT_EQ(a[0].primitive, c[0].primitive);
  EXPECT_EQ(both[0].primitive, a[0].primitive);
  EXPECT_NE(both[1].primitive, a[0].primitive);
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
