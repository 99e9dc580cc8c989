#include "lsystem/view_file.h"

#include <gtest/gtest.h>

#include <cmath>

namespace cambium {
namespace {

ViewFile read(const std::string& text) { return read_view_file(text, "folder/plant.v"); }

TEST(ViewFile, TellsOfThePlantAndNotOfThePicture) {
  const ViewFile view = read(
      "angle factor: 40\ninitial color: 72\ncolor increment: 2\ninitial line width: 0.20\nline width increment: 0.02\n"
      "viewpoint: -1,0,30\nz buffer: on\nline style: cylinder\n\nlight: V:5.0 6.0 10.0\n/* nothing */\n"
      "surface: p petal.s 2 6 6\nsurface: l leaf.s 6\ncontour: 1 SEPAL.con\nfunction set: functions.fset\nfunction: a.func "
      "100\n");
  EXPECT_NEAR(view.settings.angle.value(), M_PI / 20, 1e-15);
  EXPECT_EQ(view.settings.color, 72u);
  EXPECT_EQ(view.settings.color_increment, 2u);
  EXPECT_EQ(view.settings.width, 0.2);
  EXPECT_EQ(view.settings.width_increment, 0.02);
  EXPECT_FALSE(view.settings.tropism);
  EXPECT_EQ(view.unread_lines, 3u);
  ASSERT_EQ(view.surfaces.size(), 2u);
  EXPECT_EQ(view.surfaces[0].name, "p");
  EXPECT_EQ(view.surfaces[0].file, "folder/petal.s");
  EXPECT_EQ(view.surfaces[0].size, 2);
  EXPECT_EQ(view.surfaces[1].place.line, 13);
  EXPECT_EQ(view.surfaces[1].place.column, 12);
  ASSERT_EQ(view.contours.size(), 1u);
  EXPECT_EQ(view.contours[0].number, 1u);
  EXPECT_EQ(view.contours[0].file, "folder/SEPAL.con");
  ASSERT_EQ(view.functions.size(), 2u);
  EXPECT_EQ(view.functions[1].file, "folder/a.func");
}

TEST(ViewFile, DirectionsAreTurnedToZUp) {
  EXPECT_EQ(read("tropism direction: 0.0,1.0,0.0\n").settings.tropism, Vec3(0, 0, 1));
  EXPECT_EQ(read("tropism direction: 0,0,-2\n").settings.tropism, Vec3(0, 1, 0));
}

TEST(ViewFile, TropismLinesHaveAnIntensityAndAnElasticity) {
  const ViewFile view = read("tropism: T: 0.0 -3.0 0.0 I: 0.5 E: 0.25 S:0.125\ntropism: T: 1 0 0 A:90\ntorque: T: 0 1 0\n");
  EXPECT_EQ(view.settings.tropism, Vec3(0, 0, -0.5));
  EXPECT_EQ(view.settings.elasticity, 0.25);
  EXPECT_EQ(view.settings.elasticity_increment, 0.125);
  EXPECT_EQ(view.unread_lines, 2u);
  const ViewFile old = read("initial elasticity: -0.1\nelasticity increment: 0.2\n");
  EXPECT_EQ(old.settings.elasticity, -0.1);
  EXPECT_EQ(old.settings.elasticity_increment, 0.2);
}

TEST(ViewFile, WidthsInPixelsAreNotOfThePlant) {
  EXPECT_FALSE(read("initial line width: 3 pixels\n").settings.width);
  EXPECT_FALSE(read("initial line width: 3\nline style: pixel\n").settings.width);
  EXPECT_EQ(read("initial line width: 3 pixels\nline style: polygon\n").settings.width, 3);
  EXPECT_FALSE(read("initial line width: 0\n").settings.width);
}

TEST(ViewFile, GoesThroughThePreprocessor) {
  EXPECT_NEAR(read("#define PARTS 8\nangle factor: PARTS // of a turn\n").settings.angle.value(), M_PI / 4, 1e-15);
}

TEST(ViewFile, StepsOfColourMayGoDown) {
  EXPECT_EQ(read("color increment: -1\n").settings.color_increment, 255u);
  EXPECT_EQ(read("color increment: 1e300\n").settings.color_increment, 0u);
}

TEST(ViewFile, MistakesAreRefusedWhereTheyStand) {
  struct Mistake {
    const char* text;
    int line, column;
    const char* expected;
  };
  const Mistake mistakes[] = {
      {"angle factor: 0\n", 1, 15, "parts of a turn above 0"},
      {"\nangle increment: wide\n", 2, 18, "an angle in degrees"},
      {"initial color: red\n", 1, 16, "a colour"},
      {"initial color: -1\n", 1, 16, "a colour, a whole number from 0 to 65535"},
      {"initial line width:\n", 1, 20, "a line width"},
      {"tropism direction: 0,0,0\n", 1, 20, "a direction x,y,z"},
      {"tropism direction: 0,0\n", 1, 23, "a direction x,y,z"},
      {"tropism: T: 0 1 0 Q: 3\n", 1, 19, "'T:', 'A:', 'I:', 'E:' or 'S:'"},
      {"tropism: E: 3\n", 1, 14, "'T:' and a direction"},
      {"surface:\n", 1, 9, "the letter of a surface"},
      {"surface: l\n", 1, 11, "the file of a surface"},
      {"surface: l leaf.s\n", 1, 18, "the size of a surface"},
      {"contour: leaf.con\n", 1, 10, "the number of a contour"},
      {"contour: 1\n", 1, 11, "the file of a contour"},
      {"function:\n", 1, 10, "the file of a function"},
      {"angle factor: 4 /* never closed\n", 1, 17, "'*/'"},
  };
  for (const Mistake& mistake : mistakes) try {
      read(mistake.text);
      ADD_FAILURE() << mistake.text;
    } catch (const InputError& error) {
      EXPECT_EQ(error.location().file, "folder/plant.v");
      EXPECT_EQ(error.location().line, mistake.line) << mistake.text;
      EXPECT_EQ(error.location().column, mistake.column) << mistake.text;
      EXPECT_EQ(error.expected(), mistake.expected) << mistake.text;
    }
}

}  // namespace
}  // namespace cambium
