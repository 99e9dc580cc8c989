#include "polygonize/polygonize.h"

#include "blobtree/input_error.h"
#include "tests/polygonize/mesh_checks.h"
#include "tests/polygonize/sample_fields.h"

#include <gtest/gtest.h>

#include <atomic>
#include <chrono>
#include <numbers>
#include <thread>

namespace cambium {
namespace {

using testing::check_mesh;
using testing::MeshChecks;

Polygonized mesh_of(const Field& field, double voxel, int threads = 0) {
  PolygonizeOptions options;
  options.voxel = voxel;
  RunOptions run;
  run.threads = threads;
  auto result = polygonize(field, options, run);
  EXPECT_TRUE(result.has_value());
  return result ? *std::move(result) : Polygonized{};
}

// Whether the field is on the other side somewhere on a sphere: amid two sheets or in a twig its slope says nothing.
bool surface_within(const Field& field, const Vec3& p, double radius) {
  const bool inside = field.value(p) >= kIso;
  for (int direction = 0; direction < 27; ++direction) {
    const Vec3 d(direction % 3 - 1, direction / 3 % 3 - 1, direction / 9 - 1);
    for (const double way : {0.3, 0.6, 1.0}) {
      if (d != Vec3(0) && (field.value(p + way * radius * glm::normalize(d)) >= kIso) != inside) return true;
    }
  }
  return false;
}

// Closed, outward, no degenerate triangle, and every vertex within a cell, by the field in double.
MeshChecks expect_sound(const Field& field, const Polygonized& made) {
  const MeshChecks checks = check_mesh(made.mesh);
  EXPECT_TRUE(checks.closed_manifold()) << checks;
  EXPECT_EQ(checks.degenerate_triangles, 0u) << checks;
  EXPECT_EQ(checks.components, made.report.components);
  EXPECT_EQ(made.mesh.normals.size(), made.mesh.positions.size());
  for (std::size_t i = 0; i < made.mesh.positions.size(); ++i) {
    const Sample sample = field.sample(made.mesh.positions[i]);
    const double slope = glm::length(sample.gradient);
    const bool near = slope > 0 && std::abs(sample.value - kIso) / slope <= made.report.largest_cell;
    EXPECT_TRUE(near || surface_within(field, made.mesh.positions[i], 1.8 * made.report.largest_cell)) << "vertex " << i;
    EXPECT_NEAR(glm::length(made.mesh.normals[i]), 1, 1e-4);
  }
  return checks;
}

TEST(Polygonize, ASphereIsRoundClosedAndOutward) {
  const Field field = testing::sphere_field();
  const Polygonized made = mesh_of(field, 0.1);
  const MeshChecks checks = expect_sound(field, made);
  EXPECT_EQ(checks.euler, 2);
  EXPECT_EQ(checks.components, 1u);
  EXPECT_EQ(checks.inward_components, 0u);
  for (std::size_t i = 0; i < made.mesh.positions.size(); ++i) {
    const Vec3 from_center = made.mesh.positions[i] - Vec3(0.03, -0.02, 0.01);
    EXPECT_NEAR(glm::length(from_center), 1, 0.04 * made.report.largest_cell);   // a grazed cell holds its vertex back
    EXPECT_GT(glm::dot(glm::normalize(from_center), Vec3(made.mesh.normals[i])), 0.999);
  }
}

TEST(Polygonize, ATorusHasEulerNumberZero) {
  const Field field = testing::torus_field();
  const MeshChecks checks = expect_sound(field, mesh_of(field, 0.07));
  EXPECT_EQ(checks.euler, 0);
  EXPECT_EQ(checks.components, 1u);
}

TEST(Polygonize, ChainForkAndContactAreOnePieceEach) {
  for (const Field& field : {testing::chain_field(), testing::fork_field(), testing::contact_field()}) {
    for (const double voxel : {0.09, 0.04}) {
      const MeshChecks checks = expect_sound(field, mesh_of(field, voxel));
      EXPECT_EQ(checks.euler, 2) << checks;
      EXPECT_EQ(checks.components, 1u);
      EXPECT_EQ(checks.inward_components, 0u);
    }
  }
}

TEST(Polygonize, ACreviceThinnerThanACellLeavesNoBubbles) {
  const Field field = testing::fork_field();   // its ridge's lips nearly touch
  const Polygonized made = mesh_of(field, 0.01);
  EXPECT_GT(made.report.closed_voids, 0u) << "the case this is for";
  EXPECT_EQ(expect_sound(field, made).components, 1u);
}

TEST(Polygonize, RandomBlobTreesAreManifoldAtAnyCellSize) {
  for (unsigned seed = 1; seed <= 16; ++seed) {
    SCOPED_TRACE(seed);
    const Field field = testing::random_field(seed);
    for (const double voxel : {0.31, 0.13, 0.07}) expect_sound(field, mesh_of(field, voxel));
  }
}

TEST(Polygonize, TwigsThinnerThanAGivenCellBreakButStayClosed) {
  const Field field = testing::field_of(Chain{{{Vec3(0, 0, 0), 0.02}, {Vec3(0.7, 1.1, 2.3), 0.01}}, 1});
  const Polygonized made = mesh_of(field, 0.035);
  expect_sound(field, made);
  EXPECT_GT(made.report.components, 1u);
}

TEST(Polygonize, ATwigOnAGreatTrunkHasItsSidesAndTheTrunkLargeCells) {
  BlobTreeBuilder b;
  const NodeId trunk = b.add(Chain{{{Vec3(0, 0, 0), 0.3}, {Vec3(0, 0, 3), 0.25}}, 1});
  const NodeId twig = b.add(Chain{{{Vec3(0, 0, 2), 0.004}, {Vec3(1, 0.3, 2.4), 0.002}}, 1});
  const Field field(b.build(b.add(Fork{trunk, {{twig, Vec3(0, 0, 2), Vec3(0, 0, 1), 0.003, 0.6}}})));
  const auto made = polygonize(field, {.tolerance = 0.001}, {});
  ASSERT_TRUE(made.has_value());
  const MeshChecks checks = check_mesh(made->mesh);
  EXPECT_TRUE(checks.closed_manifold()) << checks;
  EXPECT_EQ(checks.components, 1u);
  EXPECT_EQ(checks.euler, 2);
  EXPECT_GT(made->report.largest_cell, 10 * made->report.smallest_cell);
  double tip = 0;
  for (const Vec3& p : made->mesh.positions) tip = std::max(tip, p.x);
  EXPECT_NEAR(tip, 1.002, 0.001);
}

TEST(Polygonize, VolumeConvergesWithTheSquareOfTheCell) {
  const Field field = testing::sphere_field();
  const double exact = 4.0 / 3 * std::numbers::pi;
  double last = 1e9;
  for (const double voxel : {0.2, 0.1, 0.05}) {
    const double error = std::abs(check_mesh(mesh_of(field, voxel).mesh).volume - exact);
    EXPECT_LT(error, 0.35 * last) << voxel;
    last = error;
  }
  EXPECT_LT(last, 2e-3 * exact);
}

TEST(Polygonize, ACutHasASharpEdgeAndAFlatFace) {
  const Field field = testing::cut_box_field();
  const double voxel = 0.07;
  const Polygonized made = mesh_of(field, voxel);
  EXPECT_EQ(expect_sound(field, made).euler, 2);
  // Where the plane x + y = 1 meets the top z = 1.1, away from the box's rounded sides: cells along this edge must have their
  // vertex on the edge itself.
  int on_edge = 0, on_face = 0;
  for (const Vec3& p : made.mesh.positions) {
    const double from_plane = (p.x + p.y - 1) / std::sqrt(2.0);
    if (std::abs(from_plane) > 0.5 * voxel || std::abs(p.x - p.y) > 1.2) continue;
    if (std::abs(p.z) < 0.9) {
      EXPECT_NEAR(from_plane, 0, 1e-3 * voxel);
      ++on_face;
    }
    if (std::abs(p.z - 1.1) < 0.02 * voxel && std::abs(from_plane) < 0.02 * voxel) ++on_edge;
  }
  EXPECT_GT(on_face, 100);
  EXPECT_GT(on_edge, 1.2 * std::sqrt(2.0) / 2 / voxel);
}

TEST(Polygonize, SameBytesForAnyNumberOfThreads) {
  const Field field = testing::random_field(5);
  const Polygonized one = mesh_of(field, 0.03, 1);
  for (const int threads : {2, 4}) {
    const Polygonized other = mesh_of(field, 0.03, threads);
    EXPECT_EQ(one.mesh.positions, other.mesh.positions);
    EXPECT_EQ(one.mesh.normals, other.mesh.normals);
    EXPECT_EQ(one.mesh.triangles, other.mesh.triangles);
  }
}

TEST(Polygonize, AThinTwigFarFromTheOriginKeepsItsShape) {
  const Vec3 far(31.3, -27.1, 30.2);
  const Field field = testing::field_of(Capsule{far, far + Vec3(0.01, 0.004, 0.02), 0.001, 1});
  const Polygonized made = mesh_of(field, 0.0005);
  const MeshChecks checks = expect_sound(field, made);
  EXPECT_EQ(checks.euler, 2);
  const double length = glm::length(Vec3(0.01, 0.004, 0.02));
  const double exact = std::numbers::pi * 1e-6 * length + 4.0 / 3 * std::numbers::pi * 1e-9;
  double volume = 0;   // about its own place: 30 m away the plain sum of the checks loses digits
  for (const auto& t : made.mesh.triangles) {
    const auto at = [&](int i) { return made.mesh.positions[t[i]] - far; };
    volume += glm::dot(at(0), glm::cross(at(1), at(2))) / 6;
  }
  EXPECT_NEAR(volume / exact, 1, 0.05);
}

TEST(Polygonize, TheDefaultKeepsTheThinnestTwigWhole) {
  const Field field = testing::chain_field();
  const auto made = polygonize(field, {}, {});
  ASSERT_TRUE(made.has_value());
  EXPECT_NEAR(made->report.tolerance, 0.05 / 8, 1e-9);
  EXPECT_EQ(check_mesh(made->mesh).components, 1u);
}

TEST(Polygonize, EveryPolygonIsWithinTheToleranceAndFinerOnesHaveMore) {
  const Field field = testing::chain_field();
  std::size_t last = 0;
  for (const double tolerance : {0.02, 0.005, 0.001}) {
    const auto made = polygonize(field, {.tolerance = tolerance}, {});
    ASSERT_TRUE(made.has_value());
    EXPECT_TRUE(check_mesh(made->mesh).closed_manifold());
    EXPECT_GT(made->mesh.triangles.size(), last);
    last = made->mesh.triangles.size();
    for (const auto& t : made->mesh.triangles) {
      const Sample s = field.sample((made->mesh.positions[t[0]] + made->mesh.positions[t[1]] + made->mesh.positions[t[2]]) / 3.0);
      EXPECT_LT(std::abs(s.value - kIso) / glm::length(s.gradient), 1.5 * tolerance);
    }
  }
}

TEST(Polygonize, MoreSidesAndAPreviewAreWhatTheySay) {
  const Field field = testing::chain_field();
  const auto triangles = [&](const PolygonizeOptions& options) { return polygonize(field, options, {})->mesh.triangles.size(); };
  const std::size_t plain = triangles({.tolerance = 0.05});
  EXPECT_GT(triangles({.tolerance = 0.05, .min_sides = 24}), 2 * plain);
  EXPECT_LT(triangles({.tolerance = 0.001, .preview = true}), triangles({.tolerance = 0.001}) / 4);
}

TEST(Polygonize, BadLengthsAndGridsTooFineAreInputErrors) {
  const Field field = testing::sphere_field();
  PolygonizeOptions options;
  for (const double bad : {0.0, -1.0, std::nan(""), kInfinity, 1e-9}) {
    options.voxel = bad;
    EXPECT_THROW(polygonize(field, options, {}), InputError) << bad;
  }
  options.voxel.reset();
  options.tolerance = -0.1;
  EXPECT_THROW(polygonize(field, options, {}), InputError);
  options.tolerance = 0.1;
  options.voxel = 0.1;
  EXPECT_THROW(polygonize(field, options, {}), InputError);
  options.voxel.reset();
  options.min_sides = 2;
  EXPECT_THROW(polygonize(field, options, {}), InputError);
}

TEST(Polygonize, CancellingGivesNothingAndSoon) {
  const Field field = testing::random_field(3);
  PolygonizeOptions options;
  options.voxel = 0.002;
  std::atomic<bool> cancel{false};
  RunOptions run;
  run.cancel = &cancel;
  std::chrono::steady_clock::time_point asked;
  std::thread waiter([&] {
    std::this_thread::sleep_for(std::chrono::milliseconds(100));
    asked = std::chrono::steady_clock::now();
    cancel = true;
  });
  const auto made = polygonize(field, options, run);
  const auto waited = std::chrono::steady_clock::now();
  waiter.join();
  EXPECT_FALSE(made.has_value());
  EXPECT_LT(waited - asked, std::chrono::seconds(2));   // a hundredth of it as a rule; machines under load vary
}

TEST(Polygonize, ProgressRisesToOneInEveryStage) {
  PolygonizeOptions options;
  options.voxel = 0.05;
  RunOptions run;
  std::vector<std::pair<std::string, double>> told;
  run.progress = [&](std::string_view stage, double fraction) { told.emplace_back(stage, fraction); };
  ASSERT_TRUE(polygonize(testing::chain_field(), options, run).has_value());
  ASSERT_GT(told.size(), 4u);
  for (std::size_t i = 1; i < told.size(); ++i) {
    if (told[i].first == told[i - 1].first) {
      EXPECT_GE(told[i].second, told[i - 1].second);
    } else {
      EXPECT_EQ(told[i - 1].second, 1);
    }
  }
  EXPECT_EQ(told.back().second, 1);
}

}  // namespace
}  // namespace cambium
