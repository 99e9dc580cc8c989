// Warps by themselves, and what batches make of them: the same in vector lanes.
#include "blobtree/warps.h"

#include "blobtree/field.h"
#include "blobtree/lane_warps-inl.h"   // for the instructions that every machine of this kind has
#include "random_blobtrees.h"

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

TEST(Bend, MovesVelocitiesAsItMovesPointsAndTellsHowFarTheyTurn) {
  Draws draws(11);
  for (int i = 0; i < 400; ++i) {
    const Warp warp = bend_warp({kO, kZ, kX, draws.in(-2.5, 2.5), 0});
    const auto* const bend = std::get_if<BendWarp>(&warp);
    if (!bend) continue;
    const Vec3 velocity = draws.direction();
    const Ball ball{draws.point({Vec3(-0.3, -0.5, -0.3), Vec3(0.5, 0.5, 1.3)}), draws.in(1e-3, 0.2)};
    if (!unwarp(warp, ball).certain) continue;
    const Vec3 middle = push_forward(*bend, ball.center, velocity);
    const double turn = turn_in(*bend, ball, velocity);
    for (int k = 0; k < 50; ++k) {
      const Vec3 p = ball.center + draws.in(0, 1) * ball.radius * draws.direction();
      ASSERT_LE(glm::length(push_forward(*bend, p, velocity) - middle), turn + 1e-12);
    }
    constexpr double kStep = 1e-7;
    const Vec3 difference = (unwarp(warp, ball.center + kStep * velocity) - unwarp(warp, ball.center - kStep * velocity)) / (2 * kStep);
    ASSERT_NEAR(glm::length(difference - middle), 0, 1e-5);
  }
}

TEST(Bend, BoundsNearTheCentreOfItsArcTellThatNothingIsThere) {
  const Field field = warped(Capsule{kO, kPi / 2 * kZ, 0.1, 1}, [](NodeId id) { return Bend{kO, kZ, kX, kPi, id}; });   // rho = 0.5
  const Vec3 centre(0, 0, 0.5);
  const PrunedField whole = field.whole();
  Evaluator evaluator;
  for (const double radius : {1e-3, 0.05, 0.25}) EXPECT_EQ(evaluator.interval(whole, Ball{centre, radius}).hi, 0) << radius;
  EXPECT_EQ(evaluator.interval(whole, Ball{centre + Vec3(-0.1, 0, 0.02), 0.1}).hi, 0);
  EXPECT_GE(evaluator.interval(whole, Ball{centre, 0.5}).hi, 1);   // up to the axis
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

// ---- in lanes -----------------------------------------------------------------------------------------------------

namespace lanes = HWY_NAMESPACE;
using DoubleLanes = lanes::Lanes<double>;

double first_of(DoubleLanes v) {
  alignas(64) double all[16];
  lanes::store(v, all);
  return all[0];
}
lanes::DoubleVector in_lanes(const Vec3& v) { return {DoubleLanes(v.x), DoubleLanes(v.y), DoubleLanes(v.z)}; }
Vec3 first_of(const lanes::DoubleVector& v) { return {first_of(v.x), first_of(v.y), first_of(v.z)}; }

double sine_and_cosine_error(double angle) {
  const lanes::SineAndCosine got = lanes::sine_and_cosine(DoubleLanes(angle));
  const long double a = angle, sine = first_of(got.sine), cosine = first_of(got.cosine);
  return static_cast<double>(std::max(std::abs(sine - std::sin(a)), std::abs(cosine - std::cos(a))));
}

TEST(LaneAngles, SinesAndCosinesAreWithinTheirError) {
  Draws draws(1);
  for (int i = -400000; i <= 400000; ++i) ASSERT_LT(sine_and_cosine_error(3e-5 * i), 2.5e-16) << 3e-5 * i;
  for (int i = 0; i < 400000; ++i) {
    const double angle = std::pow(10.0, draws.in(-20, 6)) * (i % 2 == 0 ? 1 : -1);
    ASSERT_LT(sine_and_cosine_error(angle), 2.5e-16) << angle;
  }
  for (int i = -600000; i <= 600000; i += 7)   // where quadrants meet
    for (const double beside : {-1.0, 0.0, 1.0}) {
      const double angle = i * kPi / 4, next = std::nextafter(angle, angle + beside);
      ASSERT_LT(sine_and_cosine_error(next), 2.5e-16) << next;
    }
  for (int i = 0; i < 100000; ++i) {
    const double angle = std::pow(10.0, draws.in(6, 15)), last_bit = std::nextafter(angle, kInfinity) - angle;
    ASSERT_LT(sine_and_cosine_error(angle), 2.5e-16 + last_bit) << angle;
  }
}

TEST(LaneAngles, AnglesAreWithinTheirError) {
  const auto error = [](double x, double y) {
    const long double expected = std::atan2(static_cast<long double>(x), static_cast<long double>(y));
    return static_cast<double>(std::abs(first_of(lanes::angle_from_y(DoubleLanes(x), DoubleLanes(y))) - expected));
  };
  Draws draws(2);
  for (int i = 0; i <= 800000; ++i) {
    const double angle = kPi * (i / 400000.0 - 1), away = std::pow(10.0, draws.in(-9, 9));
    ASSERT_LT(error(away * std::sin(angle), away * std::cos(angle)), 5e-16) << angle;
  }
  for (int i = 0; i < 100000; ++i) {
    const double small = std::pow(10.0, draws.in(-300, 0)), large = draws.in(-2, 2);
    ASSERT_LT(error(small, large), 5e-16);
    ASSERT_LT(error(large, -small), 5e-16);
  }
  for (const double x : {-1.0, 0.0, 1.0})
    for (const double y : {-1.0, 0.0, 1.0}) ASSERT_LT(error(x, y), 5e-16) << x << " " << y;
}

// Points and gradients of a warp in lanes against those of warps.h, `reach` around a place. `shear`: how large the parts of
// a gradient can be that cancel each other.
template <class Lanes, template <class> class Slopes, class W>
void expect_lanes_agree(const W& warp, const Vec3& place, double reach, double error = 1e-12, double shear = 0) {
  Draws draws(3);
  const Vec3 outside = place + 0.1 * draws.direction(), inside = unwarp(Warp(warp), outside);
  const Lanes in(warp, outside, inside);
  const Slopes<double> slopes_of(warp, outside);
  for (int i = 0; i < 20000; ++i) {
    const Vec3 p = place + draws.point({Vec3(-reach), Vec3(reach)}), g = draws.direction();
    lanes::DoubleVector slopes;
    const Vec3 got = inside + first_of(in.unwarp(in_lanes(p - outside), slopes)), expected = unwarp(Warp(warp), p);
    ASSERT_LT(glm::length(got - expected), error * (1 + reach + glm::length(place))) << p.x << " " << p.y << " " << p.z;
    const Vec3 back = first_of(slopes_of.pull_back(in_lanes(p - outside), slopes, in_lanes(g)));
    const Vec3 gradient = pull_back(Warp(warp), p, g);
    const double size = 1 + shear + glm::length(gradient);
    ASSERT_LT(glm::length(back - gradient), 10 * error * size) << p.x << " " << p.y << " " << p.z;
  }
}

TEST(LaneWarps, AreThoseOfPoints) {
  Draws draws(4);
  for (const double angle : {0.01, 0.4, kPi / 2, 2.5, -kPi / 2, 4.0, 6.0}) {
    SCOPED_TRACE(angle);
    const Warp bend = bend_warp({draws.direction(), draws.direction(), draws.direction(), angle, 0});
    for (const double reach : {0.1, 3.0})
      expect_lanes_agree<lanes::BendLanes, lanes::BendSlopes>(std::get<BendWarp>(bend), draws.direction(), reach);
  }
  for (const double angle : {4e-8, 1e-6, 1e-4}) {   // the straighter, the larger the arc's radius
    SCOPED_TRACE(angle);
    const Warp bend = bend_warp({{0, 0, 0}, {0, 0.3, 1}, draws.direction(), angle, 0});
    expect_lanes_agree<lanes::BendLanes, lanes::BendSlopes>(std::get<BendWarp>(bend), {0, 0, 0.5}, 1, 1e-15 / angle);
  }
  for (const double rate : {0.5, -8.0, 100.0})
    for (const double far : {1.0, 30.0}) {
      SCOPED_TRACE(rate);
      const TwistWarp twist = twist_warp({draws.direction(), 2.0 * draws.direction(), rate, 0});
      expect_lanes_agree<lanes::TwistLanes, lanes::TwistSlopes>(twist, far * draws.direction(), 1, 1e-12,
                                                                 std::abs(rate) * far);
    }
  for (const double to_scale : {0.2, 3.0}) {
    SCOPED_TRACE(to_scale);
    const TaperWarp taper = taper_warp({draws.direction(), 2.0 * draws.direction(), -0.3, 1.1, 0.7, to_scale, 0});
    expect_lanes_agree<lanes::TaperLanes, lanes::TaperSlopes>(taper, draws.direction(), 2);
  }
}

// In boxes where floats will do, and in boxes where batches are in double: those keep all that a float can say.
TEST(LaneWarps, BatchesOfWarpedFieldsAgreeWithPoints) {
  const Cone cone{{0, 0, -0.5}, {0.02, 0, 0.5}, 0.1, 0.08, 1};
  const Field fields[] = {warped(cone, [](NodeId id) { return Bend{{0, 0, -0.5}, {0, 0, 0.5}, kX, 1.2, id}; }),
                          warped(cone, [](NodeId id) { return Twist{{0.2, 0, 0}, kZ, 3, id}; }),
                          warped(cone, [](NodeId id) { return Taper{{0.1, 0, 0}, kZ, -0.3, 1.2, 0.3, 0.7, id}; })};
  Draws draws(5);
  Evaluator evaluator;
  for (const Field& field : fields)
    for (const double half : {0.05, 0.5, 20.0}) {
      const Vec3 center(0.05, 0.02, 0.1);
      const PrunedField pruned = field.prune({center - half, center + half});
      int telling = 0;
      std::vector<float> x, y, z, f(2000), gx(2000), gy(2000), gz(2000);
      for (std::size_t i = 0; i < 2000; ++i) {
        const double spread = std::min(half, 0.3);
        const Vec3 p = center + draws.point({Vec3(-spread), Vec3(spread)}) - pruned.origin();
        x.push_back(static_cast<float>(p.x)), y.push_back(static_cast<float>(p.y)), z.push_back(static_cast<float>(p.z));
      }
      evaluator.samples(pruned, x, y, z, f, gx, gy, gz);
      const double error = half > 1 ? 6.1e-8 : 2e-6;
      for (std::size_t i = 0; i < 2000; ++i) {
        const Sample exact = evaluator.sample(pruned, pruned.origin() + Vec3(x[i], y[i], z[i]));
        ASSERT_NEAR(f[i], exact.value, error);
        ASSERT_LT(glm::length(Vec3(gx[i], gy[i], gz[i]) - exact.gradient), 30 * error * (1 + glm::length(exact.gradient)));
        telling += exact.value > 0.1 && exact.value < 0.9;
      }
      EXPECT_GT(telling, 100);
    }
}

}  // namespace
}  // namespace cambium
