#include "raytrace/texture_image.h"

#include <gtest/gtest.h>

namespace cambium {
namespace {

TEST(TextureImage, IsBilinearPeriodicAndAveragesUnderALargeFootprint) {
  Pixels pixels{2, 2, 3, {1, 0, 0, 0, 1, 0, 0, 0, 1, 1, 1, 1}, false};
  const TextureImage image(pixels);
  EXPECT_NEAR(image.lookup(0.25, 0.75, 0).x, 1, 1e-6);  // top left
  EXPECT_NEAR(image.lookup(0.75, 0.75, 0).y, 1, 1e-6);
  EXPECT_NEAR(image.lookup(0.5, 0.75, 0).x, 0.5, 1e-6);
  EXPECT_NEAR(glm::length(image.lookup(3.1, -2.3, 0) - image.lookup(0.1, 0.7, 0)), 0, 1e-6);
  EXPECT_NEAR(glm::length(image.lookup(0.3, 0.1, 8) - Vec3(0.5)), 0, 1e-6);
}

TEST(TextureImage, TurnsSrgbIntoLinearLight) {
  const TextureImage image(Pixels{1, 1, 3, {0.5f, 0.5f, 0.5f}, true});
  EXPECT_NEAR(image.lookup(0, 0, 0).x, 0.2140, 1e-3);
}

TEST(TextureImage, NormalsAndRoughnessAreNumbersNotColours) {
  const Pixels pixels{1, 1, 3, {0.5f, 0.25f, 0.75f}, true};
  EXPECT_NEAR(TextureImage(pixels, TextureUse::kRoughness).lookup(0, 0, 0).x, 0.25, 1e-6);
  const Pixels grey{1, 1, 1, {0.4f}, true};
  EXPECT_NEAR(TextureImage(grey, TextureUse::kRoughness).lookup(0, 0, 0).x, 0.4, 1e-6);
}

// A slope that rises to the right leans its normal to the left.
TEST(TextureImage, NormalsAreSlopesInEitherConvention) {
  const Pixels pixels{1, 1, 3, {0.25f, 0.7f, 0.9f}, true};   // n = (-0.5, 0.4, 0.8)
  const Vec3 opengl = TextureImage(pixels, TextureUse::kNormalOpenGl).lookup(0, 0, 0);
  EXPECT_NEAR(opengl.x, 0.5 / 0.8, 1e-6);
  EXPECT_NEAR(opengl.y, -0.4 / 0.8, 1e-6);
  const Vec3 directx = TextureImage(pixels, TextureUse::kNormalDirectX).lookup(0, 0, 0);
  EXPECT_NEAR(directx.x, opengl.x, 1e-9);
  EXPECT_NEAR(directx.y, -opengl.y, 1e-9);
  const Pixels lying{1, 1, 3, {1.0f, 0.5f, 0.2f}, false};
  EXPECT_GT(TextureImage(lying, TextureUse::kNormalOpenGl).lookup(0, 0, 0).x, -20);
}

}  // namespace
}  // namespace cambium
