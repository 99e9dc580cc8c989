#include "polygonize/obj_sheet.h"

#include "blobtree/input_error.h"

#include <gtest/gtest.h>

#include <random>

namespace cambium {
namespace {

TEST(ObjSheet, ReadsPolygonsAsFansWithTheirImagesPlaces) {
  const Sheet sheet = parse_obj_sheet(
      "# a leaf\r\nmtllib a.mtl\no leaf\nv 0 0 0\nv 1 0 0 0.5\nv 1 1 0\nv 0 1 0\nvt 0 0\nvt 1 0\nvt 1 1\nvt 0 1 0\nvn 0 0 2\nusemtl x\ns off\n"
      "f 1/1/1 2/2/1 3/3/1 4/4/1\r\n", "l.obj");
  ASSERT_EQ(sheet.positions.size(), 4u);
  ASSERT_EQ(sheet.triangles.size(), 2u);
  EXPECT_EQ(sheet.triangles[1], (std::array<std::uint32_t, 3>{0, 2, 3}));
  EXPECT_EQ(sheet.uvs[2], glm::vec2(1, 1));
  for (const glm::vec3& n : sheet.normals) EXPECT_EQ(n, glm::vec3(0, 0, 1));
}

TEST(ObjSheet, CornersShareAVertexOnlyWhereAllOfThemAgrees) {
  const Sheet sheet = parse_obj_sheet("v 0 0 0\nv 1 0 0\nv 0 1 0\nv 1 1 0\nvt 0 0\nvt 1 1\nf 1/1 2/1 3/1\nf 2/1 4/1 3/2\n", "l.obj");
  EXPECT_EQ(sheet.positions.size(), 5u);
}

TEST(ObjSheet, IndicesMayCountBackwardsAndNormalsAreMadeWhereThereAreNone) {
  const Sheet sheet = parse_obj_sheet("v 0 0 0\nv 0 1 0\nv 0 0 1\nf -3 -2 -1", "l.obj");
  EXPECT_EQ(sheet.normals[0], glm::vec3(1, 0, 0));
  EXPECT_EQ(sheet.uvs[1], glm::vec2(0, 0));
  const Sheet mixed = parse_obj_sheet("v 0 0 0\nv 0 1 0\nv 0 0 1\nvn 0 0 0\nf 1//1 2//1 3//1", "l.obj");
  EXPECT_EQ(mixed.normals[0], glm::vec3(1, 0, 0)) << "a normal without direction is none";
}

TEST(ObjSheet, RefusesMalformedFilesNamingLineAndColumn) {
  const std::string corners = "v 0 0 0\nv 1 0 0\nv 0 1 0\n";
  const struct { std::string text; int line, column; const char* in_message; } table[] = {
      {"", 0, 0, "no faces"},
      {corners, 0, 0, "no faces"},
      {"v 0 0\n", 1, 6, "line's end"},
      {"v 0 0 x\n", 1, 7, "'x'"},
      {"v 0 0 nan\n", 1, 7, "'nan'"},
      {"v 0 0 1e99\n", 1, 7, "a number"},
      {"vt 0\n", 1, 5, "a number"},
      {corners + "f 1 2\n", 4, 6, "three corners"},
      {corners + "f\n", 4, 2, "three corners"},
      {corners + "f 1 2 4\n", 4, 7, "there are 3"},
      {corners + "f 1 2 0\n", 4, 7, "there are 3"},
      {corners + "f 1 2 -4\n", 4, 7, "there are 3"},
      {corners + "f 1 2 3/1\n", 4, 7, "there are 0"},
      {corners + "f 1 2 3//1\n", 4, 7, "there are 0"},
      {corners + "f 1 2 /3\n", 4, 7, "there are 0"},
      {corners + "vt 0 0\nf 1 2 /1\n", 5, 7, "a corner"},
      {corners + "f 1 2 3/1/1/1\n", 4, 7, "there are 0"},
      {corners + "vt 0 0\nvn 0 0 1\nf 1 2 3/1/1/1\n", 6, 7, "a corner"},
      {corners + "f 1 2 3.5\n", 4, 7, "a corner"},
      {corners + "f 1 2 99999999999999999999\n", 4, 7, "a corner"},
      {"f 1 2 3\n" + corners, 1, 3, "there are 0"},
  };
  for (const auto& bad : table) {
    SCOPED_TRACE(bad.text);
    try {
      parse_obj_sheet(bad.text, "l.obj");
      FAIL() << "was read";
    } catch (const InputError& error) {
      EXPECT_EQ(error.location().file, "l.obj");
      EXPECT_EQ(error.location().line, bad.line) << error.what();
      EXPECT_EQ(error.location().column, bad.column) << error.what();
      EXPECT_NE(std::string(error.what()).find(bad.in_message), std::string::npos) << error.what();
    }
  }
}

TEST(ObjSheet, NoiseIsReadOrRefusedButDoesNoHarm) {
  const std::string good = "v 0 0 0\nv 1 0 0\nv 0 1 0\nvt 0 0\nvn 0 0 1\nf 1/1/1 2/1/1 3/1/1\n";
  std::mt19937 random(11);
  int refused = 0;
  for (int i = 0; i < 4000; ++i) {
    std::string text = good;
    for (int k = 0; k < 3; ++k) text[random() % text.size()] = "0123456789-/. \nvftn#e"[random() % 21];
    try {
      const Sheet sheet = parse_obj_sheet(text, "l.obj");
      for (const auto& triangle : sheet.triangles)
        for (const std::uint32_t corner : triangle) ASSERT_LT(corner, sheet.positions.size());
      ASSERT_EQ(sheet.uvs.size(), sheet.positions.size());
      ASSERT_EQ(sheet.normals.size(), sheet.positions.size());
    } catch (const InputError&) {
      ++refused;
    }
  }
  EXPECT_GT(refused, 1000);
}

}  // namespace
}  // namespace cambium
