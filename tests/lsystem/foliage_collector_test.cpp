#include "lsystem/foliage_collector.h"

#include <gtest/gtest.h>

#include <random>

namespace cambium {
namespace {

const FoliageCollector::Surfaces kNoSurfaces;

using Outcome = FoliageCollector::Outcome;

const std::vector<Vec3> kLeaf = {{0.3, 0.5, 0}, {0.1, 1, 0.1}, {-0.2, 0.4, 0}};

std::vector<Vec3> scaled(std::vector<Vec3> corners, double scale) {
  for (Vec3& corner : corners) corner *= scale;
  return corners;
}

TEST(FoliageCollector, MultiplesOfAnOutlineShareAShape) {
  FoliageCollector collector(kNoSurfaces);
  std::mt19937 random(1);
  std::uniform_real_distribution<double> noise(-1e-10, 1e-10), size(1e-3, 1e3);
  for (int i = 0; i < 1000; ++i) {
    std::vector<Vec3> corners = kLeaf;
    for (Vec3& corner : corners) corner += Vec3(noise(random), noise(random), noise(random));
    EXPECT_EQ(collector.add_outline({}, scaled(corners, size(random)), {}), Outcome::kAdded);
  }
  const Foliage foliage = std::move(collector).take();
  EXPECT_EQ(foliage.shapes.size(), 1u);
  EXPECT_EQ(foliage.organs.size(), 1000u);
}

TEST(FoliageCollector, ShapeTimesScaleIsTheOutline) {
  FoliageCollector collector(kNoSurfaces);
  const std::vector<Vec3> corners = scaled(kLeaf, 7);
  collector.add_outline({}, corners, {});
  const Foliage foliage = std::move(collector).take();
  ASSERT_EQ(foliage.shapes[0].vertices.size(), 3u);
  EXPECT_EQ(foliage.shapes[0].name, "polygon1");
  EXPECT_EQ(foliage.shapes[0].triangles.size(), 1u);
  for (std::size_t i = 0; i < 3; ++i)
    EXPECT_LT(glm::length(foliage.organs[0].scale * foliage.shapes[0].vertices[i] - corners[i]), 1e-12);
}

TEST(FoliageCollector, OtherOutlinesAreOtherShapes) {
  FoliageCollector collector(kNoSurfaces);
  collector.add_outline({}, kLeaf, {});
  std::vector<Vec3> other = kLeaf;
  other[0].x += 1e-3;
  collector.add_outline({}, other, {});
  std::swap(other[0], other[1]);
  collector.add_outline({}, other, {});
  EXPECT_EQ(std::move(collector).take().shapes.size(), 3u);
}

TEST(FoliageCollector, CornersRecordedTwiceAreOne) {
  FoliageCollector collector(kNoSurfaces);
  collector.add_outline({}, kLeaf, {});
  collector.add_outline({}, {kLeaf[0], kLeaf[0], kLeaf[1], kLeaf[2], kLeaf[2], kLeaf[0]}, {});
  EXPECT_EQ(std::move(collector).take().shapes.size(), 1u);
}

TEST(FoliageCollector, NothingComesOfWhatHasNoSize) {
  FoliageCollector collector(kNoSurfaces);
  EXPECT_EQ(collector.add_outline({}, {}, {}), Outcome::kNothing);
  EXPECT_EQ(collector.add_outline({}, {{1, 0, 0}, {2, 0, 0}, {3, 0, 0}}, {}), Outcome::kNothing);
  EXPECT_EQ(collector.add_outline({}, {{1, 0, 0}, {2, 0, 0}, {3, 0, 0}}, {}), Outcome::kNothing);  // also the second time
  EXPECT_EQ(collector.add_surface({}, "l", {0, 0, 0}), Outcome::kNothing);
  EXPECT_EQ(collector.add_sphere({}, 0), Outcome::kNothing);
  EXPECT_EQ(collector.add_disc({}, -1), Outcome::kNothing);
  EXPECT_TRUE(std::move(collector).take().organs.empty());
}

TEST(FoliageCollector, SurfacesSpheresAndDiscsAreSharedToo) {
  FoliageCollector collector(kNoSurfaces);
  for (int i = 1; i < 4; ++i) {
    collector.add_surface({}, "l", Vec3(0.1 * i));
    collector.add_sphere({}, i);
    collector.add_disc({}, i);
  }
  const Foliage foliage = std::move(collector).take();
  ASSERT_EQ(foliage.shapes.size(), 3u);
  EXPECT_EQ(foliage.shapes[0].name, "l");
  EXPECT_TRUE(foliage.shapes[0].triangles.empty());
  EXPECT_EQ(foliage.shapes[1].name, "sphere");
  EXPECT_EQ(foliage.shapes[2].name, "disc");
  EXPECT_EQ(foliage.organs.size(), 9u);
  EXPECT_EQ(foliage.organs[7].shape, 1u);
  EXPECT_EQ(foliage.organs[7].scale, 3);
}

}  // namespace
}  // namespace cambium
