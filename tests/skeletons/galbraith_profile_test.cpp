#include "blobtree/field.h"
#include "skeletons/surface.h"

#include "small_trees.h"

#include <gtest/gtest.h>

namespace cambium {
namespace {

SurfaceOptions galbraith() {
  SurfaceOptions options;
  options.profile = Profile::kGalbraith;
  return options;
}

TEST(GalbraithProfile, OneChildShortensItsParentByOnePointSevenFiveOfItsTipRadius) {
  Skeleton s;
  s.nodes = {node_at({0, 0, 0}, 0.5, -1), node_at({0, 0, 10}, 0.4, 0), node_at({0, 0, 20}, 0.3, 1)};
  const Surfaced made = surface(s, galbraith());
  const Sum sum = made.tree.get<Sum>(made.tree.root());
  ASSERT_EQ(sum.children.size(), 2u);
  const Cone a = made.tree.get<Cone>(sum.children[0]);
  const Cone b = made.tree.get<Cone>(sum.children[1]);
  EXPECT_EQ(a.base, Vec3(0, 0, 0));
  EXPECT_NEAR(a.tip.z, 10 - 1.75 * 0.3, 1e-12);
  EXPECT_EQ(a.radius_base, 0.5);
  EXPECT_EQ(a.radius_tip, 0.4);
  EXPECT_NEAR(b.base.z, 10, 1e-12);
  EXPECT_EQ(b.tip, Vec3(0, 0, 20));
}

TEST(GalbraithProfile, SeveralChildrenStartAtTheirDeltasAndMeetInContact) {
  Skeleton s = fork_tree(0.5, 0.3, 50, 10);
  s.nodes[2].radius = 0.4;
  SurfaceOptions options = galbraith();
  options.lip = 2;
  const Surfaced made = surface(s, options);
  const Sum sum = made.tree.get<Sum>(made.tree.root());
  const Cone a = made.tree.get<Cone>(sum.children[0]);
  EXPECT_NEAR(a.tip.z, 10 - (2.75 * 0.5 - 0.5), 1e-12);  // the continuing child has a base radius of 0.5
  const Contact contact = made.tree.get<Contact>(sum.children[1]);
  EXPECT_EQ(contact.lip, 2);
  ASSERT_EQ(contact.children.size(), 2u);
  const Cone axis = made.tree.get<Cone>(contact.children[0]);
  const Cone lateral = made.tree.get<Cone>(contact.children[1]);
  EXPECT_EQ(axis.base, Vec3(0, 0, 10));
  const Vec3 along(std::sin(degrees(50)), 0, std::cos(degrees(50)));
  EXPECT_LT(glm::distance(lateral.base, Vec3(0, 0, 10) + 0.2 * along), 1e-12);
  EXPECT_LT(glm::distance(lateral.tip, Vec3(0, 0, 10) + 10.0 * along), 1e-12);
  EXPECT_NEAR(made.tree.attributes(contact.children[1]).v_begin, 10.2, 1e-12);
}

TEST(GalbraithProfile, AnInternodeKeepsTheBaseRadiusThatItWasGiven) {
  Skeleton s;  // cylinders of falling width, with a short one that conditioning merges
  s.nodes = {node_at({0, 0, 0}, 0.5, -1), node_at({0, 0, 10}, 0.5, 0), node_at({0, 0, 10.5}, 0.4, 1), node_at({0, 0, 20}, 0.3, 2)};
  s.nodes[1].base_radius = 0.5;
  s.nodes[2].base_radius = 0.4;
  s.nodes[3].base_radius = 0.3;
  const Surfaced made = surface(s, galbraith());
  const Sum sum = made.tree.get<Sum>(made.tree.root());
  const Cone b = made.tree.get<Cone>(sum.children[1]);
  EXPECT_NEAR(b.base.z, 10, 1e-9);
  EXPECT_EQ(b.radius_base, 0.4);
  EXPECT_EQ(b.radius_tip, 0.3);
}

TEST(GalbraithProfile, WithoutRidgesEverythingIsSummed) {
  SurfaceOptions options = galbraith();
  options.ridges = false;
  const Surfaced made = surface(fork_tree(0.5, 0.3, 50, 10), options);
  EXPECT_EQ(std::get<Sum>(made.tree.node(made.tree.root())).children.size(), 3u);
}

TEST(GalbraithProfile, AnInternodeShorterThanItsDeltasStaysLegal) {
  Skeleton s = fork_tree(1, 1, 50, 10);
  s.nodes[1].position.z = 1;  // delta is 1.75
  SurfaceOptions options = galbraith();
  options.conditioning.enabled = false;
  const Surfaced made = surface(s, options);
  const Sum sum = made.tree.get<Sum>(made.tree.root());
  const Cone a = made.tree.get<Cone>(sum.children[0]);
  EXPECT_GT(a.tip.z, 0);
  EXPECT_LT(a.tip.z, 0.01);
  EXPECT_EQ(made.report.notes.size(), 1u);
}

TEST(GalbraithProfile, ABendWrapsOneInternodeInThePlaneOfItAndItsParent) {
  SurfaceOptions options = galbraith();
  options.bend = {degrees(20)};
  const Surfaced made = surface(fork_tree(0.5, 0.3, 50, 10), options);
  const Sum sum = made.tree.get<Sum>(made.tree.root());
  EXPECT_TRUE(std::holds_alternative<Cone>(made.tree.node(sum.children[0])));
  const Contact contact = made.tree.get<Contact>(sum.children[1]);
  EXPECT_TRUE(std::holds_alternative<Cone>(made.tree.node(contact.children[0])));  // in line: not bent
  const Bend bend = made.tree.get<Bend>(contact.children[1]);
  const Vec3 along(std::sin(degrees(50)), 0, std::cos(degrees(50)));
  EXPECT_EQ(bend.from, Vec3(0, 0, 10));
  EXPECT_LT(glm::distance(bend.to, Vec3(0, 0, 10) + 10.0 * along), 1e-12);
  EXPECT_NEAR(bend.angle, degrees(20), 1e-12);
  EXPECT_LT(glm::distance(bend.direction, Vec3(along.z, 0, -along.x)), 1e-12);
  const Cone cone = made.tree.get<Cone>(bend.child);
  const double arc = 10 / (2 * std::sin(degrees(10))) * degrees(20);
  EXPECT_LT(glm::distance(cone.tip, Vec3(0, 0, 10) + arc * along), 1e-9);
  const Field field(made.tree);
  EXPECT_NEAR(field.value(bend.to + 0.3 * bend.direction), kIso, 0.02);
}

TEST(GalbraithProfile, ABendThatIsTooStrongForItsThicknessIsWeakened) {
  Skeleton s = fork_tree(0.5, 0.5, 80, 2);
  SurfaceOptions options = galbraith();
  options.bend = {degrees(140)};
  const Surfaced made = surface(s, options);
  EXPECT_NO_THROW(Field{made.tree});
  EXPECT_FALSE(made.report.notes.empty());
}

TEST(GalbraithProfile, AZigZagOfAHundredThousandInternodesIsBuiltWithoutRecursion) {
  SurfaceOptions options = galbraith();
  options.bend = {degrees(10)};
  const Surfaced made = surface(zigzag(100001, 1, 0.3, 0.05), options);
  EXPECT_EQ(made.report.internodes, 100000u);
  EXPECT_GT(made.tree.size(), 200000u);
}

TEST(GalbraithProfile, ASingleNodeIsASphere) {
  Skeleton s;
  s.nodes.push_back(node_at({1, 2, 3}, 0.5, -1));
  const Surfaced made = surface(s, galbraith());
  EXPECT_EQ(std::get<Sphere>(made.tree.node(made.tree.root())).center, Vec3(1, 2, 3));
}

TEST(GalbraithProfile, LateralsAtTheFirstNodeOfALateralStandWhereItStands) {
  Skeleton s = fork_tree(0.5, 0.3, 50, 10);
  s.nodes.push_back(node_at({0, 5, 10}, 0.2, 1));
  s.nodes.push_back(node_at({0, -5, 10}, 0.2, 0));
  const Surfaced made = surface(s, galbraith());
  EXPECT_EQ(made.report.axes, 4u);
  const Contact base = made.tree.get<Contact>(made.tree.root());  // the root bears two
  EXPECT_EQ(base.children.size(), 2u);
}

}  // namespace
}  // namespace cambium
