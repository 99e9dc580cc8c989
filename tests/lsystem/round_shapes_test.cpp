#include "lsystem/round_shapes.h"

#include <gtest/gtest.h>

#include <cmath>

namespace cambium {
namespace {

TEST(RoundShapes, TheSphereIsClosedOutwardAndOneAcross) {
  const OrganShape sphere = unit_sphere();
  double volume = 0;
  for (const auto& [a, b, c] : sphere.triangles)
    volume += glm::dot(sphere.vertices[a], glm::cross(sphere.vertices[b], sphere.vertices[c])) / 6;
  EXPECT_NEAR(volume, M_PI / 6, 0.02);
  EXPECT_LT(volume, M_PI / 6);
  for (const Vec3& v : sphere.vertices) EXPECT_NEAR(glm::length(v), 0.5, 1e-12);
  EXPECT_EQ(sphere.vertices.size() + sphere.triangles.size(), sphere.triangles.size() * 3 / 2 + 2);  // Euler
}

TEST(RoundShapes, TheDiscLiesInThePlaneOfLeftAndHeading) {
  const OrganShape disc = unit_disc();
  double area = 0;
  for (const auto& [a, b, c] : disc.triangles)
    area += 0.5 * glm::cross(disc.vertices[b] - disc.vertices[a], disc.vertices[c] - disc.vertices[a]).z;
  EXPECT_NEAR(area, M_PI / 4, 0.01);
  for (const Vec3& v : disc.vertices) EXPECT_EQ(v.z, 0);
}

}  // namespace
}  // namespace cambium
