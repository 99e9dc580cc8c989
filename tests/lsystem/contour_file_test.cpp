#include "lsystem/contour_file.h"

#include <gtest/gtest.h>

#include <cmath>

#include "blobtree/input_error.h"

namespace cambium {
namespace {

double read(const std::string& text) { return read_contour_radius(text, "stem.con"); }

/// Control points whose B-spline is a circle but for a thousandth.
std::string circle_points(double radius, const char* end) {
  std::string out;
  const double outside = radius * 3 / (2 + std::cos(M_PI / 12));
  for (int i = 0; i < 24; ++i)
    out += std::to_string(outside * std::cos(i * M_PI / 12)) + " " + std::to_string(outside * std::sin(i * M_PI / 12)) + end;
  return out;
}

TEST(ContourFile, ACircleHasItsOwnRadius) {
  EXPECT_NEAR(read("24 2 closed\n" + circle_points(0.7, "\n")), 0.7, 1e-3);
  EXPECT_NEAR(read("24 3 closed\n" + circle_points(0.7, " 0\n")), 0.7, 1e-3);
  const std::string points = circle_points(1, " 0 1\n");
  EXPECT_NEAR(read("cver 1 1\nname: c\npoints: 24 24\ntype: closed\n" + points), 1, 1e-3);
  EXPECT_NEAR(read("cver 1 2\nname: c\npoints: 24 24\ntype: cr\n" + points), 1, 1e-3);
  EXPECT_NEAR(read("cver 1 3\nname: c\npoints: 24 24\ntype: cr\nsamples: 9\nmarkers: 1\n0 0\n" + points), 1, 1e-3);
}

TEST(ContourFile, AreaCountsAndNotShape) {
  const double flat = read("24 2 closed\n" + circle_points(1, "\n"));
  std::string stretched = "24 2 closed\n";
  for (int i = 0; i < 24; ++i)
    stretched += std::to_string(4 * std::cos(i * M_PI / 12)) + " " + std::to_string(std::sin(i * M_PI / 12)) + "\n";
  EXPECT_NEAR(read(stretched) / (2 * flat), 1 / (3 / (2 + std::cos(M_PI / 12))), 1e-3);
}

TEST(ContourFile, RepeatedPointsMakeCorners) {
  // A square whose corners count three times is itself.
  EXPECT_NEAR(read("cver 1 1\nname: q\npoints: 4 12\ntype: closed\n-1 -1 0 3\n1 -1 0 3\n1 1 0 3\n-1 1 0 3\n"),
              std::sqrt(4 / M_PI), 1e-12);
}

TEST(ContourFile, OpenOnesAreClosedByAChordAndFlatOnesAreThin) {
  // Three sides of the square.
  EXPECT_NEAR(read("cver 1 1\nname: q\npoints: 4 12\ntype: open\n-1 -1 0 3\n1 -1 0 3\n1 1 0 3\n-1 1 0 3\n"),
              std::sqrt(4 / M_PI), 1e-12);
  EXPECT_EQ(read("4 2 open\n0 0\n1 0\n2 0\n3 0\n"), 0.01);
}

TEST(ContourFile, MistakesAreRefusedWhereTheyStand) {
  struct Mistake {
    const char* text;
    int line, column;
    const char* expected;
  };
  const Mistake mistakes[] = {
      {"", 1, 1, "a number of points, or 'cver'"},
      {"3 2 closed\n", 1, 1, "a number of points, or 'cver', a whole number from 4 to 10000"},
      {"4 5 closed\n", 1, 3, "dimensions, a whole number from 2 to 3"},
      {"4 2 closed\n0 0\n1 0\n1\n", 4, 2, "the coordinates of a point"},
      {"4 2 closed\n0 0\n1 z\n", 3, 3, "the coordinates of a point"},
      {"cver 2 1\n", 1, 6, "version 1 1 to 1 3, a whole number from 1 to 1"},
      {"cver 1 1\npoints: 4 4\n", 2, 1, "'name:'"},
      {"cver 1 1\nname: a\npoints: 4\ntype: closed\n", 4, 1, "a number of points, repeated ones included"},
      {"cver 1 1\nname: a\npoints: 2 4\ntype: closed\n0 0 0 2\n0 0 0 0\n", 6, 7,
       "how often the point counts, a whole number from 1 to 100"},
      {"cver 1 1\nname: a\npoints: 2 4\ntype: closed\n0 0 0 2\n0 0 0 3\n", 6, 8, "4 points in all"},
      {"4 2 closed\n0 0\n1e9 0\n1e9 1e9\n0 1e9\n", 0, 0, "one about a line's width"},
  };
  for (const Mistake& mistake : mistakes) try {
      read(mistake.text);
      ADD_FAILURE() << mistake.text;
    } catch (const InputError& error) {
      EXPECT_EQ(error.location().file, "stem.con");
      EXPECT_EQ(error.location().line, mistake.line) << mistake.text;
      EXPECT_EQ(error.location().column, mistake.column) << mistake.text;
      EXPECT_EQ(error.expected(), mistake.expected) << mistake.text;
    }
}

}  // namespace
}  // namespace cambium
