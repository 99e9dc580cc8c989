#include "polygonize/qef.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <random>

namespace cambium {
namespace {

TEST(Qef, EigenvectorsRebuildTheMatrix) {
  std::mt19937 random(7);
  std::normal_distribution<> number;
  for (int i = 0; i < 200; ++i) {
    Mat3 m;
    for (int r = 0; r < 3; ++r)
      for (int c = r; c < 3; ++c) m[r][c] = m[c][r] = number(random);
    Vec3 values;
    Mat3 vectors;
    symmetric_eigen(m, values, vectors);
    const Mat3 diagonal(values.x, 0, 0, 0, values.y, 0, 0, 0, values.z);
    const Mat3 rebuilt = vectors * diagonal * glm::transpose(vectors);
    for (int r = 0; r < 3; ++r)
      for (int c = 0; c < 3; ++c) EXPECT_NEAR(rebuilt[r][c], m[r][c], 1e-10);
  }
}

TEST(Qef, APlaneKeepsTheNearPointsPlaceAlongIt) {
  Qef qef;
  qef.add(Vec3(0, 0, 0.2), Vec3(0, 0, 1));
  qef.add(Vec3(1, 0, 0.2), Vec3(0, 0, 1));
  const auto solution = qef.solve(Vec3(0.3, 0.4, 0));
  EXPECT_EQ(solution.rank, 1);
  EXPECT_NEAR(glm::length(solution.point - Vec3(0.3, 0.4, 0.2)), 0, 1e-12);
}

// Around the angle at which a second direction begins to count, the quick way and the full one must give the same point.
TEST(Qef, ARoundTwigIsAPlaneWhoseTiltIsTheLeadingEigenvector) {
  std::mt19937 random(8);
  std::normal_distribution<> number;
  int flat = 0;
  for (int i = 0; i < 500; ++i) {
    const Vec3 axis = glm::normalize(Vec3(number(random), number(random), number(random)));
    Mat3 sum(0.0);
    Vec3 b(0.0);
    Qef qef;
    for (int k = 0; k < 6; ++k) {
      const Vec3 n = glm::normalize(axis + 0.12 * Vec3(number(random), number(random), number(random)));
      const Vec3 p(0.3 * number(random), 0.3 * number(random), 0.3 * number(random));
      qef.add(p, n);
      sum += glm::outerProduct(n, n);
      b += n * glm::dot(n, p);
    }
    Vec3 values;
    Mat3 vectors;
    symmetric_eigen(sum, values, vectors);
    const double largest = std::max({values.x, values.y, values.z});
    Vec3 expected(0.1, 0.2, 0.3);
    const Vec3 residual = b - sum * expected;
    int rank = 0;
    for (int k = 0; k < 3; ++k) {
      if (values[k] <= 0.05 * largest) continue;
      expected += vectors[k] * (glm::dot(vectors[k], residual) / values[k]);
      ++rank;
    }
    const auto solution = qef.solve(Vec3(0.1, 0.2, 0.3));
    ASSERT_EQ(solution.rank, rank);
    ASSERT_LT(glm::length(solution.point - expected), 1e-9);
    flat += rank == 1;
  }
  EXPECT_GT(flat, 100);
  EXPECT_LT(flat, 500);
}

TEST(Qef, AnEdgeAndACornerAreFoundExactly) {
  Qef qef;
  qef.add(Vec3(0.1, 0.5, 0), Vec3(0, 0, 1));
  qef.add(Vec3(0.2, 0, -0.3), glm::normalize(Vec3(1, 0, 1)));
  auto solution = qef.solve(Vec3(0.4, 0.25, 0.4));
  EXPECT_EQ(solution.rank, 2);
  EXPECT_NEAR(glm::length(solution.point - Vec3(-0.1, 0.25, 0)), 0, 1e-9);
  qef.add(Vec3(0, 0.3, 0), Vec3(0, 1, 0));
  solution = qef.solve(Vec3(0));
  EXPECT_EQ(solution.rank, 3);
  EXPECT_NEAR(glm::length(solution.point - Vec3(-0.1, 0.3, 0)), 0, 1e-9);
}

TEST(Qef, NoPlanesLeaveTheNearPoint) {
  const auto solution = Qef{}.solve(Vec3(1, 2, 3));
  EXPECT_EQ(solution.rank, 0);
  EXPECT_EQ(solution.point, Vec3(1, 2, 3));
}

}  // namespace
}  // namespace cambium
