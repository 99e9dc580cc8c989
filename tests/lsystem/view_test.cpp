#include "lsystem/view.h"

#include <gtest/gtest.h>

#include <filesystem>
#include <fstream>

#include "grammar.h"
#include "small_surface.h"

namespace cambium {
namespace {

class ViewBeside : public testing::Test {
 protected:
  void SetUp() override { std::filesystem::create_directories(folder_); }
  void TearDown() override { std::filesystem::remove_all(folder_); }
  void write(const std::string& name, const std::string& text) { std::ofstream(folder_ / name) << text; }
  Turtled turtled(const std::string& axiom, const TurtleOptions& options = {}) {
    write("tree.l", test::grammar(axiom, ""));
    const LSystem system = LSystem::load(folder_ / "tree.l");
    return interpret(test::derived(system, 0), system, options, {}).value();
  }
  void write_surface(const std::string& name) { write(name, test::surface_header() + test::surface_patch()); }

  const std::filesystem::path folder_ =
      std::filesystem::temp_directory_path() /
      (std::string("cambium_view_") + testing::UnitTest::GetInstance()->current_test_info()->name());
};

TEST_F(ViewBeside, SetsWhatTheOptionsLeaveOpen) {
  write("tree.v",
        "angle factor: 12\ninitial line width: 0.5\nline width increment: 0.1\ninitial color: 7\ncolor increment: 3\n"
        "tropism direction: 1,0,0\ninitial elasticity: 0.5\nviewpoint: 0,0,1\n");
  const Turtled viewed = turtled("F!F##+F;@O");
  EXPECT_EQ(viewed.skeleton.nodes[1].radius, 0.25);
  EXPECT_NEAR(viewed.skeleton.nodes[2].radius, 0.2, 1e-15);
  EXPECT_NEAR(viewed.last_width, 0.6, 1e-15);
  EXPECT_GT(viewed.skeleton.nodes[2].position.x, 0.1);  // bent towards x
  EXPECT_EQ(viewed.foliage.organs[0].color, 10u);
  EXPECT_EQ(viewed.skipped.at("lines of tree.v"), 1u);
  TurtleOptions options;
  options.angle = M_PI / 2;
  options.width = 2;
  options.width_factor = 0.5;
  options.elasticity = 0;
  const Turtled told = turtled("F!F+F", options);
  EXPECT_EQ(told.skeleton.nodes[1].radius, 1);
  EXPECT_EQ(told.skeleton.nodes[2].radius, 0.5);
  EXPECT_NEAR(told.skeleton.nodes[3].position.x, -1, 1e-12);
}

TEST_F(ViewBeside, ElasticityStepsAreTheViews) {
  write("tree.v", "tropism: T: 1 0 0 S: 0.25\n");
  const double up = turtled("@Ti(1)F F").skeleton.nodes.back().position.x;
  EXPECT_GT(up, 0.2);
  EXPECT_EQ(turtled("@Ti(1)@Td(1)FF").skeleton.nodes.back().position.x, 0);
  EXPECT_EQ(turtled("@Ti(1,0.25)FF").skeleton.nodes.back().position.x, up);
}

TEST_F(ViewBeside, SurfacesAreShapesAndMoveTheTurtle) {
  write("tree.view", "surface: l Leaf.s 2\nsurface: k leaf.s 4\nsurface: z gone.s 1\n");
  write_surface("leaf.s");
  const Turtled result = turtled("~l~l(3)[+(90)~k(0.5)]F~z");
  ASSERT_EQ(result.foliage.shapes.size(), 3u);
  EXPECT_EQ(result.foliage.shapes[0].triangles.size(), 128u);
  ASSERT_EQ(result.foliage.organs.size(), 4u);
  EXPECT_EQ(result.foliage.organs[1].position, Vec3(0, 0, 1));
  EXPECT_EQ(result.foliage.organs[1].scale, 3);
  EXPECT_EQ(result.foliage.organs[2].position, Vec3(0, 0, 4));
  EXPECT_EQ(result.skeleton.nodes[0].position, Vec3(0, 0, 4));
  EXPECT_TRUE(result.foliage.shapes[2].triangles.empty());
  EXPECT_EQ(result.skipped.at("gone.s, which is not there"), 1u);
}

TEST_F(ViewBeside, StretchedSurfacesAreShapesOfTheirOwn) {
  write("tree.v", "surface: l leaf.s 2\n");
  write_surface("leaf.s");
  const Foliage foliage = turtled("[~l(1,2,1)][~l(2,4,2)][~l(-1)][~l(0)]").foliage;
  ASSERT_EQ(foliage.shapes.size(), 2u);
  ASSERT_EQ(foliage.organs.size(), 3u);
  EXPECT_EQ(foliage.organs[1].scale, 4);
  Box bounds;
  for (const Vec3& v : foliage.shapes[0].vertices) bounds.extend(v);
  EXPECT_LT(glm::length(bounds.size() - Vec3(0.5, 1, 0)), 1e-9);
  EXPECT_EQ(foliage.organs[2].scale, 1);
}

TEST_F(ViewBeside, ContoursSayHowThickACylinderIs) {
  write("tree.v", "contour: 2 square.con\n");
  write("square.con", "cver 1 1\nname: q\npoints: 4 12\ntype: closed\n-1 -1 0 3\n1 -1 0 3\n1 1 0 3\n-1 1 0 3\n");
  const double whole = std::sqrt(4 / M_PI);
  EXPECT_NEAR(turtled("!(2)@#(2)@Gsf@Ge").skeleton.nodes[1].radius, whole, 1e-12);
  EXPECT_EQ(turtled("!(2)@#(2)@#@Gsf@Ge").skeleton.nodes[1].radius, 1);
  EXPECT_EQ(turtled("!(2)@#(2)F").skeleton.nodes[1].radius, 1);  // lines are round
  EXPECT_EQ(turtled("@#(3)").skipped.at("@#"), 1u);
}

TEST_F(ViewBeside, FilesThatNothingAsksForAreNotRead) {
  write("tree.v", "surface: l leaf.s 2\ncontour: 1 leaf.s\n");
  write("leaf.s", "?");
  EXPECT_EQ(turtled("F~k").skipped.size(), 0u);
  EXPECT_THROW(turtled("F~l"), InputError);
  EXPECT_THROW(turtled("F@#(1)"), InputError);
}

TEST_F(ViewBeside, TheOnlyViewOfTheFolderCountsUnlessItIsAnothers) {
  write("scene.v", "initial line width: 0.5\n");
  EXPECT_EQ(turtled("F").skeleton.nodes[0].radius, 0.25);
  write("scene.l", "");
  EXPECT_EQ(turtled("F").skeleton.nodes[0].radius, 0.05);
  write("tree.view", "initial line width: 3\n");
  EXPECT_EQ(turtled("F").skeleton.nodes[0].radius, 1.5);
}

TEST_F(ViewBeside, MistakesAreRefusedInTheFileThatHasThem) {
  write("tree.v", "angle factor: none\n");
  try {
    turtled("F");
    ADD_FAILURE();
  } catch (const InputError& error) {
    EXPECT_EQ(error.location().file, (folder_ / "tree.v").string());
    EXPECT_EQ(error.location().column, 15);
  }
}

}  // namespace
}  // namespace cambium
