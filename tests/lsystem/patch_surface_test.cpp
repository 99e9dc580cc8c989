#include "lsystem/patch_surface.h"

#include <gtest/gtest.h>

#include "blobtree/input_error.h"
#include "small_surface.h"

namespace cambium {
namespace {

using test::surface_header;
using test::surface_patch;

PatchSurface read(const std::string& text, double size = 1) { return read_patch_surface(text, "leaf.s", "l", size); }

double area_of(const OrganShape& shape) {
  double area = 0;
  for (const auto& [a, b, c] : shape.triangles)
    area += 0.5 * glm::length(glm::cross(shape.vertices[b] - shape.vertices[a], shape.vertices[c] - shape.vertices[a]));
  return area;
}

TEST(PatchSurface, IsHeldAtItsContactPointAndGrowsAlongItsHeading) {
  const PatchSurface surface = read(surface_header() + surface_patch(), 2);  // half the file's size
  EXPECT_EQ(surface.shape.name, "l");
  EXPECT_EQ(surface.shape.vertices.size(), 81u);
  EXPECT_EQ(surface.shape.triangles.size(), 128u);
  EXPECT_NEAR(area_of(surface.shape), 1, 1e-9);
  Box bounds;
  for (const Vec3& v : surface.shape.vertices) bounds.extend(v);
  EXPECT_LT(glm::length(bounds.lo - Vec3(-0.5, 0, 0)), 1e-9);
  EXPECT_LT(glm::length(bounds.hi - Vec3(0.5, 1, 0)), 1e-9);
  EXPECT_LT(glm::length(surface.end_point - Vec3(0, 1, 0)), 1e-12);
}

// left is heading x up, as the turtle's is.
TEST(PatchSurface, ItsFrameComesToThatOfTheTurtle) {
  const PatchSurface surface =
      read(surface_header("X: 0 Y: 0 Z: 0", "X: 0 Y: 0 Z: 1", "X: 0 Y: 1 Z: 0") + surface_patch(), 4);
  EXPECT_LT(glm::length(surface.shape.vertices[0] - Vec3(1, 1, 1)), 1e-9);  // (-1,1,1): left is -x
  EXPECT_LT(glm::length(surface.end_point - Vec3(0, 1, 1)), 1e-12);
}

TEST(PatchSurface, MayHaveSeveralPatchesAndAPrecision) {
  const std::string header = surface_header();
  const std::size_t second_line = header.find('\n') + 1;
  const std::string precise =
      "VERSION stedit\n" + header.substr(0, second_line) + "PRECISION  S: 5 T: 5\n" + header.substr(second_line);
  EXPECT_EQ(read(precise + surface_patch() + surface_patch()).shape.triangles.size(), 256u);
}

TEST(PatchSurface, PatchesThatEndInAPointHaveNoEmptyTriangles) {
  std::string points;
  for (int row = 0; row < 4; ++row)
    for (int column = 0; column < 4; ++column)
      points += row == 0 ? "0 1 1 " : std::to_string(column - 1.5) + " " + std::to_string(1 - row) + " 1 ";
  EXPECT_EQ(read(surface_header() + surface_patch(points)).shape.triangles.size(), 120u);
}

TEST(PatchSurface, MistakesAreRefusedWhereTheyStand) {
  struct Mistake {
    std::string text;
    int line, column;
    const char* expected;
  };
  const std::string good = surface_header();
  const Mistake mistakes[] = {
      {"", 1, 1, "six numbers of a bounding box"},
      {"1 2 3\nCONTACT", 2, 1, "six numbers of a bounding box"},
      {"1 2 3 4 5 6\nEND", 2, 1, "'CONTACT'"},
      {surface_header("X: 0 Y: Z: 0"), 2, 24, "a coordinate"},
      {surface_header("X: 0 Z: 0"), 2, 21, "'Y:'"},
      {surface_header("X: 0 Y: 0 Z: 0", "X: 0 Y: 0 Z: 0"), 5, 1, "a heading before this"},
      {surface_header("X: 0 Y: 0 Z: 0", "X: 0 Y: 1 Z: 0", "X: 0 Y: 3 Z: 0"), 6, 1,
       "an up vector across the heading before this"},
      {surface_header("X: 0 Y: 0 Z: 0", "X: 0 Y: 1 Z: 0", "X: 0 Y: 0 Z: 1", "0"), 6, 7, "a size above 0"},
      {good, 6, 8, "the name of a patch"},
      {good + "patch\nBOTTOM", 8, 1, "'TOP'"},
      {good + surface_patch("1 2 3 4 5"), 12, 10, "the x, y and z of a control point"},
      {good + surface_patch("1 2 x"), 12, 5, "the x, y and z of a control point"},
      {good + surface_patch("1 2 1e200 4 5"), 12, 11, "a control point within 1e100 sizes of the contact point before this"},
      {good + surface_patch() + "patch", 16, 6, "'TOP'"},
  };
  for (const Mistake& mistake : mistakes) try {
      read(mistake.text);
      ADD_FAILURE() << mistake.text;
    } catch (const InputError& error) {
      EXPECT_EQ(error.location().file, "leaf.s");
      EXPECT_EQ(error.location().line, mistake.line) << mistake.text;
      EXPECT_EQ(error.location().column, mistake.column) << mistake.text;
      EXPECT_EQ(error.expected(), mistake.expected) << mistake.text;
    }
}

}  // namespace
}  // namespace cambium
