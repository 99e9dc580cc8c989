// What junctions look like: numbers measured on the field of the chain profile.
#include "blobtree/field.h"
#include "skeletons/surface.h"

#include "small_trees.h"

#include <gtest/gtest.h>

#include <algorithm>

namespace cambium {
namespace {

TEST(JunctionField, AnUnbranchedChainHasItsExactRadius) {
  Skeleton s;
  for (int i = 0; i < 60; ++i) s.nodes.push_back(node_at({0.2 * i, 0.1 * i, 1.0 * i}, 0.3, i - 1));
  const Field field(surface(s, {}).tree);
  const Vec3 along = glm::normalize(Vec3(0.2, 0.1, 1)), side = glm::normalize(glm::cross(along, Vec3(1, 0, 0)));
  for (double t = 1; t < 59; t += 0.37) {
    const Vec3 p = Vec3(0.2, 0.1, 1.0) * t;
    EXPECT_GE(field.value(p + (0.3 - 1e-9) * side), kIso);
    EXPECT_LT(field.value(p + (0.3 + 1e-9) * side), kIso);
  }
}

/// How far the surface stands out, at most, over the radius 1 of an upright axis on the side away from its lateral.
double far_side_bulge(const Field& field, double fork_height) {
  double largest = 0;
  for (double z = fork_height - 3; z < fork_height + 5; z += 0.1)
    for (const double angle : {150.0, 165.0, 180.0, 195.0, 210.0}) {
      const Vec3 outward(std::cos(degrees(angle)), std::sin(degrees(angle)), 0);
      double in = 0.5, out = 2;
      for (int i = 0; i < 30; ++i) {
        const double r = 0.5 * (in + out);
        (field.value(Vec3(0, 0, z) + r * outward) >= kIso ? in : out) = r;
      }
      EXPECT_GT(in, 1 - 1e-6);
      largest = std::max(largest, in - 1);
    }
  return largest;
}

// With the delta of field.md alone this would be 5.9 % at 20 degrees for equal radii, 2.7 % at 30.
TEST(JunctionField, TheFarSideOfAForkBulgesByLessThanTwoPercent) {
  for (const double ratio : {0.3, 0.5, 0.7, 0.8, 0.9, 1.0})
    for (const double angle : {20.0, 25.0, 30.0, 35.0, 40.0, 50.0, 65.0, 80.0}) {
      const Field field(surface(fork_tree(1, ratio, angle, 20), {}).tree);
      EXPECT_LT(far_side_bulge(field, 20), 0.02) << ratio << " at " << angle << " degrees";
    }
}

/// The last point inside along `direction` from `start`.
Vec3 outermost(const Field& field, const Vec3& start, const Vec3& direction) {
  constexpr double kStep = 0.05;
  double in = 0;
  for (double t = 0; t < 10; t += kStep)
    if (field.value(start + t * direction) >= kIso) in = t;
  double out = in + kStep;
  for (int i = 0; i < 50; ++i) {
    const double t = 0.5 * (in + out);
    (field.value(start + t * direction) >= kIso ? in : out) = t;
  }
  return start + in * direction;
}

TEST(JunctionField, TheCrotchOfAForkIsACrease) {
  for (const double ratio : {0.3, 0.6, 1.0})
    for (const double angle : {30.0, 55.0, 80.0}) {
      const double half = degrees(angle) / 2;
      const Field field(surface(fork_tree(1, ratio, angle, 20), {}).tree);
      const Vec3 bisector(std::sin(half), 0, std::cos(half)), side(std::cos(half), 0, -std::sin(half));
      const auto turn = [&](double a, double b) {  // of the normal between two places across the crotch
        const auto normal = [&](double s) {
          return glm::normalize(-field.sample(outermost(field, Vec3(0, 0, 20) + s * side, bisector)).gradient);
        };
        return std::acos(std::clamp(glm::dot(normal(a), normal(b)), -1.0, 1.0));
      };
      double from = -0.1, largest = 0;
      for (double s = -0.105; s < 0.6; s += 0.01)
        if (turn(s, s + 0.01) > largest) largest = turn(s, s + 0.01), from = s;
      double to = from + 0.01;
      for (int i = 0; i < 14; ++i) {  // closing in on it, the turn stays
        const double middle = 0.5 * (from + to);
        (turn(from, middle) > turn(middle, to) ? to : from) = middle;
      }
      EXPECT_LT(to - from, 1e-6);
      EXPECT_GT(turn(from, to), degrees(60)) << ratio << " at " << angle << " degrees";
    }
}

}  // namespace
}  // namespace cambium
