#include "cli/leaf_shapes.h"

#include <gtest/gtest.h>

#include <algorithm>

namespace cambium {
namespace {

double area(const Sheet& sheet) {
  double sum = 0;
  for (const auto& [a, b, c] : sheet.triangles)
    sum += 0.5 * glm::length(glm::cross(sheet.positions[b] - sheet.positions[a], sheet.positions[c] - sheet.positions[a]));
  return sum;
}

TEST(LeafShapes, ACardIsARectangleHeldInTheMiddleOfItsBase) {
  const Sheet card = leaf_card(0.2, 0.5);
  ASSERT_EQ(card.positions.size(), 4u);
  EXPECT_NEAR(area(card), 0.1, 1e-6);
  for (std::size_t i = 0; i < 4; ++i) {
    EXPECT_FLOAT_EQ(std::abs(card.positions[i].x), 0.1f);
    EXPECT_FLOAT_EQ(card.uvs[i].x, card.positions[i].x > 0 ? 1 : 0);
    EXPECT_FLOAT_EQ(card.uvs[i].y, card.positions[i].y / 0.5f);
    EXPECT_EQ(card.normals[i], glm::vec3(0, 0, 1));
  }
}

TEST(LeafShapes, APlainLeafFacesUpWithinItsCard) {
  const Sheet leaf = plain_leaf(0.5, 1);
  EXPECT_GT(area(leaf), 0.25);
  EXPECT_LT(area(leaf), 0.5);
  float widest = 0, tip = 0;
  for (std::size_t i = 0; i < leaf.positions.size(); ++i) {
    widest = std::max(widest, std::abs(leaf.positions[i].x));
    tip = std::max(tip, leaf.positions[i].y);
    EXPECT_EQ(leaf.normals[i], glm::vec3(0, 0, 1));
  }
  EXPECT_FLOAT_EQ(widest, 0.25f);
  EXPECT_FLOAT_EQ(tip, 1);
  for (const auto& [a, b, c] : leaf.triangles)
    EXPECT_GT(glm::cross(leaf.positions[b] - leaf.positions[a], leaf.positions[c] - leaf.positions[a]).z, 0);
}

TEST(LeafShapes, ADrawnLeafIsWhatWasDrawnUnderAnImageOfItsExtent) {
  const OrganShape shape{"polygon1", {{0, 0, 0}, {2, 1, 0}, {0, 4, 0}, {-2, 1, 0}}, {{0, 1, 2}, {0, 2, 3}}};
  const Sheet leaf = drawn_leaf(shape);
  EXPECT_EQ(leaf.triangles, shape.triangles);
  EXPECT_EQ(leaf.uvs[1], glm::vec2(1, 0.25f));
  EXPECT_EQ(leaf.uvs[2], glm::vec2(0.5f, 1));
  EXPECT_EQ(leaf.normals[0], glm::vec3(0, 0, 1));
  EXPECT_TRUE(drawn_leaf({"l", {}, {}}).triangles.empty());
}

}  // namespace
}  // namespace cambium
