#include "raytrace/bark_texture.h"

#include "blobtree/place_hash.h"

#include <gtest/gtest.h>

namespace cambium {
namespace {

/// 8 x 8 random texels.
TextureImage speckles(std::uint64_t seed, TextureUse use = TextureUse::kColor) {
  Pixels pixels{8, 8, 3, {}, false};
  for (std::uint64_t i = 0; i < 8 * 8 * 3; ++i) pixels.data.push_back(static_cast<float>(unit_of(hash_of(seed, i))));
  return TextureImage(pixels, use);
}

TEST(BarkMaps, CloseAroundTheGirthAndChangeSlowlyWithTheRadius) {
  const TextureImage color = speckles(1), normals = speckles(2, TextureUse::kNormalOpenGl), roughness = speckles(3, TextureUse::kRoughness);
  const BarkMaps maps{color, &normals, &roughness, 0.2};
  for (int i = 0; i < 300; ++i) {
    const double v = 0.017 * i, radius = 0.02 * std::exp2(0.01 * i);
    const MappedBark a = maps.at(0, v, radius, 0), b = maps.at(1 - 1e-9, v, radius, 0), c = maps.at(0, v, radius * (1 + 1e-7), 0);
    EXPECT_NEAR(glm::length(a.albedo - b.albedo), 0, 1e-5);
    EXPECT_NEAR(glm::length(a.slope - b.slope), 0, 1e-4);
    EXPECT_NEAR(a.roughness, b.roughness, 1e-5);
    EXPECT_NEAR(glm::length(a.albedo - c.albedo), 0, 1e-4);
  }
}

TEST(BarkMaps, AverageUnderALargeFootprint) {
  const TextureImage color = speckles(1), normals = speckles(2, TextureUse::kNormalOpenGl);
  const BarkMaps maps{color, &normals, nullptr, 0.2};
  const MappedBark a = maps.at(0.1, 0.3, 0.1, 10), b = maps.at(0.7, 5.1, 0.1, 10);
  EXPECT_NEAR(glm::length(a.albedo - b.albedo), 0, 1e-6);
  EXPECT_NEAR(glm::length(a.slope - b.slope), 0, 1e-6);
  EXPECT_EQ(a.roughness, 0.85);
}

}  // namespace
}  // namespace cambium
