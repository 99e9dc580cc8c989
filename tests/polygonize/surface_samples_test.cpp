#include "polygonize/surface_samples.h"

#include "tests/polygonize/octrees.h"
#include "tests/polygonize/sample_fields.h"

#include <gtest/gtest.h>

#include <array>
#include <atomic>
#include <numbers>

namespace cambium {
namespace {

SurfaceSamples samples_of(const Field& field, std::size_t count, int threads = 0) {
  RunOptions run;
  run.threads = threads;
  return *sample_surface(field, count, run);
}

TEST(SurfaceSamples, TheyLieOnTheSurfaceAndAreAboutAsManyAsAskedFor) {
  for (const Field& field : {testing::sphere_field(), testing::torus_field(), testing::fork_field(), testing::cut_box_field()}) {
    for (const std::size_t count : {1000, 30000}) {
      const SurfaceSamples samples = samples_of(field, count);
      EXPECT_NEAR(static_cast<double>(samples.points.size()), static_cast<double>(count), 0.12 * static_cast<double>(count));
      for (const Vec3& p : samples.points) ASSERT_NEAR(field.value(p), kIso, 1e-9);
    }
  }
}

TEST(SurfaceSamples, TheirNumberAndSpacingGiveTheArea) {
  const auto area = [](const Field& field) {
    const SurfaceSamples samples = samples_of(field, 40000);
    return static_cast<double>(samples.points.size()) * samples.spacing * samples.spacing;
  };
  EXPECT_NEAR(area(testing::sphere_field(1)), 4 * std::numbers::pi, 0.02 * 4 * std::numbers::pi);
  EXPECT_NEAR(area(testing::torus_field()), 4 * std::numbers::pi * std::numbers::pi * 0.3, 0.02 * 12);
  // A twig of a thousandth of the length of the whole.
  EXPECT_NEAR(area(testing::field_of(Capsule{Vec3(0), Vec3(1, 2, 2), 0.003, 1})), 2 * std::numbers::pi * 0.003 * 3.006, 0.002);
}

TEST(SurfaceSamples, EvenWhicheverWayTheSurfaceFaces) {
  const SurfaceSamples samples = samples_of(testing::sphere_field(1), 60000);
  // Slices of a sphere of equal height have equal areas, along the axes and across the cube's diagonal.
  for (const Vec3& up : {Vec3(1, 0, 0), Vec3(0, 1, 0), Vec3(0, 0, 1), glm::normalize(Vec3(1, 1, 1)), glm::normalize(Vec3(1, -1, 0))}) {
    std::array<int, 10> slices{};
    for (const Vec3& p : samples.points) {
      ++slices[static_cast<std::size_t>(std::clamp(5 * (1 + glm::dot(p - Vec3(0.03, -0.02, 0.01), up)), 0.0, 9.0))];
    }
    const double even = static_cast<double>(samples.points.size()) / 10;
    for (const int n : slices) EXPECT_NEAR(n, even, 0.05 * even) << up.x << " " << up.y << " " << up.z;
  }
}

TEST(SurfaceSamples, BothFacesOfANarrowGapGetTheirShare) {
  // Two boxes with a gap of 1/2000 of their size between them, under a union that keeps them apart.
  BlobTreeBuilder builder;
  const double gap = 0.0005;
  const NodeId left = builder.add(RotatedBox{Vec3(-0.6 - gap / 2, 0, 0), Vec3(0.5), glm::dvec4(1, 0, 0, 0), 0.1, 1});
  const NodeId right = builder.add(RotatedBox{Vec3(0.6 + gap / 2, 0, 0), Vec3(0.5), glm::dvec4(1, 0, 0, 0), 0.1, 1});
  const Field field(builder.build(builder.add(Union{{left, right}})));
  const SurfaceSamples samples = samples_of(field, 20000);
  const double per_face = 1 / (samples.spacing * samples.spacing);   // the flat part of a face is one square metre
  double in_left = 0, in_right = 0;
  for (const Vec3& p : samples.points) {
    if (std::max(std::abs(p.y), std::abs(p.z)) > 0.5) continue;
    in_left += std::abs(p.x + gap / 2) < 1e-6;
    in_right += std::abs(p.x - gap / 2) < 1e-6;
  }
  EXPECT_NEAR(in_left, per_face, 0.05 * per_face);
  EXPECT_NEAR(in_right, per_face, 0.05 * per_face);
}

TEST(SurfaceSamples, TheSameAtAnyThreadCount) {
  const Field field = testing::random_field(7);
  const SurfaceSamples one = samples_of(field, 5000, 1);
  EXPECT_FALSE(one.points.empty());
  EXPECT_EQ(one.points, samples_of(field, 5000, 2).points);
  EXPECT_EQ(one.points, samples_of(field, 5000, 4).points);
}

TEST(SurfaceSamples, NoneWithoutSurface) {
  EXPECT_TRUE(samples_of(testing::field_of(Sphere{Vec3(0), 1, 0.4}), 1000).points.empty());
}

TEST(SurfaceSamples, Cancelled) {
  const std::atomic<bool> cancel{true};
  RunOptions run;
  run.cancel = &cancel;
  EXPECT_FALSE(sample_surface(testing::sphere_field(), 1000, run).has_value());
}

// Bounds leave much of its space in doubt, and there is no surface: finer and finer lines would never find enough.
TEST(SurfaceSamples, SpaceThatBoundsDoNotRuleOutIsNotSearchedBeyondReason) {
  const Field field(random_blobtree(1790, 3));
  const auto samples = sample_surface(field, 20'000, {});
  ASSERT_TRUE(samples.has_value());
  EXPECT_TRUE(samples->points.empty());
  EXPECT_GT(samples->spacing, 1e-4 * testing::longest_side(field));
}

}  // namespace
}  // namespace cambium
