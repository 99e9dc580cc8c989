#include "polygonize/corner_normals.h"

#include "creased_meshes.h"

#include <gtest/gtest.h>

#include <set>

namespace cambium {
namespace {

using namespace testing;

Vec3 face_normal(const Mesh& mesh, std::size_t t) {
  const auto& c = mesh.triangles[t];
  return glm::normalize(glm::cross(mesh.positions[c[1]] - mesh.positions[c[0]], mesh.positions[c[2]] - mesh.positions[c[0]]));
}

TEST(CornerNormals, EverySideOfACreaseHasItsOwn) {
  const Mesh cube = creased_cube();
  const CornerNormals corners = corner_normals(cube);
  EXPECT_EQ(corners.normals.size(), 24u);
  ASSERT_EQ(corners.triangles.size(), 12u);
  for (std::size_t t = 0; t < 12; ++t)
    for (int c = 0; c < 3; ++c)
      EXPECT_LT(glm::distance(Vec3(corners.normals[corners.at(cube, t, c)]), face_normal(cube, t)), 1e-6);
}

TEST(CornerNormals, WithoutCreasesTheyAreTheVertices) {
  Mesh cube = creased_cube();
  cube.creases.clear();
  const CornerNormals corners = corner_normals(cube);
  EXPECT_EQ(corners.normals, cube.normals);
  for (std::size_t t = 0; t < 12; ++t)
    for (int c = 0; c < 3; ++c) EXPECT_EQ(corners.at(cube, t, c), cube.triangles[t][c]);
}

TEST(CornerNormals, WhereACreaseOnlyEndsTheNormalStaysOne) {
  const Mesh cube = cube_with_one_crease();
  const CornerNormals corners = corner_normals(cube);
  EXPECT_EQ(corners.normals, cube.normals);
  EXPECT_EQ(corners.triangles, cube.triangles);
}

// Two creases in a row part the surface at the vertex between them, whose sides are means weighted by angle.
TEST(CornerNormals, ASideIsTheMeanOfItsTrianglesByAngle) {
  Mesh cube = creased_cube();
  cube.creases = {{0, 1}, {0, 2}};
  const CornerNormals corners = corner_normals(cube);
  ASSERT_EQ(corners.normals.size(), 9u);
  std::set<std::uint32_t> at_zero;
  for (std::size_t t = 0; t < 12; ++t)
    for (int c = 0; c < 3; ++c)
      if (cube.triangles[t][c] == 0) at_zero.insert(corners.at(cube, t, c));
  EXPECT_EQ(at_zero, (std::set<std::uint32_t>{0, 8}));
  // The bottom is one side; the two upright faces, with a right angle each, are the other.
  const glm::vec3 bottom(0, 0, -1), upright = glm::normalize(glm::vec3(-1, -1, 0));
  const glm::vec3 a = corners.normals[0], b = corners.normals[8];
  EXPECT_LT(std::min(glm::distance(a, bottom) + glm::distance(b, upright), glm::distance(b, bottom) + glm::distance(a, upright)), 1e-5f);
}

TEST(SmoothingGroups, AreThePartsBetweenClosedCreases) {
  const Mesh cube = creased_cube(), smooth = cube_with_one_crease();
  const auto groups = smoothing_groups(cube, corner_normals(cube));
  for (std::size_t face = 0; face < 6; ++face) {
    EXPECT_EQ(groups[2 * face], face + 1);
    EXPECT_EQ(groups[2 * face + 1], face + 1);
  }
  for (const std::uint32_t group : smoothing_groups(smooth, corner_normals(smooth))) EXPECT_EQ(group, 1u);
}

}  // namespace
}  // namespace cambium
