#include "grammar.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <atomic>

namespace cambium {
namespace {

using test::turtled;

void expect_tip(const std::string& axiom, const Vec3& tip) {
  const Turtled result = turtled(axiom);
  ASSERT_FALSE(result.skeleton.nodes.empty()) << axiom;
  const Vec3 p = result.skeleton.nodes.back().position;
  EXPECT_LT(glm::length(p - tip), 1e-12) << axiom << ": " << p.x << ' ' << p.y << ' ' << p.z;
}

TEST(Interpret, SymbolsMoveAsTheSpecificationSays) {
  expect_tip("F", {0, 0, 1});
  expect_tip("+(90)F", {-1, 0, 0});
  expect_tip("-(90)F", {1, 0, 0});
  expect_tip("&(90)F", {0, 1, 0});
  expect_tip("^(90)F", {0, -1, 0});
  expect_tip("/(90)+(90)F", {0, 1, 0});
  expect_tip("\\(90)+(90)F", {0, -1, 0});
  expect_tip("|F(2)", {0, 0, -2});
  expect_tip("+F", {-1, 0, 0});  // 90 degrees unless told
  expect_tip("f(3)F(2)", {0, 0, 5});
  expect_tip("G(2)", {0, 0, 2});
  expect_tip("@M(1,2,3)F", {1, 2, 4});
  expect_tip("@R(0,5,0)F", {0, 1, 0});
  expect_tip("/(30)&(60)$-(90)F", {std::cos(30 * M_PI / 180), -std::sin(30 * M_PI / 180), 0});
}

TEST(Interpret, TheDefaultAngleAndStepAreOptions) {
  TurtleOptions options;
  options.angle = M_PI / 6;
  options.step = 2;
  const Vec3 tip = turtled("+F", options).skeleton.nodes.back().position;
  EXPECT_NEAR(tip.x, -1, 1e-12);
  EXPECT_NEAR(tip.z, std::sqrt(3.0), 1e-12);
}

TEST(Interpret, BranchesAreLateralsOfTheNodeTheyLeave) {
  const Skeleton skeleton = turtled("!(2)F[+!(1)FF]F[-F]").skeleton;
  ASSERT_EQ(skeleton.nodes.size(), 6u);
  const std::int32_t parents[] = {-1, 0, 1, 2, 1, 4};
  const double radii[] = {1, 1, 0.5, 0.5, 1, 1};
  for (std::size_t i = 0; i < 6; ++i) {
    EXPECT_EQ(skeleton.nodes[i].parent, parents[i]) << i;
    EXPECT_EQ(skeleton.nodes[i].radius, radii[i]) << i;
    EXPECT_EQ(skeleton.nodes[i].base_radius.value_or(radii[0]), radii[i]) << i;
  }
  EXPECT_FALSE(skeleton.nodes[0].lateral.has_value());
  EXPECT_EQ(skeleton.nodes[1].lateral, false);
  EXPECT_EQ(skeleton.nodes[2].lateral, true);
  EXPECT_EQ(skeleton.nodes[3].lateral, false);
  EXPECT_EQ(skeleton.nodes[4].lateral, false);
  EXPECT_EQ(skeleton.nodes[5].lateral, true);
}

TEST(Interpret, MovingAwayBeginsANewPieceAndComingBackDoesNot) {
  EXPECT_EQ(turtled("Ff(1)F").skeleton.nodes[2].parent, -1);
  const Skeleton back = turtled("Ff(1)|f(1)|F").skeleton;
  ASSERT_EQ(back.nodes.size(), 3u);
  EXPECT_EQ(back.nodes[2].parent, 1);
  EXPECT_EQ(turtled("Ff(0)F").skeleton.nodes.size(), 3u);
}

TEST(Interpret, BranchesThatBeginAtOneStartShareItsNode) {
  const Skeleton skeleton = turtled("[&F][/(120)&F]f(5)[F][+F]").skeleton;
  ASSERT_EQ(skeleton.nodes.size(), 6u);
  EXPECT_EQ(skeleton.nodes[2].parent, 0);
  EXPECT_EQ(skeleton.nodes[2].lateral, true);
  EXPECT_EQ(skeleton.nodes[3].parent, -1);
  EXPECT_EQ(skeleton.nodes[5].parent, 3);
}

TEST(Interpret, RadiiThatRiseTowardsTheTipAreClampedAndCounted) {
  const Turtled result = turtled("!(1)F!(4)FF[+F]");
  EXPECT_EQ(result.radii_clamped, 3u);
  for (const SkeletonNode& node : result.skeleton.nodes) EXPECT_EQ(node.radius, 0.5);
  EXPECT_EQ(result.last_width, 4);
}

TEST(Interpret, WidthsHaveAUnit) {
  TurtleOptions options;
  options.width_unit = 0.01;
  const Turtled result = turtled("!(10)F", options);
  EXPECT_NEAR(result.skeleton.nodes[1].radius, 0.05, 1e-15);
  EXPECT_EQ(result.last_width, 10);
}

TEST(Interpret, WidthWithoutParameterHalvesTheArea) {
  const Skeleton skeleton = turtled("!(2)F!F!F#F").skeleton;
  EXPECT_NEAR(skeleton.nodes[2].radius, std::sqrt(0.5), 1e-15);
  EXPECT_NEAR(skeleton.nodes[3].radius, 0.5, 1e-15);
  EXPECT_NEAR(skeleton.nodes[4].radius, 0.5, 1e-15);  // clamped to its parent's
}

TEST(Interpret, PolygonsMakeNoInternodes) {
  const Turtled result = turtled("F[{.F+F.G.f}]F");
  EXPECT_EQ(result.skeleton.nodes.size(), 3u);
  EXPECT_EQ(result.total_length, 2);
  EXPECT_TRUE(result.skipped.empty());
}

TEST(Interpret, APercentSignCutsTheBranch) {
  EXPECT_EQ(turtled("F[F%F[F]F]F%F").skeleton.nodes.size(), 4u);
}

TEST(Interpret, SymbolsWithoutMeaningAreSkippedAndCounted) {
  const Turtled result = turtled("F@Z(2)Y(1)Y@GrXF(0)@L?P(0,0,0)F");
  const std::map<std::string, std::size_t> expected = {{"@Z", 1}, {"Y", 2}, {"@Gr", 1}, {"X", 1},
                                                       {"F(0)", 1}, {"@L", 1}, {"?P", 1}};
  EXPECT_EQ(result.skipped, expected);
  EXPECT_EQ(result.skeleton.nodes.size(), 3u);
}

TEST(Interpret, ASubLSystemsLengthsAreScaled) {
  const Turtled result = turtled("F?(2,0.5)F?(3,3)F$F$F+(90)$F");
  EXPECT_EQ(result.total_length, 1 + 0.5 + 1.5 + 0.5 + 1 + 1);
  EXPECT_TRUE(result.skipped.empty());
  expect_tip("+(40)/(30)?(2)F$|F", {0, 0, 0});   // a `$` that ends one levels nothing
}

TEST(Interpret, TropismBendsAfterEachSegment) {
  TurtleOptions options;
  options.elasticity = 0.1;
  const Skeleton drooping = turtled("+(90)FFFF", options).skeleton;
  EXPECT_NEAR(drooping.nodes[1].position.z, 0, 1e-12);
  for (std::size_t i = 2; i < 5; ++i) EXPECT_LT(drooping.nodes[i].position.z, drooping.nodes[i - 1].position.z);
  const Skeleton rising = turtled("@Td(0,0,1)@Ts(0.1)+(90)FFFF").skeleton;
  EXPECT_NEAR(rising.nodes[4].position.z, -drooping.nodes[4].position.z, 1e-12);
}

TEST(Interpret, ImpossibleDrawingsAreErrors) {
  EXPECT_THROW(turtled("F(-1)"), InputError);
  EXPECT_THROW(turtled("!(0)F"), InputError);
  EXPECT_THROW(turtled("!(-1)F"), InputError);
  EXPECT_THROW(turtled("F(1e308)"), InputError);
  EXPECT_THROW(turtled("f(1e308)F"), InputError);
}

TEST(Interpret, IsCancelledWithinTheWalkAndWithinTheHomomorphism) {
  std::atomic<bool> cancel{true};
  RunOptions run;
  run.cancel = &cancel;
  for (const std::string tail : {"", "homomorphism\nF --> FF\n"}) {
    const LSystem drawn = test::parsed("lsystem: t\naxiom: F\nF --> F+F\n" + tail + "endlsystem\n");
    ModuleString string = test::derived(drawn, 16);
    EXPECT_FALSE(interpret(string, drawn, {}, run)) << tail;
    cancel = false;
    EXPECT_TRUE(interpret(string, drawn, {}, run)) << tail;
    cancel = true;
  }
}

TEST(Interpret, CancelledQueriesLeaveTheStringAsItWas) {
  std::atomic<bool> cancel{true};
  RunOptions run;
  run.cancel = &cancel;
  const LSystem system = test::parsed(test::grammar("F?P(7,8,9)B", "B --> BB"));  // only a long walk looks at the flag
  ModuleString string = test::derived(system, 14);
  string.parameters = {7, 8, 9};
  EXPECT_FALSE(answer_queries(string, system, {}, run));
  EXPECT_EQ(string.parameters, (std::vector<double>{7, 8, 9}));
  EXPECT_TRUE(answer_queries(string, system, {}, {}));
  EXPECT_EQ(string.parameters, (std::vector<double>{0, 0, 1}));
}

TEST(Interpret, ThePoplarOfTheExamplesIsAPoplar) {
  const LSystem poplar = LSystem::load(CAMBIUM_EXAMPLES "/poplar.l");
  const Turtled result = interpret(derive(poplar, {}, {}).value(), poplar, {}, {}).value();
  const auto& nodes = result.skeleton.nodes;
  EXPECT_GT(nodes.size(), 2000u);
  EXPECT_LT(nodes.size(), 4500u);
  EXPECT_EQ(result.radii_clamped, 0u);
  Box bounds;
  std::vector<int> laterals(nodes.size(), 0);
  double thinnest = kInfinity, lowest = kInfinity;
  for (const SkeletonNode& node : nodes) {
    bounds.extend(node.position);
    thinnest = std::min(thinnest, node.radius);
    if (node.lateral != true) continue;
    ++laterals[static_cast<std::size_t>(node.parent)];
    lowest = std::min(lowest, nodes[static_cast<std::size_t>(node.parent)].position.z);
  }
  EXPECT_EQ(*std::max_element(laterals.begin(), laterals.end()), 1);
  EXPECT_GT(lowest, 1.2);
  EXPECT_GT(bounds.hi.z, 8);
  EXPECT_LT(bounds.hi.z, 10);
  EXPECT_LT(bounds.size().x, 4);
  EXPECT_LT(bounds.size().y, 4);
  EXPECT_EQ(nodes[0].radius, 0.13);
  EXPECT_NEAR(thinnest, 0.0035, 1e-12);
}

}  // namespace
}  // namespace cambium
