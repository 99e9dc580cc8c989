#include "raytrace/foliage_texture.h"

#include "blobtree/input_error.h"
#include "tests/raytrace/foliage_scenes.h"

#include <gtest/gtest.h>

#include <filesystem>

namespace cambium {
namespace {

TEST(FoliageTexture, WithoutAlphaItIsLeafEverywhere) {
  const FoliageTexture texture(Pixels{1, 1, 3, {0.2f, 0.4f, 0.1f}, false});
  EXPECT_FALSE(texture.cut_out());
  EXPECT_TRUE(texture.leaf_at(0.3, 0.7));
  EXPECT_NEAR(texture.color(0.3, 0.7, 0).y, 0.4, 1e-6);
}

TEST(FoliageTexture, IsCutOutWhereTheInterpolatedAlphaIsBelowAHalf) {
  // One column of leaf on the left, one of nothing on the right.
  const FoliageTexture texture(Pixels{2, 1, 2, {0.5f, 1, 0.5f, 0}, false});
  EXPECT_TRUE(texture.cut_out());
  EXPECT_TRUE(texture.leaf_at(0.25, 0.5));
  EXPECT_TRUE(texture.leaf_at(0.49, 0.5));
  EXPECT_FALSE(texture.leaf_at(0.51, 0.5));
  EXPECT_FALSE(texture.leaf_at(0.75, 0.5));
  EXPECT_FALSE(texture.leaf_at(std::nan(""), 0.5));
  EXPECT_TRUE(texture.leaf_at(7.25, -3.5)) << "it repeats";
}

TEST(FoliageTexture, TheImagesTopIsTheLeafsTip) {
  const FoliageTexture texture(Pixels{1, 2, 4, {1, 0, 0, 1, 0, 0, 1, 0}, false});
  EXPECT_TRUE(texture.leaf_at(0.5, 0.75));
  EXPECT_FALSE(texture.leaf_at(0.5, 0.25));
  EXPECT_NEAR(texture.color(0.5, 0.75, 0).x, 1, 1e-6);
}

TEST(FoliageTexture, WhatIsCutAwayDoesNotTintTheRim) {
  const FoliageTexture texture(Pixels{2, 1, 4, {0.2f, 0.6f, 0.1f, 1, 1, 0, 1, 0}, false});   // magenta, not there
  for (const double u : {0.25, 0.4, 0.5, 0.75}) EXPECT_NEAR(glm::distance(texture.color(u, 0.5, 4), Vec3(0.2, 0.6, 0.1)), 0, 1e-6);
}

TEST(FoliageTexture, AnImageOfNothingAtAllIsCutAwayWhole) {
  const FoliageTexture texture(Pixels{1, 1, 4, {0.3f, 0.3f, 0.3f, 0}, false});
  EXPECT_FALSE(texture.leaf_at(0.5, 0.5));
  EXPECT_NEAR(texture.color(0.5, 0.5, 0).x, 0.3, 1e-6);
}

TEST(FoliageTexture, ColoursOfAHalfTransparentFileAreStraight) {
  const auto path = std::filesystem::temp_directory_path() / "cambium_foliage_texture_straight.png";
  const Pixels pixels{2, 1, 4, {0.8f, 0.4f, 0.2f, 0.6f, 0.8f, 0.4f, 0.2f, 0}, true};
  write_pixels(pixels, {{"R", "G", "B", "A"}, std::vector<SampleType>(4, SampleType::kUint8)}, path, ".png");
  const auto texture = load_foliage_texture(path);
  std::filesystem::remove(path);
  EXPECT_NEAR(texture->color(0.25, 0.5, 0).x, 0.6038, 5e-3);   // 0.8 as sRGB
  EXPECT_TRUE(texture->cut_out());
  EXPECT_THROW(load_foliage_texture(path), InputError);
}

}  // namespace
}  // namespace cambium
