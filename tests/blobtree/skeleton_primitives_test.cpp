#include "blobtree/field.h"
#include "conformance_cases.h"

#include <gtest/gtest.h>

#include <numbers>

namespace cambium {
namespace {

Field field_of(Node node) {
  BlobTreeBuilder b;
  const NodeId id = b.add(std::move(node));
  return Field(b.build(id));
}

// Distance from `from` (inside) along a unit direction to the surface, by bisection.
double surface_distance(const Field& field, const Vec3& from, const Vec3& direction, double outside) {
  double lo = 0, hi = outside;
  EXPECT_GE(field.value(from), kIso);
  EXPECT_LT(field.value(from + outside * direction), kIso);
  for (int i = 0; i < 60; ++i) {
    const double mid = 0.5 * (lo + hi);
    (field.value(from + mid * direction) >= kIso ? lo : hi) = mid;
  }
  return lo;
}

// The two numbers that pin both the falloff and the support radius (field.md section 2).
TEST(Falloff, FacingCapsulesBlendToTheSpecifiedRadii) {
  constexpr double r = 0.2;
  const auto radii = [](double gap) {
    BlobTreeBuilder b;
    const NodeId left = b.add(Capsule{{-4 * r, 0, 0}, {-0.5 * gap, 0, 0}, r, 1});
    const NodeId right = b.add(Capsule{{0.5 * gap, 0, 0}, {4 * r, 0, 0}, r, 1});
    const Field field(b.build(b.add(Sum{{left, right}})));
    Interval range{kInfinity, 0};
    for (int i = -200; i <= 200; ++i) {
      const double radius = surface_distance(field, {i * r / 100, 0, 0}, {0, 0, 1}, 2 * r) / r;
      range = {std::min(range.lo, radius), std::max(range.hi, radius)};
    }
    return range;
  };
  EXPECT_NEAR(radii(1.75 * r).lo, 1.0000, 1e-4);
  EXPECT_NEAR(radii(1.75 * r).hi, 1.0141, 1e-4);
  EXPECT_NEAR(radii(1.80 * r).lo, 0.9918, 1e-4);
  EXPECT_NEAR(radii(1.80 * r).hi, 1.0047, 1e-4);
}

TEST(Primitives, StandAtTheirSurfaceDistance) {
  constexpr double r = 0.1;
  const Vec3 o(0.0), x(1, 0, 0), y(0, 1, 0), z(0, 0, 1);
  EXPECT_NEAR(surface_distance(field_of(Sphere{o, r, 1}), o, x, 1), r, 1e-9);
  EXPECT_NEAR(surface_distance(field_of(Capsule{-z, z, r, 1}), 0.3 * z, y, 1), r, 1e-9);
  EXPECT_NEAR(surface_distance(field_of(Disc{o, z, 0.5, r, 1}), 0.2 * x, z, 1), r, 1e-9);
  EXPECT_NEAR(surface_distance(field_of(Disc{o, 3.0 * z, 0.5, r, 1}), o, x, 1), 0.5 + r, 1e-9);
  EXPECT_NEAR(surface_distance(field_of(Torus{o, z, 0.5, r, 1}), 0.5 * y, y, 1), r, 1e-9);
  EXPECT_NEAR(surface_distance(field_of(RotatedBox{o, {0.3, 0.2, 0.1}, {1, 0, 0, 0}, r, 1}), o, x, 2), 0.3 + r, 1e-9);
  // A quarter turn about z, as a quaternion of any length.
  EXPECT_NEAR(surface_distance(field_of(RotatedBox{o, {0.3, 0.2, 0.1}, {5, 0, 0, 5}, r, 1}), o, x, 2), 0.2 + r, 1e-9);
  EXPECT_NEAR(surface_distance(field_of(Cone{o, z, 0.3, r, 1}), o, -z, 1), r, 1e-9);
  EXPECT_NEAR(surface_distance(field_of(Cone{o, z, 0.3, r, 1}), z, z, 1), r, 1e-9);
  // Not 0.3: the flank of the cone is slanted.
  EXPECT_NEAR(surface_distance(field_of(Cone{o, z, 0.3, r, 1}), 1e-9 * z, x, 1), 0.2 + r * std::hypot(0.2, 1), 1e-2);
}

TEST(Cone, IsTheSameWithItsEndsExchanged) {
  const Field cone = field_of(Cone{{0, 0, 0}, {0.3, 0, 1}, 0.3, 0.1, 1}), turned = field_of(Cone{{0.3, 0, 1}, {0, 0, 0}, 0.1, 0.3, 1});
  Draws draws(1);
  for (int i = 0; i < 200; ++i) {
    const Vec3 p = draws.point(cone.bounds());
    ASSERT_NEAR(cone.value(p), turned.value(p), 1e-15);
  }
}

TEST(Cone, OfNoLengthIsASphere) {
  const Vec3 o(0.2, 0.1, 0);
  const Field cone = field_of(Cone{o, o, 0.3, 0.1, 1}), sphere = field_of(Sphere{o, 0.1, 1});
  Draws draws(1);
  for (int i = 0; i < 200; ++i) {
    const Vec3 p = draws.point({Vec3(-0.5), Vec3(0.5)});
    ASSERT_NEAR(cone.value(p), sphere.value(p), 1e-15);
  }
}

TEST(Chain, UnbranchedHasItsExactRadius) {
  Chain chain;  // a helix
  constexpr double r = 0.05;
  for (int i = 0; i <= 200; ++i)
    chain.nodes.push_back({{0.5 * std::cos(0.05 * i), 0.5 * std::sin(0.05 * i), 0.01 * i}, r});
  const Field field = field_of(chain);
  for (std::size_t i = 0; i + 1 < chain.nodes.size(); ++i) {
    const Vec3 a = chain.nodes[i].position, b = chain.nodes[i + 1].position;
    const Vec3 across = glm::normalize(glm::cross(b - a, Vec3(0, 0, 1)));  // outwards: no other segment is nearer
    ASSERT_NEAR(surface_distance(field, 0.5 * (a + b), across, 3 * r), r, 1e-9);
  }
}

TEST(Chain, SurfaceIsExactlyTheSweptVolume) {
  Draws draws(3);
  for (int i = 0; i < 100; ++i) {
    const ChainNode a{draws.point({Vec3(-1), Vec3(1)}), draws.in(0.05, 0.5)}, b{draws.point({Vec3(-1), Vec3(1)}), draws.in(0.05, 0.5)};
    const Field field = field_of(RoundCone{a.position, b.position, a.radius, b.radius, 1});
    const Vec3 from = glm::mix(a.position, b.position, draws.in(0, 1)), direction = draws.direction();
    const Vec3 p = from + surface_distance(field, from, direction, 4) * direction;
    // Signed distance to the swept spheres: the least of |p - c(t)| - r(t), which is convex in t.
    double lo = 0, hi = 1;
    const auto gap = [&](double t) {
      return glm::length(p - glm::mix(a.position, b.position, t)) - glm::mix(a.radius, b.radius, t);
    };
    for (int k = 0; k < 200; ++k) {
      const double m1 = lo + (hi - lo) / 3, m2 = hi - (hi - lo) / 3;
      (gap(m1) < gap(m2) ? hi : lo) = gap(m1) < gap(m2) ? m2 : m1;
    }
    ASSERT_NEAR(gap(0.5 * (lo + hi)), 0, 1e-9);
  }
}

TEST(Chain, ToleratesRepeatedAndSwallowedNodes) {
  const Vec3 o(0.0), z(0, 0, 1);
  const Field chain = field_of(Chain{{{o, 0.1}, {o, 0.3}, {0.05 * z, 0.1}, {z, 0.1}, {z, 0.1}}, 1});
  EXPECT_NEAR(surface_distance(chain, o, -z, 1), 0.3, 1e-9);
  EXPECT_NEAR(surface_distance(chain, z, z, 1), 0.1, 1e-9);
  EXPECT_NEAR(surface_distance(field_of(Chain{{{z, 0.2}}, 1}), z, {1, 0, 0}, 1), 0.2, 1e-9);
}

TEST(Strength, ScalesAndDents) {
  const Vec3 o(0.0);
  EXPECT_EQ(field_of(Sphere{o, 1, -0.5}).value(o), -0.5);
  EXPECT_EQ(field_of(Sphere{o, 1, 0}).value(o), 0);
}

}  // namespace
}  // namespace cambium
