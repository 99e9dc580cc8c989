#include "raytrace/pixel_sum.h"

#include <gtest/gtest.h>

namespace cambium {
namespace {

CameraSample hit(double depth, double branch) {
  CameraSample sample;
  sample.depth = depth;
  sample.branch = branch;
  sample.position = Vec3(depth);
  sample.ridge = 1;
  return sample;
}

TEST(PixelSum, ErrorIsThatOfTheMean) {
  PixelSum sum;
  sum.add({}, 0.2);
  EXPECT_EQ(sum.error(), 0);
  sum.add({}, 0.8);
  EXPECT_NEAR(sum.spread(), 0.3 * std::sqrt(2.0), 1e-6);
  EXPECT_NEAR(sum.error(), 0.3, 1e-6);
  EXPECT_NEAR(sum.mean_shown(), 0.5, 1e-6);
}

TEST(PixelSum, SurfaceValuesAreThoseOfTheSamplesThatHit) {
  PixelSum sum;
  CameraSample sample = hit(3, 0);
  sample.albedo = Vec3(0.5);
  sample.ambient = Vec3(2.0);
  sum.add(sample, 0);
  sample.depth = kInfinity;
  sum.add(sample, 0);
  EXPECT_EQ(sum.hits, 1);
  EXPECT_EQ(sum.hit_share(), 0.5f);
  EXPECT_EQ(sum.albedo, glm::vec3(0.5f));
  EXPECT_EQ(sum.lit, glm::vec3(1.0f));
  EXPECT_EQ(sum.depth, 3);
}

TEST(FirstHitSum, KeepsTheNearestHitWhole) {
  FirstHitSum sum;
  sum.add({});
  EXPECT_EQ(sum.branch, -1);
  EXPECT_EQ(sum.depth, static_cast<float>(kInfinity));
  for (const auto& [depth, branch] : {std::pair{4.0, 1.0}, {2.0, 7.0}, {3.0, 1.0}}) sum.add(hit(depth, branch));
  EXPECT_EQ(sum.depth, 2);
  EXPECT_EQ(sum.branch, 7);
  EXPECT_EQ(sum.position, glm::vec3(2.0f));
  EXPECT_EQ(sum.ridge, 3);
}

TEST(FirstHitSum, CountsSamplesByTwelveBranchesAndLeavesAThirteenthOut) {
  FirstHitSum sum;
  for (int branch : {-1, 3, 3, 5, 8, 3, 9, 11, 12, 13, 14, 15, 16, 17, 18, 18, 17}) sum.add(hit(1, branch));
  EXPECT_EQ(sum.shares[0].branch, -1);
  EXPECT_EQ(sum.shares[1].branch, 3);
  EXPECT_EQ(sum.shares[1].samples, 3);
  int counted = 0;
  for (const BranchShare& share : sum.shares) counted += share.samples;
  EXPECT_EQ(counted, 15);
  EXPECT_EQ(sum.shares[11].branch, 17);
  EXPECT_EQ(sum.shares[11].samples, 2);
}

}  // namespace
}  // namespace cambium
