#include "skeletons/scars.h"

#include "blobtree/blobtree_json.h"
#include "blobtree/field.h"
#include "blobtree/input_error.h"
#include "small_trees.h"

#include <gtest/gtest.h>

namespace cambium {
namespace {

Skeleton pole(double radius) {
  Skeleton s;
  s.nodes = {node_at({0, 0, 0}, radius, -1), node_at({0, 0, 20}, radius, 0)};
  return s;
}

/// Distance from the axis of a pole to the surface in direction (angle, z).
double surface_at(const Field& field, double angle, double z) {
  double in = 0.1, out = 3;
  for (int i = 0; i < 60; ++i) {
    const double r = 0.5 * (in + out);
    (field.value({r * std::cos(angle), r * std::sin(angle), z}) >= kIso ? in : out) = r;
  }
  return in;
}

SurfaceOptions with_scar(Profile profile, const Scar& scar) {
  SurfaceOptions options;
  options.profile = profile;
  options.scars.push_back(scar);
  return options;
}

TEST(Scars, AScarIsADentWithARaisedRimWiderThanHigh) {
  for (const Profile profile : {Profile::kChain, Profile::kGalbraith}) {
    Scar scar;
    scar.where.branch = 0;
    scar.along = 10;
    const Field field(surface(pole(1), with_scar(profile, scar)).tree);
    const double middle = surface_at(field, 0, 10);
    double rim_up = 0, rim_side = 0;
    for (double d = 0; d < 0.9; d += 0.01) {
      rim_up = std::max(rim_up, surface_at(field, 0, 10 + d));
      rim_side = std::max(rim_side, surface_at(field, d, 10));
    }
    EXPECT_LT(middle, 0.96);
    EXPECT_GT(middle, 0.7);
    EXPECT_GT(rim_up, 1.02);
    EXPECT_GT(rim_side, 1.02);
    EXPECT_LT(std::max(rim_up, rim_side), 1.2);
    EXPECT_NEAR(surface_at(field, std::numbers::pi, 10), 1, 1e-9);  // the far side does not notice
    EXPECT_NEAR(surface_at(field, 0, 12), 1, 1e-9);
    EXPECT_GT(surface_at(field, 0.58, 10), 1.005);                  // still on the rim sideways
    EXPECT_NEAR(surface_at(field, 0, 10.58), 1, 0.005);             // past it upwards
  }
}

TEST(Scars, APositionPlacesTheScarTowardsIt) {
  Scar scar;
  scar.where.position = Vec3(-3, 3, 7);
  const Field field(surface(pole(1), with_scar(Profile::kChain, scar)).tree);
  EXPECT_LT(surface_at(field, degrees(135), 7), 0.96);
  EXPECT_NEAR(surface_at(field, degrees(-45), 7), 1, 1e-9);
}

TEST(Scars, RandomScarsAreTheSameForASeedAndOthersForAnother) {
  SurfaceOptions options;
  options.random_scars = {12, 0.4};
  options.seed = 42;
  const Skeleton tree = fork_tree(0.5, 0.3, 50, 10);
  const std::string first = to_json(surface(tree, options).tree);
  EXPECT_EQ(first, to_json(surface(tree, options).tree));
  options.seed = 43;
  EXPECT_NE(first, to_json(surface(tree, options).tree));
}

TEST(Scars, RandomScarsLieOnWoodThickEnough) {
  SurfaceOptions options;
  options.random_scars = {50, 0.4};
  const AxisTree tree = decompose_axes(fork_tree(0.5, 0.3, 50, 10));
  SurfaceReport report;
  const auto scars = place_scars(tree, frames_of(tree), options, report);
  ASSERT_EQ(scars.size(), 50u);
  double lowest = 20, highest = 0;
  for (const PlacedScar& scar : scars) {
    EXPECT_EQ(scar.axis, 0u);
    const double z = position_at(tree.axes[0], scar.place).z;
    lowest = std::min(lowest, z);
    highest = std::max(highest, z);
  }
  EXPECT_GE(lowest, 0.5);
  EXPECT_LE(highest, 19.5);
  EXPECT_LT(lowest, 4);
  EXPECT_GT(highest, 16);
  options.random_scars.min_axis_radius = 9;
  EXPECT_TRUE(place_scars(tree, frames_of(tree), options, report).empty());
  EXPECT_EQ(report.notes.size(), 1u);
}

TEST(Scars, NumbersThatAreNotLegalAreInputErrors) {
  Scar scar;
  scar.where.branch = 5;
  EXPECT_THROW(surface(pole(1), with_scar(Profile::kChain, scar)), InputError);
  scar.where.branch = 0;
  scar.depth = 0;
  EXPECT_THROW(surface(pole(1), with_scar(Profile::kChain, scar)), InputError);
  scar.depth = 1;
  scar.radius = -1;
  EXPECT_THROW(surface(pole(1), with_scar(Profile::kChain, scar)), InputError);
  scar.radius = 1;
  scar.along = NAN;
  EXPECT_THROW(surface(pole(1), with_scar(Profile::kChain, scar)), InputError);
}

}  // namespace
}  // namespace cambium
