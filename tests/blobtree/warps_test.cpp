#include "blobtree/field.h"

#include <gtest/gtest.h>

#include <cmath>
#include <functional>
#include <numbers>

namespace cambium {
namespace {

constexpr double kPi = std::numbers::pi;
const Vec3 kX(1, 0, 0), kY(0, 1, 0), kZ(0, 0, 1), kO(0.0);

Field warped(Node child, const std::function<Node(NodeId)>& warp) {
  BlobTreeBuilder b;
  const NodeId id = b.add(std::move(child));
  return Field(b.build(b.add(warp(id))));
}

// A straight thin capsule as long as the arc becomes the arc, through the same end points.
TEST(Bend, TurnsASegmentIntoTheArcBetweenTheSameEnds) {
  for (const double theta : {0.3, kPi / 2, 2.5, -kPi / 2}) {
    const double rho = 1 / (2 * std::sin(std::abs(theta) / 2)), arc = rho * std::abs(theta);
    const Field field = warped(Capsule{kO, arc * kZ, 0.05, 1}, [&](NodeId id) { return Bend{kO, kZ, kX, theta, id}; });
    const Vec3 bulge = theta > 0 ? kX : -kX;
    const Vec3 centre = 0.5 * kZ - rho * std::cos(theta / 2) * bulge;
    for (int i = 0; i <= 20; ++i) {
      const double phi = std::abs(theta) * (i / 20.0 - 0.5);
      const Vec3 outward = std::sin(phi) * kZ + std::cos(phi) * bulge;
      const Vec3 on_arc = centre + rho * outward;
      ASSERT_NEAR(field.value(on_arc), 1, 1e-9);
      ASSERT_NEAR(field.value(on_arc + 0.05 * kY), kIso, 1e-9);
      ASSERT_NEAR(field.value(on_arc + 0.05 * outward), kIso, 1e-9);
    }
    EXPECT_NEAR(field.value(kO), 1, 1e-9);
    EXPECT_NEAR(field.value(kZ), 1, 1e-9);
  }
}

TEST(Bend, OfNoAngleIsTheIdentity) {
  const Capsule capsule{kO, kZ, 0.1, 1};
  const Field bent = warped(capsule, [](NodeId id) { return Bend{kO, kZ, kX, 0, id}; });
  const Field barely = warped(capsule, [](NodeId id) { return Bend{kO, kZ, kX, 1e-7, id}; });
  const Vec3 p(0.05, 0.07, 0.4);
  EXPECT_NEAR(bent.value(p), barely.value(p), 1e-5);
}

TEST(Bend, RefusesAChildThickerThanItsRadiusOfCurvature) {
  const auto bend = [](double radius) {
    return warped(Capsule{kO, kPi / 2 * kZ, radius, 1}, [](NodeId id) { return Bend{kO, kZ, kX, kPi, id}; });  // rho = 0.5
  };
  EXPECT_NO_THROW(bend(0.2));    // support 0.44
  EXPECT_THROW(bend(0.25), InvalidNode);  // support 0.55
}

TEST(Transform, MovesTheChild) {
  Mat4 m(0.0);  // x -> y -> z -> x, twice as large, then up by 3
  m[0][1] = m[1][2] = m[2][0] = 2;
  m[3] = {0, 0, 3, 1};
  const Field field = warped(Sphere{kY, 0.1, 1}, [&](NodeId id) { return Transform{m, id}; });
  EXPECT_NEAR(field.value({0, 0, 5}), 1, 1e-12);
  EXPECT_NEAR(field.value({0.2, 0, 5}), kIso, 1e-9);
}

TEST(Twist, TurnsRightHandedWithHeight) {
  const Field field = warped(Sphere{{1, 0, 2}, 0.1, 1}, [](NodeId id) { return Twist{kO, kZ, kPi / 4, id}; });
  EXPECT_NEAR(field.value({0, 1, 2}), 1, 1e-12);  // a quarter turn at height 2
}

TEST(Taper, ScalesTheCrossSectionAndIsConstantBeyond) {
  const auto at = [](double z) {
    return warped(Sphere{{1, 0, z}, 0.1, 1}, [](NodeId id) { return Taper{kO, kZ, 0, 1, 2, 0.5, id}; });
  };
  EXPECT_NEAR(at(1).value({0.75, 0, 1}), 1, 1e-12);
  EXPECT_NEAR(at(5).value({0.5, 0, 5}), 1, 1e-12);
  EXPECT_NEAR(at(-5).value({1, 0, -5}), 1, 1e-12);
}

}  // namespace
}  // namespace cambium
