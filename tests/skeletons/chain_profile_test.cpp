#include "skeletons/surface.h"

#include "small_trees.h"

#include <gtest/gtest.h>

namespace cambium {
namespace {

Fork root_fork(const BlobTree& tree) { return tree.get<Fork>(tree.root()); }

TEST(ChainProfile, AnAxisWithoutLateralsIsABareChain) {
  Skeleton s;
  for (int i = 0; i < 4; ++i) s.nodes.push_back(node_at({0, 0, 2.0 * i}, 0.3 - 0.05 * i, i - 1));
  const Surfaced made = surface(s, {});
  const Chain chain = made.tree.get<Chain>(made.tree.root());
  ASSERT_EQ(chain.nodes.size(), 4u);
  EXPECT_EQ(chain.nodes[2].position, Vec3(0, 0, 4));
  EXPECT_EQ(chain.nodes[2].radius, 0.3 - 0.05 * 2);
}

TEST(ChainProfile, AForkHasTheNumbersOfTheSpecification) {
  const double r = 0.3, axis_radius = 0.5, h = 10, a = degrees(50);
  SurfaceOptions options;
  options.width = 0.4;
  options.lip = 1.5;
  const Surfaced made = surface(fork_tree(axis_radius, r, 50, h), options);
  const Fork fork = root_fork(made.tree);
  EXPECT_EQ(fork.width, 0.4);
  EXPECT_EQ(fork.lip, 1.5);
  ASSERT_EQ(fork.laterals.size(), 1u);
  const Lateral& lateral = fork.laterals[0];
  EXPECT_EQ(lateral.point, Vec3(0, 0, h));
  EXPECT_DOUBLE_EQ(lateral.softness, 0.6 * r);
  EXPECT_DOUBLE_EQ(lateral.reach, 2 * (axis_radius + r));
  EXPECT_LT(glm::distance(lateral.direction, Vec3(-std::cos(a), 0, std::sin(a))), 1e-12);
  const Chain chain = made.tree.get<Chain>(lateral.child);
  const double delta = 2.2016634851 * r - axis_radius;
  EXPECT_LT(glm::distance(chain.nodes[0].position, Vec3(0, 0, h) + delta * Vec3(std::sin(a), 0, std::cos(a))), 1e-9);
  EXPECT_DOUBLE_EQ(chain.nodes[0].radius, r);
}

TEST(ChainProfile, AThinLateralStartsOnTheAxis) {
  const Surfaced made = surface(fork_tree(0.5, 0.2, 50, 10), {});
  const Chain chain = made.tree.get<Chain>(root_fork(made.tree).laterals[0].child);
  EXPECT_EQ(chain.nodes[0].position, Vec3(0, 0, 10));
}

/// Between the two segments of a corner, along the tangent that is halfway between them.
TEST(ChainProfile, ALateralStillTouchesAParentThatBendsAway) {
  Skeleton s;
  s.nodes.push_back(node_at({0, 0, 0}, 0.1, -1));
  s.nodes.push_back(node_at({0, 0, 3}, 0.1, 0));
  s.nodes.push_back(node_at({3, 0, 3}, 0.1, 1));
  s.nodes.push_back(node_at({0.9, 0, 3.9}, 0.095, 1));   // a little thinner: the axis goes on in the one before
  SurfaceOptions options;
  options.conditioning.enabled = false;
  const Surfaced made = surface(s, options);
  const Chain lateral = made.tree.get<Chain>(root_fork(made.tree).laterals[0].child);
  const double from_axis = lateral.nodes[0].position.z - 3;   // which goes on level there
  EXPECT_LE(from_axis, 0.1 + 0.095);
  EXPECT_NEAR(from_axis, 1.75 * 0.095 - 0.1, 1e-9);
}

TEST(ChainProfile, LateralsAtOnePointShareTheForkOfTheirAxis) {
  Skeleton s = fork_tree(0.5, 0.2, 50, 10);
  s.nodes.push_back(node_at({-8, 0, 15}, 0.2, 1));
  s.nodes.push_back(node_at({0, 8, 25}, 0.2, 2));
  s.nodes.push_back(node_at({0, 0, 30}, 0.5, 2));
  const Surfaced made = surface(s, {});
  EXPECT_EQ(root_fork(made.tree).laterals.size(), 3u);
  EXPECT_EQ(made.report.axes, 4u);
}

TEST(ChainProfile, WithoutRidgesThereAreOnlySums) {
  SurfaceOptions options;
  options.ridges = false;
  const Surfaced made = surface(fork_tree(0.5, 0.2, 50, 10), options);
  EXPECT_EQ(std::get<Sum>(made.tree.node(made.tree.root())).children.size(), 2u);
}

TEST(ChainProfile, SeveralRootsAreSummed) {
  Skeleton s = fork_tree(0.5, 0.2, 50, 10);
  s.nodes.push_back(node_at({50, 0, 0}, 0.2, -1));
  s.nodes.push_back(node_at({50, 0, 5}, 0.2, 4));
  const Surfaced made = surface(s, {});
  EXPECT_EQ(std::get<Sum>(made.tree.node(made.tree.root())).children.size(), 2u);
  EXPECT_EQ(made.report.roots, 2u);
}

TEST(ChainProfile, ALateralShorterThanDeltaBecomesAStubThatStaysOffTheFarSide) {
  Skeleton s = fork_tree(0.5, 0.5, 90, 10);
  s.nodes[3].position = {0.55, 0, 10};  // delta is 0.6
  const Surfaced made = surface(s, {});
  const Chain stub = made.tree.get<Chain>(root_fork(made.tree).laterals[0].child);
  ASSERT_EQ(stub.nodes.size(), 1u);
  EXPECT_NEAR(kSupportPerRadius * stub.nodes[0].radius, 0.5 + 0.55, 1e-9);
  EXPECT_EQ(made.report.notes.size(), 1u);
}

TEST(ChainProfile, ABuriedLateralIsLeftOut) {
  Skeleton s = fork_tree(0.5, 0.01, 90, 10);
  s.nodes[3].position = {0.3, 0, 10};
  const Surfaced made = surface(s, {});
  EXPECT_TRUE(std::holds_alternative<Chain>(made.tree.node(made.tree.root())));
}

TEST(ChainProfile, BendsArePutIntoTheNodesAndKeepTheEnds) {
  SurfaceOptions options;
  options.bend = {0, degrees(30)};
  const Surfaced made = surface(fork_tree(0.5, 0.2, 50, 10), options);
  const Chain chain = made.tree.get<Chain>(root_fork(made.tree).laterals[0].child);
  const Vec3 tip = Vec3(0, 0, 10) + 10.0 * Vec3(std::sin(degrees(50)), 0, std::cos(degrees(50)));
  ASSERT_EQ(chain.nodes.size(), 7u);
  EXPECT_EQ(chain.nodes.front().position, Vec3(0, 0, 10));
  EXPECT_LT(glm::distance(chain.nodes.back().position, tip), 1e-12);
  const Vec3 middle = chain.nodes[3].position - 0.5 * (tip + Vec3(0, 0, 10));
  EXPECT_NEAR(glm::length(middle), 5 * std::tan(degrees(7.5)), 1e-9);  // the sagitta of the arc
  EXPECT_LT(middle.z, 0);                                             // away from the parent axis
}

TEST(ChainProfile, CarriesBranchOrderAndMetresFromTheRoot) {
  const double r = 0.3, h = 10;
  const Surfaced made = surface(fork_tree(0.5, r, 50, h), {});
  const Fork fork = root_fork(made.tree);
  const Attributes& trunk = made.tree.attributes(fork.axis);
  const Attributes& lateral = made.tree.attributes(fork.laterals[0].child);
  EXPECT_EQ(trunk.branch, 0u);
  EXPECT_EQ(trunk.order, 0u);
  EXPECT_EQ(trunk.v_begin, 0);
  EXPECT_EQ(lateral.branch, 1u);
  EXPECT_EQ(lateral.order, 1u);
  EXPECT_NEAR(lateral.v_begin, h + 2.2016634851 * r - 0.5, 1e-9);
  const Vec3 along(std::sin(degrees(50)), 0, std::cos(degrees(50)));
  EXPECT_NEAR(glm::length(lateral.u_direction), 1, 1e-12);
  EXPECT_NEAR(glm::dot(lateral.u_direction, along), 0, 1e-12);
}

TEST(ChainProfile, AnAxisOfManyNodesAndAHundredThousandLateralsIsBuilt) {
  constexpr int kNodes = 200000;
  Skeleton s;
  for (int i = 0; i < kNodes; ++i) s.nodes.push_back(node_at({std::sin(0.01 * i), 0, 0.05 * i}, 0.05, i - 1));
  for (int i = 0; i < kNodes; i += 2) s.nodes.push_back(node_at({1 + std::sin(0.01 * i), 1, 0.05 * i}, 0.01, i));
  const Surfaced made = surface(s, {});
  EXPECT_EQ(made.report.axes, 1u + kNodes / 2);
  EXPECT_EQ(root_fork(made.tree).laterals.size(), static_cast<std::size_t>(kNodes / 2));
}

TEST(ChainProfile, TwigsOnTwigsAHundredThousandOrdersDeepAreBuilt) {
  Skeleton s;
  s.nodes.push_back(node_at({0, 0, 0}, 0.1, -1));
  for (int i = 0; i < 100000; ++i) {  // every twig a lateral of the last, beside a thicker shoot that goes on
    const auto from = static_cast<std::int32_t>(s.nodes.size()) - 1;
    s.nodes.push_back(node_at({i % 2 ? 0.0 : 1.0, 1, i + 1.0}, 0.1, from));
    s.nodes.back().lateral = true;
    s.nodes.push_back(node_at({0, -1, i + 1.0}, 0.1, from));
    s.nodes.back().lateral = false;
    std::swap(s.nodes[s.nodes.size() - 1], s.nodes[s.nodes.size() - 2]);
  }
  const Surfaced made = surface(s, {});
  EXPECT_EQ(made.report.max_order, 100000u);
}

}  // namespace
}  // namespace cambium
