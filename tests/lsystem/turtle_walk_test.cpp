// Organs, as the walk over a string places them. What it draws is tested with interpret().
#include "lsystem/turtle_walk.h"

#include <gtest/gtest.h>

#include "grammar.h"

namespace cambium {
namespace {

using test::turtled;

const char* const kBushLeaf = "[^^{-f+f+f-|-f+f+f}]";  // ABOP 1.25, at 22.5 degrees

TurtleOptions bush_options() {
  TurtleOptions options;
  options.angle = M_PI / 8;
  return options;
}

/// Corners of organ i in the world.
std::vector<Vec3> corners_of(const Foliage& foliage, std::size_t i) {
  const OrganPlacement& at = foliage.organs[i];
  std::vector<Vec3> out;
  for (const Vec3& p : foliage.shapes[at.shape].vertices)
    out.push_back(at.position + at.scale * (p.x * at.left + p.y * at.heading + p.z * at.up));
  return out;
}

void expect_corners(const std::string& axiom, const std::vector<Vec3>& expected) {
  const Foliage foliage = turtled(axiom).foliage;
  ASSERT_EQ(foliage.organs.size(), 1u) << axiom;
  const std::vector<Vec3> corners = corners_of(foliage, 0);
  ASSERT_EQ(corners.size(), expected.size()) << axiom;
  for (std::size_t i = 0; i < expected.size(); ++i)
    EXPECT_LT(glm::length(corners[i] - expected[i]), 1e-12) << axiom << ": corner " << i;
}

TEST(TurtleWalk, BracesEncloseAnOutline) {
  expect_corners("{.F+f-F}", {{0, 0, 0}, {0, 0, 1}, {-1, 0, 1}, {-1, 0, 2}});  // F and f end in corners
  expect_corners("{.G.+g.}", {{0, 0, 0}, {0, 0, 1}, {-1, 0, 1}});              // G and g do not
  expect_corners("f(5)&{.F+F}", {{0, 0, 5}, {0, 1, 5}, {-1, 1, 5}});           // in the frame of the {
}

// ABOP section 5.1.
TEST(TurtleWalk, BracketsInsideBracesShareTheOutline) {
  expect_corners("{[++(90)G.][G.]+(90)[G(2).]}", {{0, 0, -1}, {0, 0, 1}, {-2, 0, 0}});
}

TEST(TurtleWalk, OutlinesMayStandInOutlines) {
  const Foliage foliage = turtled("{.F[{.F+(120)F}]+F}").foliage;
  ASSERT_EQ(foliage.organs.size(), 2u);
  EXPECT_EQ(corners_of(foliage, 0)[0], Vec3(0, 0, 1));  // the inner one is closed first
  EXPECT_EQ(corners_of(foliage, 1).size(), 3u);
}

TEST(TurtleWalk, AnOpenOutlineEndsWithItsBranch) {
  const Turtled result = turtled("[{.F]F{.f{F");
  EXPECT_EQ(result.skipped.at("{"), 3u);
  EXPECT_EQ(result.skeleton.nodes.size(), 2u);
  EXPECT_TRUE(result.foliage.organs.empty());
}

TEST(TurtleWalk, OutlinesAreNotNestedWithoutEnd) {
  const LSystem system = test::parsed(test::grammar("A", "A --> AA\nhomomorphism\nA --> {"));
  EXPECT_EQ(interpret(test::derived(system, 16), system, {}, {})->skipped.at("{"), 65536u);
  EXPECT_THROW(interpret(test::derived(system, 17), system, {}, {}), InputError);
}

TEST(TurtleWalk, OutlinesWithoutAnAreaAreLeftOut) { EXPECT_EQ(turtled("{}{.}{.F|F}}").skipped.at("}"), 4u); }

TEST(TurtleWalk, LeavesOfTheBushAreOneShape) {
  std::string axiom;
  for (int i = 0; i < 50; ++i) axiom += std::string("F/(50)!(") + std::to_string(1.0 / (i + 1)) + ")'" + kBushLeaf + "+&";
  const Turtled result = turtled(axiom, bush_options());
  ASSERT_EQ(result.foliage.shapes.size(), 1u);
  EXPECT_EQ(result.foliage.shapes[0].vertices.size(), 6u);
  EXPECT_EQ(result.foliage.shapes[0].triangles.size(), 4u);
  ASSERT_EQ(result.foliage.organs.size(), 50u);
  for (std::size_t i = 0; i < 50; ++i) {
    const OrganPlacement& leaf = result.foliage.organs[i];
    EXPECT_EQ(leaf.node, static_cast<std::int32_t>(i + 1));
    EXPECT_EQ(leaf.color, i + 1);
    EXPECT_EQ(leaf.position, result.skeleton.nodes[i + 1].position);
    EXPECT_NEAR(leaf.scale, result.foliage.organs[0].scale, 1e-12);
    EXPECT_LT(glm::length(glm::cross(leaf.left, leaf.heading) - leaf.up), 1e-12);
  }
}

TEST(TurtleWalk, LeavesOfAnotherSizeAreTheSameShape) {
  const Foliage foliage = turtled("[{f+(80)f+(80)f}]?(1,0.25)[{f+(80)f+(80)f}]$[{f(3)+(80)f(3)+(80)f(3)}]").foliage;
  ASSERT_EQ(foliage.shapes.size(), 1u);
  EXPECT_NEAR(foliage.organs[1].scale, 0.25 * foliage.organs[0].scale, 1e-12);
  EXPECT_NEAR(foliage.organs[2].scale, 3 * foliage.organs[0].scale, 1e-12);
}

TEST(TurtleWalk, SurfacesAreNamedByTheLetterBehindTheTilde) {
  const Turtled result = turtled("~a F~b(0.5)[+~a(2)]");
  ASSERT_EQ(result.foliage.shapes.size(), 2u);
  EXPECT_EQ(result.foliage.shapes[0].name, "a");
  EXPECT_EQ(result.foliage.shapes[1].name, "b");
  ASSERT_EQ(result.foliage.organs.size(), 3u);
  EXPECT_EQ(result.foliage.organs[0].scale, 1);
  EXPECT_EQ(result.foliage.organs[0].node, -1);
  EXPECT_EQ(result.foliage.organs[1].scale, 0.5);
  EXPECT_EQ(result.foliage.organs[1].node, 1);
  EXPECT_EQ(result.foliage.organs[2].scale, 2);
  EXPECT_LT(glm::length(result.foliage.organs[2].heading - Vec3(-1, 0, 0)), 1e-12);
  EXPECT_TRUE(result.skipped.empty());
}

TEST(TurtleWalk, SpheresAndDiscsAreAsWideAsTheLineUnlessTold) {
  TurtleOptions options;
  options.width_unit = 0.01;
  const Foliage foliage = turtled("!(3)F@O@O(2)@o@c(5)", options).foliage;
  ASSERT_EQ(foliage.shapes.size(), 2u);
  ASSERT_EQ(foliage.organs.size(), 4u);
  EXPECT_NEAR(foliage.organs[0].scale, 0.03, 1e-15);
  EXPECT_EQ(foliage.organs[1].scale, 2);
  EXPECT_NEAR(foliage.organs[2].scale, 0.03, 1e-15);
  EXPECT_EQ(foliage.organs[3].scale, 5);
}

TEST(TurtleWalk, ColoursGoRoundAndBracketsRestoreThem) {
  const Foliage foliage = turtled(";@O[;(250);;@O'(3)'@O],,@O;(-1)@O").foliage;
  ASSERT_EQ(foliage.organs.size(), 5u);
  const std::uint32_t colors[] = {1, 252, 4, 255, 255};
  for (std::size_t i = 0; i < 5; ++i) EXPECT_EQ(foliage.organs[i].color, colors[i]) << i;
}

}  // namespace
}  // namespace cambium
