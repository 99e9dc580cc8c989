#include "blobtree/sheet.h"

#include <gtest/gtest.h>

namespace cambium {
namespace {

TEST(Sheet, NormalsFaceTheSideThatTrianglesWindAboutAndMeanByArea) {
  Sheet sheet;
  sheet.positions = {{0, 0, 0}, {1, 0, 0}, {0, 1, 0}, {0, 0, 3}};
  sheet.triangles = {{0, 1, 2}};
  EXPECT_EQ(mean_normals(sheet)[0], glm::vec3(0, 0, 1));
  sheet.triangles = {{0, 1, 2}, {0, 2, 3}};   // the second is three times as large, and faces x
  const auto normals = mean_normals(sheet);
  EXPECT_LT(glm::distance(normals[0], glm::normalize(glm::vec3(3, 0, 1))), 1e-6f);
  EXPECT_EQ(normals[1], glm::vec3(0, 0, 1));
  EXPECT_EQ(normals[3], glm::vec3(1, 0, 0));
}

TEST(Sheet, VerticesOfNoAreaStillHaveAUnitNormal) {
  Sheet sheet;
  sheet.positions = {{0, 0, 0}, {1, 0, 0}, {2, 0, 0}, {5, 5, 5}};
  sheet.triangles = {{0, 1, 2}};
  for (const glm::vec3& normal : mean_normals(sheet)) EXPECT_EQ(normal, glm::vec3(0, 0, 1));
}

}  // namespace
}  // namespace cambium
