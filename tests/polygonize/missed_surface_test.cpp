#include "polygonize/missed_surface.h"

#include "polygonize/polygonize.h"
#include "polygonize/verify.h"
#include "tests/polygonize/octrees.h"
#include "tests/polygonize/sample_fields.h"

#include <gtest/gtest.h>
#include <tbb/global_control.h>

#include <algorithm>
#include <atomic>
#include <utility>

namespace cambium {
namespace {

using testing::coarse_octree;
using testing::OnOctree;

constexpr double kTolerance = 0.008;
const Vec3 kAcross = glm::normalize(Vec3(0.3, 0.5, 1));

HalfSpace half_space(double along, double side) { return {along * kAcross, side * kAcross, 0.01}; }

/// A ball cut flat, and over its face, a little apart, a slice of the same ball: no thicker than that, in leaves that show the face.
Field sliced(double thickness) {
  constexpr double kGap = 0.05;
  BlobTreeBuilder builder;
  const NodeId ball = builder.add(Sphere{Vec3(0), 1, 1}), other = builder.add(Sphere{Vec3(0), 1, 1});
  const NodeId face = builder.add(half_space(0.1, 1));
  const NodeId above = builder.add(half_space(0.1 + kGap, -1)), below = builder.add(half_space(0.1 + kGap + thickness, 1));
  const NodeId rest = builder.add(Intersection{{ball, face}}), slice = builder.add(Intersection{{other, above, below}});
  return Field(builder.build(builder.add(Union{{rest, slice}})));
}

Polygonized meshed(const Field& field) {
  PolygonizeOptions options;
  options.tolerance = kTolerance;
  return polygonize(field, options, {}).value();
}

struct Contoured {
  OnOctree on;
  Contour contour;
  std::vector<Vec3> positions;
  std::vector<std::optional<Split>> splits;

  explicit Contoured(const Field& field, double cell = 0.25) : on(coarse_octree(field, cell, 6, {.radii = kInfinity, .shortest_gap = 0.005})) {
    contour = testing::contour_on(on);
    positions = testing::positions_of(contour);
    splits = testing::splits_of(contour);
  }
  std::vector<std::uint32_t> found_by(MissedSurface& missed, const RunOptions& run = {}) const {
    return missed.find(on.tree, on.cover, contour, {positions, splits, kTolerance}, run).value();
  }
};

TEST(MissedSurface, ASheetBesideAnotherThatLeavesShowIsMeshedWhole) {
  for (const double thickness : {0.02, 0.05}) {
    SCOPED_TRACE(thickness);
    const Field field = sliced(thickness);
    const Polygonized made = meshed(field);
    EXPECT_EQ(made.report.components, 2u);
    const Verification v = *verify_mesh(made.mesh, field, {.tolerance = kTolerance, .surface_samples = 20'000}, {});
    EXPECT_EQ(v.surface_to_mesh.within_twice, 1);
    EXPECT_EQ(v.self_intersections, 0u);
  }
}

TEST(MissedSurface, ASheetTooThinToBeShownIsReportedAllOverAndNowhereElse) {
  constexpr double kThickness = 1e-3, kAlong = 0.15 + 0.5 * kThickness;
  const Field field = sliced(kThickness);
  const Polygonized made = meshed(field);
  EXPECT_EQ(made.report.components, 1u) << "the case this is for";
  for (const Vec3& p : made.report.unseen) EXPECT_LT(std::abs(glm::dot(p, kAcross) - kAlong), kTolerance);
  Draws draws(3);
  for (int i = 0; i < 4000; ++i) {
    const Vec3 anywhere = draws.point({Vec3(-1), Vec3(1)});
    const Vec3 p = anywhere + (kAlong - glm::dot(anywhere, kAcross)) * kAcross;
    if (glm::length(p) > 0.99) continue;
    ASSERT_GT(field.value(p), kIso);
    const auto near = [&](const Vec3& q) { return glm::length(p - q) < 8 * kTolerance; };
    const PolygonizeReport& report = made.report;   // where a corner happens to be in the slice there are crumbs of it
    ASSERT_TRUE(std::any_of(report.unseen.begin(), report.unseen.end(), near) ||
                std::any_of(report.left_out.begin(), report.left_out.end(), near))
        << p.x << ' ' << p.y << ' ' << p.z;
  }
}

TEST(MissedSurface, LeavesAreNamedUntilTheyShowIt) {
  const Field field = sliced(0.03);
  Contoured made(field);
  MissedSurface missed;
  const auto first = made.found_by(missed);
  EXPECT_GT(first.size(), 10u);
  EXPECT_TRUE(std::is_sorted(first.begin(), first.end()));
  EXPECT_TRUE(made.found_by(missed).empty()) << "no leaf is new";
}

TEST(MissedSurface, NothingIsMissedWhereLeavesShowAll) {
  for (const Field& field : {testing::sphere_field(), testing::torus_field(), testing::cut_box_field()}) {
    const Contoured made(field, 0.05);
    MissedSurface missed;
    EXPECT_TRUE(made.found_by(missed).empty());
    EXPECT_TRUE(missed.uncertain(made.on.tree).empty());
  }
}

TEST(MissedSurface, WhatIsFoundIsTheSameAtAnyThreadCount) {
  const Contoured shown(sliced(0.03)), thin(sliced(1e-4));
  const auto found_with = [&](int threads) {
    const tbb::global_control control(tbb::global_control::max_allowed_parallelism, static_cast<std::size_t>(threads));
    MissedSurface missed, doubted;
    auto leaves = shown.found_by(missed);
    thin.found_by(doubted);
    return std::pair(std::move(leaves), doubted.uncertain(thin.on.tree));
  };
  const auto one = found_with(1);
  EXPECT_FALSE(one.first.empty());
  EXPECT_FALSE(one.second.empty());
  for (const int threads : {2, 4}) EXPECT_EQ(found_with(threads), one) << threads << " threads";
}

TEST(MissedSurface, AJobThatIsCancelledStops) {
  const Contoured made(sliced(0.03));
  const std::atomic<bool> cancel{true};
  RunOptions run;
  run.cancel = &cancel;
  MissedSurface missed;
  EXPECT_FALSE(missed.find(made.on.tree, made.on.cover, made.contour, {made.positions, made.splits, kTolerance}, run).has_value());
}

}  // namespace
}  // namespace cambium
