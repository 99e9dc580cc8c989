#include "polygonize/symmetric_eigen.h"

#include <gtest/gtest.h>

#include <random>

namespace cambium {
namespace {

TEST(SymmetricEigen, EigenvectorsRebuildTheMatrix) {
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

}  // namespace
}  // namespace cambium
