#include "polygonize/unseen_surface.h"

#include "polygonize/polygonize.h"
#include "polygonize/surface_samples.h"
#include "polygonize/verify.h"
#include "tests/polygonize/octrees.h"
#include "tests/polygonize/sample_fields.h"

#include <gtest/gtest.h>
#include <tbb/global_control.h>

#include <algorithm>
#include <atomic>
#include <tuple>

namespace cambium {
namespace {

using testing::coarse_octree;
using testing::OnOctree;

const Vec3 kAcross = glm::normalize(Vec3(0.3, 0.5, 1));
const Vec3 kMiddle(0.31, 0.07, 0.11);   // of plates and slots

HalfSpace half_space(double along, double side) { return {kMiddle + along * kAcross, side * kAcross, 0.01}; }

/// What two parallel cuts leave of a ball of radius 1.
Field plate(double thickness) {
  BlobTreeBuilder builder;
  const NodeId ball = builder.add(Sphere{Vec3(0), 1, 1});
  const NodeId above = builder.add(half_space(-0.5 * thickness, -1)), below = builder.add(half_space(0.5 * thickness, 1));
  return Field(builder.build(builder.add(Intersection{{ball, above, below}})));
}

/// The same taken out of the ball.
Field slotted(double width) {
  BlobTreeBuilder builder;
  const NodeId ball = builder.add(Sphere{Vec3(0), 1, 1}), core = builder.add(Sphere{Vec3(0), 0.6, 1});
  const NodeId above = builder.add(half_space(-0.5 * width, -1)), below = builder.add(half_space(0.5 * width, 1));
  const NodeId slot = builder.add(Intersection{{core, above, below}});
  return Field(builder.build(builder.add(Difference{{ball, slot}})));
}

Polygonized meshed(const Field& field, double tolerance) {
  PolygonizeOptions options;
  options.tolerance = tolerance;
  return polygonize(field, options, {}).value();
}

DistanceFigures surface_to_mesh(const Field& field, double tolerance) {
  const Mesh mesh = meshed(field, tolerance).mesh;
  return verify_mesh(mesh, field, {.tolerance = tolerance, .surface_samples = 20'000}, {})->surface_to_mesh;
}

auto keys(const SurfaceOctree& tree) {
  std::vector<std::tuple<CellPlace, int, int>> all;
  for (const OctreeLeaf& leaf : tree.leaves()) all.emplace_back(leaf.place, leaf.level, leaf.mask);
  return all;
}

TEST(UnseenSurface, APlateThinnerThanTheCellsIsMeshedWhole) {
  for (const double thickness : {0.02, 0.05}) {
    SCOPED_TRACE(thickness);
    EXPECT_EQ(surface_to_mesh(plate(thickness), 0.008).within_twice, 1);
  }
}

TEST(UnseenSurface, ASlotThinnerThanTheCellsIsMeshedWhole) {
  for (const double width : {0.02, 0.05}) {
    SCOPED_TRACE(width);
    EXPECT_EQ(surface_to_mesh(slotted(width), 0.008).within_twice, 1);
  }
}

TEST(UnseenSurface, APlateThinnerThanTheSmallestCellsIsReportedAllOverAndNowhereElse) {
  constexpr double kCell = 0.25, kUnit = kCell / 8;
  const Field field = plate(1e-4);
  OnOctree on = coarse_octree(field, kCell, 3);
  std::vector<Vec3> uncertain;
  ASSERT_TRUE(show_unseen_surface(on.tree, on.cover, uncertain, {}));
  for (const Vec3& p : uncertain) EXPECT_LT(std::abs(glm::dot(p - kMiddle, kAcross)), kUnit);
  const SurfaceSamples samples = sample_surface(field, 2000, {}).value();
  for (const Vec3& on_plate : samples.points) {
    const bool reported = std::any_of(uncertain.begin(), uncertain.end(), [&](const Vec3& p) { return glm::length(p - on_plate) < 2 * kCell; });
    ASSERT_TRUE(reported) << on_plate.x << ' ' << on_plate.y << ' ' << on_plate.z;
  }
}

TEST(UnseenSurface, AMeshThatIsEmptyBecauseAllIsThinSaysSo) {
  const Polygonized made = meshed(plate(1e-3), 0.02);
  EXPECT_TRUE(made.mesh.triangles.empty()) << "the case this is for";
  EXPECT_FALSE(made.report.unseen.empty());
}

TEST(UnseenSurface, WhatLeavesShowIsLeftAsItIs) {
  for (const Field& field : {testing::sphere_field(), testing::torus_field(), testing::cut_box_field()}) {
    OnOctree on = coarse_octree(field, 0.1, 3, {.radii = 0.25});
    const auto before = keys(on.tree);
    std::vector<Vec3> uncertain;
    ASSERT_TRUE(show_unseen_surface(on.tree, on.cover, uncertain, {}));
    EXPECT_EQ(keys(on.tree), before);
    EXPECT_TRUE(uncertain.empty());
  }
}

TEST(UnseenSurface, NothingOfThemIsReportedWhereFieldsAreMeshedWell) {
  for (const Field& field : {testing::fork_field(), testing::contact_field(), testing::cut_box_field(), testing::chain_field()}) {
    EXPECT_TRUE(meshed(field, 0.004).report.unseen.empty());
  }
}

TEST(UnseenSurface, CutsAndReportsAreTheSameAtAnyThreadCount) {
  const auto found_with = [](int threads, double thickness) {
    const tbb::global_control control(tbb::global_control::max_allowed_parallelism, static_cast<std::size_t>(threads));
    OnOctree on = coarse_octree(plate(thickness), 0.5, 6, {.radii = kInfinity, .shortest_gap = 0.005});
    const std::size_t before = on.tree.leaves().size();
    std::vector<Vec3> uncertain;
    EXPECT_TRUE(show_unseen_surface(on.tree, on.cover, uncertain, {}));
    return std::tuple(keys(on.tree), uncertain, on.tree.leaves().size() - before);
  };
  const auto shown = found_with(1, 0.016), doubted = found_with(1, 0.001);
  EXPECT_GT(std::get<2>(shown), 0u);
  EXPECT_FALSE(std::get<1>(doubted).empty());
  for (const int threads : {2, 4}) {
    EXPECT_EQ(found_with(threads, 0.016), shown) << threads << " threads";
    EXPECT_EQ(found_with(threads, 0.001), doubted) << threads << " threads";
  }
}

TEST(UnseenSurface, AJobThatIsCancelledStops) {
  OnOctree on = coarse_octree(plate(0.02), 0.25, 5);
  const std::atomic<bool> cancel{true};
  RunOptions run;
  run.cancel = &cancel;
  std::vector<Vec3> uncertain;
  EXPECT_FALSE(show_unseen_surface(on.tree, on.cover, uncertain, run));
}

}  // namespace
}  // namespace cambium
