#include "polygonize/verify.h"

#include "blobtree/input_error.h"
#include "polygonize/polygonize.h"
#include "tests/polygonize/sample_fields.h"
#include "tests/polygonize/simple_meshes.h"

#include <gtest/gtest.h>

#include <atomic>
#include <numbers>

namespace cambium {
namespace {

using testing::ball_mesh;

const Vec3 kCenter(0.03, -0.02, 0.01);   // of sphere_field

Verification verified(const Mesh& mesh, const Field& field, VerifyOptions options = {.surface_samples = 20'000}, int threads = 0) {
  RunOptions run;
  run.threads = threads;
  return *verify_mesh(mesh, field, options, run);
}

TEST(Verify, ABallTooLargeIsTooFarByThatMuchBothWays) {
  const Field field = testing::sphere_field(1);
  const Mesh mesh = ball_mesh(6, 1.01, kCenter);
  const double sag = 1.01 * (1 - std::cos(0.5 * std::numbers::pi / 2 / 64 * 1.3));   // of the longest edges' midpoints, about
  const Verification v = verified(mesh, field, {.tolerance = 0.0099, .surface_samples = 20'000});
  EXPECT_TRUE(v.topology.closed_manifold());
  EXPECT_EQ(v.self_intersections, 0u);
  EXPECT_EQ(v.mesh_to_surface.samples, mesh.positions.size() + mesh.triangles.size() * 5 / 2);
  EXPECT_NEAR(v.mesh_to_surface.max, 0.01, 1e-5);
  EXPECT_NEAR(v.mesh_to_surface.mean, 0.01, sag);
  EXPECT_NEAR(glm::length(v.mesh_to_surface.max_at - kCenter), 1.01, 1e-5);
  EXPECT_NEAR(v.surface_to_mesh.max, 0.01, 1e-5);
  EXPECT_NEAR(v.surface_to_mesh.mean, 0.01, sag);
  EXPECT_NEAR(glm::length(v.surface_to_mesh.max_at - kCenter), 1, 1e-5);
  EXPECT_LT(v.mesh_to_surface.within, 0.9);
  EXPECT_GT(v.mesh_to_surface.within, 0.1);
  EXPECT_EQ(v.mesh_to_surface.within_twice, 1);
  EXPECT_LE(v.mesh_to_surface.mean, v.mesh_to_surface.p99);
  EXPECT_LE(v.mesh_to_surface.p99, v.mesh_to_surface.p999);
  EXPECT_LE(v.mesh_to_surface.p999, v.mesh_to_surface.max);
}

TEST(Verify, AMeshOnTheSurfaceIsOffByTheSagOfItsTriangles) {
  const Field field = testing::sphere_field(1);
  const Mesh mesh = ball_mesh(4, 1, kCenter);
  double deepest = 0;
  for (const auto& t : mesh.triangles) {
    const Vec3 centroid = (mesh.positions[t[0]] + mesh.positions[t[1]] + mesh.positions[t[2]]) / 3.0;
    deepest = std::max(deepest, 1 - glm::length(centroid - kCenter));
    for (std::size_t k = 0; k < 3; ++k) {
      deepest = std::max(deepest, 1 - glm::length(0.5 * (mesh.positions[t[k]] + mesh.positions[t[(k + 1) % 3]]) - kCenter));
    }
  }
  const Verification v = verified(mesh, field);
  EXPECT_NEAR(v.mesh_to_surface.max, deepest, 1e-3 * deepest);
  EXPECT_NEAR(v.surface_to_mesh.max, deepest, 0.02 * deepest);
}

// Exactly what a mesh made with cells too large for it would lose.
TEST(Verify, AMissingTwigIsSeenFromTheSurface) {
  BlobTreeBuilder builder;
  const NodeId trunk = builder.add(Capsule{Vec3(0), Vec3(0, 0, 2), 0.2, 1});
  const NodeId twig = builder.add(Capsule{Vec3(0, 0, 1), Vec3(1, 0, 1.2), 0.004, 1});
  const Field whole(builder.build(builder.add(Union{{trunk, twig}})));
  const Field bare = testing::field_of(Capsule{Vec3(0), Vec3(0, 0, 2), 0.2, 1});
  PolygonizeOptions options;
  options.voxel = 0.04;
  const Mesh mesh = polygonize(bare, options, {})->mesh;
  const Verification v = verified(mesh, whole, {.tolerance = 0.01, .surface_samples = 50'000});
  EXPECT_LT(v.mesh_to_surface.max, 0.005);
  EXPECT_NEAR(v.surface_to_mesh.max, 0.81, 0.05);
  EXPECT_GT(v.surface_to_mesh.max_at.x, 0.9);
  EXPECT_LT(v.surface_to_mesh.within, 1);
  EXPECT_EQ(verified(mesh, bare, {.tolerance = 0.01, .surface_samples = 50'000}).surface_to_mesh.within, 1);
}

TEST(Verify, APieceThatFloatsWhereTheFieldIsZeroIsFarOff) {
  const Field field = testing::sphere_field(1);
  const Vec3 away(8, 3, -2);
  const Mesh mesh = testing::joined(ball_mesh(4, 1, kCenter), ball_mesh(1, 0.01, kCenter + away));
  const Verification v = verified(mesh, field);
  EXPECT_NEAR(v.mesh_to_surface.max, glm::length(away) - 1 + 0.01, 0.01);
  EXPECT_LT(v.surface_to_mesh.max, 0.01);
  EXPECT_EQ(v.topology.components, 2u);
}

TEST(Verify, AHoleIsSeenFromTheSurface) {
  const Field field = testing::sphere_field(1);
  Mesh mesh = ball_mesh(5, 1, kCenter);
  std::erase_if(mesh.triangles, [&](const auto& t) { return mesh.positions[t[0]].z > 0.9 + kCenter.z; });
  const Verification v = verified(mesh, field);
  EXPECT_GT(v.topology.boundary_edges, 0u);
  EXPECT_GT(v.surface_to_mesh.max, 0.3);
  EXPECT_LT(v.mesh_to_surface.max, 0.002);
}

// Two boxes a hair apart: a mesh that closes the gap misses what no cell of the tolerance's size can see.
TEST(Verify, WhatIsInACrackIsToldApart) {
  BlobTreeBuilder builder;
  const auto slab = [&](double x) {
    return builder.add(RotatedBox{Vec3(x, 0, 0), Vec3(0.5), glm::dvec4(1, 0, 0, 0), 0.1, 1});
  };
  const double gap = 0.001;
  const NodeId left = slab(-0.6 - gap / 2), right = slab(0.6 + gap / 2);
  const Field field(builder.build(builder.add(Union{{left, right}})));
  const Mesh around = ball_mesh(3, 1.2);   // far from both faces of the gap
  const VerifyOptions coarse{.tolerance = 0.01, .surface_samples = 20'000}, fine{.tolerance = 0.0005, .surface_samples = 20'000};
  const Verification v = verified(around, field, coarse);
  const double in_gap = static_cast<double>(v.in_cracks) / static_cast<double>(v.surface_to_mesh.samples);
  EXPECT_NEAR(in_gap, 2 * 1.12 / (2 * 8.01), 0.01);   // square metres: two faces with the rounding beside them, of two boxes
  EXPECT_EQ(v.open_surface_to_mesh.samples + v.in_cracks, v.surface_to_mesh.samples);
  EXPECT_EQ(verified(around, field, fine).in_cracks, 0u);
}

TEST(Verify, CrossingTrianglesAreCountedUnlessNotAskedFor) {
  const Field field = testing::sphere_field(1);
  const Mesh mesh = testing::joined(ball_mesh(3, 1, kCenter), ball_mesh(3, 1, kCenter + Vec3(0.5, 0.1, 0.2)));
  EXPECT_GT(verified(mesh, field).self_intersections, 10u);
  EXPECT_EQ(verified(mesh, field, {.surface_samples = 1000, .self_intersections = false}).self_intersections, 0u);
}

// A ball of two halves, one of them a little too large and of few triangles.
TEST(Verify, SamplesOfTheMeshAreEvenOverItsAreaWhereTheirNumberIsGiven) {
  const Field field = testing::sphere_field(1);
  Mesh fine = ball_mesh(6, 1, kCenter), coarse = ball_mesh(3, 1.05, kCenter);
  std::erase_if(fine.triangles, [&](const auto& t) { return fine.positions[t[0]].z < kCenter.z; });
  std::erase_if(coarse.triangles, [&](const auto& t) { return coarse.positions[t[0]].z >= kCenter.z; });
  const Mesh mesh = testing::joined(fine, coarse);
  ASSERT_LT(coarse.triangles.size() * 20, fine.triangles.size());
  VerifyOptions options{.tolerance = 0.01, .surface_samples = 1000, .mesh_samples = 20'000};
  const DistanceFigures even = verified(mesh, field, options).mesh_to_surface;
  EXPECT_NEAR(static_cast<double>(even.samples), 20'000, 2);
  const auto area = [](const Mesh& m) {
    double sum = 0;
    for (const auto& [a, b, c] : m.triangles)
      sum += 0.5 * glm::length(glm::cross(m.positions[b] - m.positions[a], m.positions[c] - m.positions[a]));
    return sum;
  };
  EXPECT_NEAR(even.within, area(fine) / area(mesh), 0.01);
  EXPECT_NEAR(even.max, 0.05, 0.001);
  options.mesh_samples.reset();
  const DistanceFigures all = verified(mesh, field, options).mesh_to_surface;
  EXPECT_GT(all.within, 0.9);
  EXPECT_GT(all.samples, 2 * mesh.triangles.size());
}

TEST(Verify, AMeshWithoutAreaHasNoSamplesEvenOverIt) {
  Mesh mesh;
  mesh.positions = {Vec3(0), Vec3(1, 0, 0), Vec3(2, 0, 0)};
  mesh.triangles = {{0, 1, 2}};
  EXPECT_EQ(verified(mesh, testing::sphere_field(1), {.surface_samples = 1000, .mesh_samples = 1000}).mesh_to_surface.samples, 0u);
}

TEST(Verify, WithNoSurfaceOrNoMeshThereIsNoDistance) {
  const Field field = testing::sphere_field(1), nothing = testing::field_of(Sphere{Vec3(0), 1, 0.4});   // never reaches kIso
  const Verification bare = verified(Mesh{}, field);
  EXPECT_EQ(bare.mesh_to_surface.samples, 0u);
  EXPECT_EQ(bare.surface_to_mesh.max, kInfinity);
  const Verification stray = verified(ball_mesh(1, 1), nothing);
  EXPECT_EQ(stray.surface_to_mesh.samples, 0u);
  EXPECT_EQ(stray.mesh_to_surface.max, kInfinity);
}

TEST(Verify, TheSameAtAnyThreadCount) {
  const Field field = testing::fork_field();
  PolygonizeOptions options;
  options.voxel = 0.05;
  const Mesh mesh = polygonize(field, options, {})->mesh;
  VerifyOptions how{.tolerance = 0.01, .surface_samples = 5000};
  for (const std::optional<std::size_t> samples : {std::optional<std::size_t>(), std::optional<std::size_t>(5000)}) {
    how.mesh_samples = samples;
    const Verification one = verified(mesh, field, how, 1);
    for (const int threads : {2, 4}) {
      const Verification other = verified(mesh, field, how, threads);
      for (const auto& [a, b] : {std::pair{one.mesh_to_surface, other.mesh_to_surface}, {one.surface_to_mesh, other.surface_to_mesh}}) {
        EXPECT_EQ(a.samples, b.samples);
        EXPECT_EQ(a.max, b.max);
        EXPECT_EQ(a.p999, b.p999);
        EXPECT_EQ(a.p99, b.p99);
        EXPECT_EQ(a.mean, b.mean);
        EXPECT_EQ(a.max_at, b.max_at);
        EXPECT_EQ(a.within, b.within);
      }
    }
  }
}

TEST(Verify, BadInputIsRefused) {
  const Field field = testing::sphere_field(1);
  Mesh mesh = ball_mesh(1, 1);
  EXPECT_THROW(verified(mesh, field, {.tolerance = -1}), InputError);
  EXPECT_THROW(verified(mesh, field, {.tolerance = std::nan("")}), InputError);
  EXPECT_THROW(verified(mesh, field, {.surface_samples = 0}), InputError);
  EXPECT_THROW(verified(mesh, field, {.mesh_samples = 0}), InputError);
  mesh.positions[3].y = kInfinity;
  EXPECT_THROW(verified(mesh, field), InputError);
  mesh = ball_mesh(1, 1);
  mesh.triangles[4][1] = 5000;
  EXPECT_THROW(verified(mesh, field), InputError);
}

TEST(Verify, Cancelled) {
  const std::atomic<bool> cancel{true};
  RunOptions run;
  run.cancel = &cancel;
  EXPECT_FALSE(verify_mesh(ball_mesh(2, 1, kCenter), testing::sphere_field(1), {}, run).has_value());
}

}  // namespace
}  // namespace cambium
