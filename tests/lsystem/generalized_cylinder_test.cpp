#include "lsystem/generalized_cylinder.h"

#include <gtest/gtest.h>

#include <cmath>

#include "grammar.h"

namespace cambium {
namespace {

using test::turtled;
using Curve = GeneralizedCylinder::Curve;

constexpr double kDegree = M_PI / 180;

double angle_between(const Vec3& a, const Vec3& b) {
  return std::acos(std::min(1.0, glm::dot(glm::normalize(a), glm::normalize(b))));
}

ControlPoint at(const Vec3& position, const Vec3& heading, double radius = 0.1) {
  return {position, glm::normalize(heading), radius, 1.2, 1.2};
}

TEST(GeneralizedCylinder, AHermiteAxisPassesItsPointsAlongTheirHeadings) {
  GeneralizedCylinder axis;
  EXPECT_TRUE(axis.pass(at({0, 0, 0}, {0, 0, 1})).empty());
  const AxisStretch stretch = axis.pass(at({1, 0, 1}, {1, 0, 0}));
  ASSERT_GT(stretch.size(), 8u);
  EXPECT_EQ(stretch.front().position, Vec3(0, 0, 0));
  EXPECT_EQ(stretch.back().position, Vec3(1, 0, 1));
  EXPECT_LT(angle_between(stretch[1].position - stretch[0].position, {0, 0, 1}), 4 * kDegree);
  EXPECT_LT(angle_between(stretch.back().position - stretch[stretch.size() - 2].position, {1, 0, 0}), 4 * kDegree);
  for (std::size_t i = 2; i < stretch.size(); ++i)
    EXPECT_LT(
        angle_between(stretch[i].position - stretch[i - 1].position, stretch[i - 1].position - stretch[i - 2].position),
        8 * kDegree);
}

// cpfg's tangents are as long as the chord, times their parameter: 1.2. Each moves the middle by an eighth of it.
TEST(GeneralizedCylinder, TangentsAreMeasuredInChords) {
  GeneralizedCylinder axis;
  axis.pass(at({0, 0, 0}, {0, 0, 1}));
  const AxisStretch stretch = axis.pass(at({2, 0, 0}, {0, 0, -1}));
  const Vec3 middle = stretch[stretch.size() / 2].position;
  EXPECT_NEAR(middle.x, 1, 1e-12);
  EXPECT_NEAR(middle.z, 2 * 1.2 * 2 / 8.0, 1e-12);
}

TEST(GeneralizedCylinder, StraightStretchesAreOneChord) {
  GeneralizedCylinder axis;
  axis.pass(at({0, 0, 0}, {0, 0, 1}, 0.3));
  const AxisStretch stretch = axis.pass(at({0, 0, 1}, {0, 0, 1}, 0.1));
  ASSERT_EQ(stretch.size(), 2u);
  EXPECT_EQ(stretch[0].radius, 0.3);
  EXPECT_EQ(stretch[1].radius, 0.1);
}

TEST(GeneralizedCylinder, AnEssIsNotTakenForAStraightLine) {
  GeneralizedCylinder axis;
  axis.pass(at({0, 0, 0}, {1, 0, 1}));
  EXPECT_GT(axis.pass(at({0, 0, 1}, {1, 0, 1})).size(), 4u);
}

TEST(GeneralizedCylinder, APointTwiceAddsNothing) {
  GeneralizedCylinder axis;
  axis.pass(at({0, 0, 5}, {0, 0, 1}));
  EXPECT_TRUE(axis.pass(at({0, 0, 5}, {1, 0, 0})).empty());
}

TEST(GeneralizedCylinder, ABSplineBeginsWithItsFourthPoint) {
  GeneralizedCylinder axis(Curve::kBSpline);
  for (const double z : {0.0, 1.0, 2.0}) EXPECT_TRUE(axis.pass(at({0, 0, z}, {1, 0, 0})).empty());
  const AxisStretch stretch = axis.pass(at({0, 0, 3}, {1, 0, 0}));
  ASSERT_EQ(stretch.size(), 2u);
  EXPECT_NEAR(stretch[0].position.z, 1, 1e-12);
  EXPECT_NEAR(stretch[1].position.z, 2, 1e-12);
}

TEST(GeneralizedCylinder, AClosedCurveComesBackSmoothly) {
  for (const Curve curve : {Curve::kHermite, Curve::kBSpline}) {
    GeneralizedCylinder axis(curve, true);
    std::vector<AxisStretch> all;
    for (int i = 0; i < 6; ++i) {
      const double a = i * 60 * kDegree;
      all.push_back(axis.pass(at({std::cos(a), std::sin(a), 0}, {-std::sin(a), std::cos(a), 0})));
    }
    for (AxisStretch& stretch : axis.close()) all.push_back(stretch);
    std::erase_if(all, [](const AxisStretch& stretch) { return stretch.empty(); });
    ASSERT_EQ(all.size(), 6u);
    for (std::size_t i = 0; i < 6; ++i)
      EXPECT_LT(glm::distance(all[i].back().position, all[(i + 1) % 6].front().position), 1e-12);
  }
}

// What follows is the turtle's side of it.

double turn_at(const Skeleton& skeleton, std::size_t node) {
  const SkeletonNode& here = skeleton.nodes[node];
  const SkeletonNode& parent = skeleton.nodes[static_cast<std::size_t>(here.parent)];
  const Vec3 before = parent.position - skeleton.nodes[static_cast<std::size_t>(parent.parent)].position;
  return angle_between(here.position - parent.position, before);
}

TEST(GeneralizedCylinder, BecomesOneSmoothAxisOfTheSkeleton) {
  const Turtled result = turtled("!(0.4)F@Gsf+(40)!(0.3)f@Gc-(80)f&(50)!(0.2)f@GeF");
  const auto& nodes = result.skeleton.nodes;
  ASSERT_GT(nodes.size(), 12u);
  for (std::size_t i = 1; i < nodes.size(); ++i) {
    EXPECT_EQ(nodes[i].parent, static_cast<std::int32_t>(i - 1));
    EXPECT_EQ(nodes[i].lateral, false);
    EXPECT_LE(nodes[i].radius, nodes[i - 1].radius);
    EXPECT_LT(i > 1 ? turn_at(result.skeleton, i) : 0, 8.01 * kDegree) << i;
  }
  EXPECT_EQ(nodes.back().radius, 0.1);
  EXPECT_EQ(result.radii_clamped, 0u);
  EXPECT_TRUE(result.skipped.empty());
}

TEST(GeneralizedCylinder, HoldsTheWoodOfItsSegments) {
  // F only moves within; the same places as with f.
  const Turtled drawn = turtled("@GsF+F@GcF@Ge"), moved = turtled("@Gsf+f@Gcf@Ge");
  ASSERT_EQ(drawn.skeleton.nodes.size(), moved.skeleton.nodes.size());
  EXPECT_EQ(drawn.skeleton.nodes.back().position, moved.skeleton.nodes.back().position);
  EXPECT_EQ(drawn.total_length, moved.total_length);
  EXPECT_GT(drawn.total_length, std::sqrt(2.0) + 1);
}

TEST(GeneralizedCylinder, HasBranchesInBrackets) {
  const Skeleton skeleton = turtled("@Gsf@Gc[+(60)FF]f@Gc[/(90)+(30)f@Gc+(20)f@Ge]f@Ge").skeleton;
  std::vector<std::size_t> laterals;
  std::size_t roots = 0;
  for (std::size_t i = 0; i < skeleton.nodes.size(); ++i) {
    if (skeleton.nodes[i].lateral == true) laterals.push_back(i);
    roots += skeleton.nodes[i].parent < 0;
  }
  EXPECT_EQ(roots, 1u);
  ASSERT_EQ(laterals.size(), 2u);
  const auto base = [&](std::size_t i) {
    return skeleton.nodes[static_cast<std::size_t>(skeleton.nodes[i].parent)].position;
  };
  EXPECT_EQ(base(laterals[0]), Vec3(0, 0, 1));
  EXPECT_EQ(base(laterals[1]), Vec3(0, 0, 2));
  // The second is a cylinder that leaves along its parent's heading.
  EXPECT_LT(angle_between(skeleton.nodes[laterals[1]].position - base(laterals[1]), {0, 0, 1}), 4 * kDegree);
  EXPECT_EQ(skeleton.nodes.back().position, Vec3(0, 0, 3));
}

TEST(GeneralizedCylinder, PassesWhereABranchLeavesIt) {
  // Nothing tells the curve of the bracket but the F in it; the same as with a control point there.
  const Skeleton tied = turtled("@Gs+(30)f(2)-(50)[&(60)FF[F]][~l]f@Ge").skeleton;
  const Skeleton told = turtled("@Gs+(30)f(2)-(50)@Gc[&(60)FF[F]]f@Ge").skeleton;
  ASSERT_EQ(tied.nodes.size(), told.nodes.size());
  for (std::size_t i = 0; i < tied.nodes.size(); ++i) {
    EXPECT_EQ(tied.nodes[i].position, told.nodes[i].position) << i;
    EXPECT_EQ(tied.nodes[i].parent, told.nodes[i].parent) << i;
    EXPECT_EQ(tied.nodes[i].lateral, told.nodes[i].lateral) << i;
  }
  // Leaves do not.
  EXPECT_EQ(turtled("@Gsf[+~l]f@Ge").skeleton.nodes.size(), 2u);
  // Nor does what begins elsewhere.
  const Skeleton apart = turtled("@Gsf[+f(3)F]f@Ge").skeleton;
  ASSERT_EQ(apart.nodes.size(), 4u);
  EXPECT_EQ(apart.nodes[0].parent, -1);
  EXPECT_EQ(apart.nodes[2].parent, -1);
}

TEST(GeneralizedCylinder, TheTangentsCanBeSet) {
  EXPECT_EQ(turtled("@Gt(0)@Gsf+f@Ge").skeleton.nodes.size(), 2u);
  const double plain = turtled("@Gsf+f@Ge").total_length, slack = turtled("@Gt(3)@Gsf+f@Ge").total_length;
  EXPECT_GT(slack, plain);
  EXPECT_EQ(turtled("@Gt(9,3)@Gs@Gt(3,9)f+f@Ge").total_length, slack);  // leaving by the second, arriving by the first
}

TEST(GeneralizedCylinder, BracesWithANumberEncloseOne) {
  const Turtled open = turtled("{(1).f+f.-f}"), same = turtled("@Gsf@Gc+f@Gc@Gc-f@Ge");
  EXPECT_EQ(open.skeleton.nodes.size(), same.skeleton.nodes.size());
  const Turtled closed = turtled("{(2).f+f+f}");
  EXPECT_LT(glm::length(closed.skeleton.nodes.back().position), 1e-12);
  EXPECT_GT(turtled("{(3).f+(30)f+(30)f+(30)f}").skeleton.nodes.size(), 2u);
  EXPECT_TRUE(open.foliage.organs.empty());
  EXPECT_EQ(turtled("{(7).f+f.}").skipped.at("{"), 1u);
}

TEST(GeneralizedCylinder, HalfOfOneDoesNoHarm) {
  EXPECT_EQ(turtled("@Gs").skeleton.nodes.size(), 0u);
  EXPECT_EQ(turtled("@Ge@GcF").skeleton.nodes.size(), 0u);  // @Gc alone begins one
  EXPECT_EQ(turtled("[@Gsf]F").skeleton.nodes.size(), 2u);
  EXPECT_EQ(turtled("@Gsf[@Ge]f@GeF").skeleton.nodes.size(), 4u);
  EXPECT_THROW(turtled("@Gt(1e200)@Gsf+f@Ge"), InputError);
}

}  // namespace
}  // namespace cambium
