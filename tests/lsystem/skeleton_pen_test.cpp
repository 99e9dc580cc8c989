#include "lsystem/skeleton_pen.h"

#include <gtest/gtest.h>

namespace cambium {
namespace {

TEST(SkeletonPen, DrawsEndToEnd) {
  SkeletonPen pen;
  SkeletonPen::Place place;
  EXPECT_EQ(pen.nearest_node(place), -1);
  pen.draw(place, {{0, 0, 0}, 0.2}, {{0, 0, 1}, 0.2});
  pen.draw(place, {{0, 0, 1}, 0.1}, {{0, 0, 2}, 0.1});
  EXPECT_EQ(pen.nearest_node(place), 2);
  const Skeleton skeleton = std::move(pen).take();
  ASSERT_EQ(skeleton.nodes.size(), 3u);
  EXPECT_EQ(skeleton.nodes[0].parent, -1);
  EXPECT_EQ(skeleton.nodes[2].parent, 1);
  EXPECT_EQ(skeleton.nodes[2].base_radius, 0.1);
}

TEST(SkeletonPen, APieceBeginsWhereItWasLifted) {
  SkeletonPen pen;
  SkeletonPen::Place place;
  pen.draw(place, {{0, 0, 0}, 0.2}, {{0, 0, 1}, 0.2});
  pen.lift(place);
  pen.draw(place, {{5, 0, 0}, 0.2}, {{5, 0, 1}, 0.2});
  EXPECT_EQ(std::move(pen).take().nodes[2].parent, -1);
}

TEST(SkeletonPen, ALiftedPenThatComesBackGoesOn) {
  SkeletonPen pen;
  SkeletonPen::Place place;
  pen.draw(place, {{0, 0, 0}, 0.2}, {{0, 0, 1}, 0.2});
  pen.lift(place);
  pen.draw(place, {{0, 0, 1 + 1e-15}, 0.2}, {{0, 0, 2}, 0.2});
  const Skeleton skeleton = std::move(pen).take();
  ASSERT_EQ(skeleton.nodes.size(), 3u);
  EXPECT_EQ(skeleton.nodes[2].parent, 1);
}

TEST(SkeletonPen, ThickerThanItsParentIsLoweredAndCounted) {
  SkeletonPen pen;
  SkeletonPen::Place place;
  pen.draw(place, {{0, 0, 0}, 0.1}, {{0, 0, 1}, 0.1});
  pen.draw(place, {{0, 0, 1}, 0.3}, {{0, 0, 2}, 0.3});
  EXPECT_EQ(pen.radii_clamped(), 1u);
  EXPECT_EQ(std::move(pen).take().nodes[2].radius, 0.1);
}

TEST(SkeletonPen, AnInternodeMayTaper) {
  SkeletonPen pen;
  SkeletonPen::Place place;
  pen.draw(place, {{0, 0, 0}, 0.3}, {{0, 0, 1}, 0.2});
  EXPECT_EQ(pen.radii_clamped(), 0u);
  const Skeleton skeleton = std::move(pen).take();
  EXPECT_EQ(skeleton.nodes[0].radius, 0.3);
  EXPECT_EQ(skeleton.nodes[1].base_radius, 0.3);
  EXPECT_EQ(skeleton.nodes[1].radius, 0.2);
}

}  // namespace
}  // namespace cambium
