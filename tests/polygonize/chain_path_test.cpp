// A chain by length along it, beside the field of the same chain.
#include "polygonize/chain_path.h"

#include "blobtree/field.h"

#include <gtest/gtest.h>

#include <cmath>
#include <random>

namespace cambium {
namespace {

const Chain kBent{{{{0, 0, 0}, 0.10}, {{0, 0, 1}, 0.08}, {{0.3, 0, 1.9}, 0.09}, {{0.3, 0.8, 2.5}, 0.04}}};

Field field_of(const Chain& chain) {
  BlobTreeBuilder b;
  return Field(b.build(b.add(chain)));
}

TEST(ChainPath, PlacesAreMetresFromTheFirstNode) {
  const ChainPath path(kBent.nodes);
  EXPECT_EQ(path.segment_count(), 3u);
  EXPECT_EQ(path.node_at(1), 1);
  EXPECT_NEAR(path.length(), 1 + std::hypot(0.3, 0.9) + std::hypot(0.8, 0.6), 1e-12);
  EXPECT_EQ(path.segment_at(0.5), 0u);
  EXPECT_EQ(path.segment_at(1), 1u);
  EXPECT_EQ(path.segment_at(-1), 0u);
  EXPECT_EQ(path.segment_at(99), 2u);
  EXPECT_NEAR(path.radius(0.5), 0.09, 1e-12);
  EXPECT_NEAR(glm::distance(path.point(0.25), Vec3(0, 0, 0.25)), 0, 1e-12);
  EXPECT_NEAR(path.nearest({0.5, 0, 0.25}, 0, 2), 0.25, 1e-12);
  EXPECT_NEAR(path.nearest({0.5, 0, 0.25}, 2, 2), path.node_at(2), 1e-12);
}

TEST(ChainPath, TheTangentAtANodeIsHalfway) {
  const ChainPath path(kBent.nodes);
  EXPECT_EQ(path.tangent(0.5), Vec3(0, 0, 1));
  const Vec3 at_node = path.tangent(1);
  EXPECT_NEAR(glm::dot(at_node, path.direction(0)), glm::dot(at_node, path.direction(1)), 1e-12);
}

TEST(ChainPath, SegmentsWithoutLengthHaveADirection) {
  const std::vector<ChainNode> nodes{{{0, 0, 0}, 0.1}, {{0, 0, 0}, 0.1}, {{0, 0, 1}, 0.1}, {{0, 0, 1}, 0.1}};
  const ChainPath path(nodes);
  for (std::size_t k = 0; k < 3; ++k) EXPECT_EQ(path.direction(k), Vec3(0, 0, 1));
}

TEST(ChainPath, ItsSurfaceIsThatOfTheField) {
  const Field field = field_of(kBent);
  const ChainPath path(kBent.nodes);
  for (const double s : {0.2, 0.93, 1.0, 1.1, path.node_at(2), 2.4}) {
    const Vec3 along = path.tangent(s), side = glm::normalize(glm::cross(along, Vec3(0.3, 0.8, 0.2)));
    for (int k = 0; k < 12; ++k) {
      const double angle = k * 0.5236;
      const auto found = path.surface(s, std::cos(angle) * side + std::sin(angle) * glm::cross(along, side));
      const Sample sample = field.sample(found.position);
      EXPECT_NEAR(sample.value, kIso, 1e-6);
      EXPECT_GT(glm::dot(found.normal, glm::normalize(-sample.gradient)), 1 - 1e-6);
      EXPECT_NEAR(path.distance(s, found.position + 0.001 * found.normal), 0.001, 3e-4);
      EXPECT_NEAR(path.distance(s, found.position - 0.001 * found.normal), -0.001, 3e-4);
    }
  }
}

TEST(ChainPath, ABoxIsReachedFromWhereverItsSurfacePointsBelong) {
  const ChainPath path(kBent.nodes);
  std::mt19937 random(3);
  std::uniform_real_distribution<double> unit(0, 1);
  int reached = 0;
  for (int i = 0; i < 20000; ++i) {
    const double s = path.length() * unit(random), angle = 6.28 * unit(random);
    const Vec3 along = path.tangent(s), side = glm::normalize(glm::cross(along, Vec3(0.3, 0.8, 0.2)));
    const Vec3 p = path.surface(s, std::cos(angle) * side + std::sin(angle) * glm::cross(along, side)).position;
    Box box;
    box.lo = p - 0.1 * Vec3(unit(random), unit(random), unit(random));
    box.hi = p + 0.1 * Vec3(unit(random), unit(random), unit(random));
    const auto found = path.reaching(box, 0, 2);
    ASSERT_TRUE(found);
    const double at = path.nearest(p, 0, 2);
    EXPECT_LE(found->begin, at + 1e-9);
    EXPECT_GE(found->end, at - 1e-9);
    reached += found->end - found->begin < 0.9;
  }
  EXPECT_GT(reached, 19000);
  EXPECT_FALSE(path.reaching({{1, 1, 0}, {2, 2, 1}}, 0, 2));
}

}  // namespace
}  // namespace cambium
