#include "polygonize/mesh_components.h"

#include "tests/polygonize/mesh_checks.h"

#include <gtest/gtest.h>
#include <tbb/task_arena.h>

#include <atomic>
#include <cmath>
#include <numbers>

namespace cambium {
namespace {

// A tetrahedron of the given size; inward turns it inside out.
void add_tetrahedron(Mesh& mesh, const Vec3& at, double size, bool inward) {
  const auto first = static_cast<std::uint32_t>(mesh.positions.size());
  for (const Vec3& p : {Vec3(0), Vec3(1, 0, 0), Vec3(0, 1, 0), Vec3(0, 0, 1)}) {
    mesh.positions.push_back(at + size * p);
    mesh.normals.push_back(glm::vec3(p));
    mesh.colors.push_back({static_cast<std::uint8_t>(first), 0, 0, 255});
  }
  for (std::array<std::uint32_t, 3> t : {std::array<std::uint32_t, 3>{0, 2, 1}, {0, 1, 3}, {1, 2, 3}, {0, 3, 2}}) {
    if (inward) std::swap(t[1], t[2]);
    mesh.triangles.push_back({first + t[0], first + t[1], first + t[2]});
  }
}

TEST(MeshComponents, OnlyThinVoidsAreRemoved) {
  Mesh mesh;
  const Vec3 far(1000, 2000, -500);
  add_tetrahedron(mesh, far, 10, false);
  add_tetrahedron(mesh, far + 1.0, 0.01, true);    // a bubble
  add_tetrahedron(mesh, far + 2.0, 2, true);       // a hollow worth keeping
  add_tetrahedron(mesh, far + 20.0, 0.01, false);  // a bead
  mesh.creases = {{0, 1}, {4, 5}, {8, 9}};
  const auto report = drop_small_components(mesh, 0.1, 0, {});
  ASSERT_TRUE(report.has_value());
  EXPECT_EQ(report->closed_voids, 1u);
  EXPECT_EQ(report->components, 3u);
  ASSERT_EQ(report->removed.size(), 4u) << "the corners of the bubble";
  for (const Vec3& p : report->removed) EXPECT_LT(glm::length(p - (far + 1.0)), 0.02);
  const auto checks = testing::check_mesh(mesh);
  EXPECT_TRUE(checks.closed_manifold()) << checks;
  EXPECT_EQ(checks.components, 3u);
  EXPECT_EQ(mesh.creases, (std::vector<std::array<std::uint32_t, 2>>{{0, 1}, {4, 5}}));   // the bubble's is gone, the hollow's moved
  ASSERT_EQ(mesh.colors.size(), 12u);
  EXPECT_EQ(mesh.colors[4][0], 8);   // the hollow moved up, with its colours
  EXPECT_EQ(mesh.normals.size(), 12u);
}

TEST(MeshComponents, CrumbsAreRemovedByTheirArea) {
  Mesh mesh;
  for (const double size : {10.0, 0.1, 1.0}) add_tetrahedron(mesh, Vec3(mesh.positions.size(), 0, 0), size, false);
  const double area = (1.5 + std::sqrt(3) / 2) * 0.01;   // of the small one
  const double across = std::sqrt(area / std::numbers::pi);
  Mesh kept = mesh;
  EXPECT_EQ(drop_small_components(kept, 0, 0.99 * across, {})->crumbs, 0u);
  EXPECT_EQ(kept.positions.size(), 12u);
  const auto report = drop_small_components(mesh, 0, 1.01 * across, {});
  EXPECT_EQ(report->crumbs, 1u);
  EXPECT_EQ(report->closed_voids, 0u);
  EXPECT_EQ(report->components, 2u);
  EXPECT_TRUE(testing::check_mesh(mesh).closed_manifold());
  EXPECT_EQ(mesh.positions.size(), 8u);
}

TEST(MeshComponents, CancelledItLeavesTheMeshAlone) {
  Mesh mesh;
  add_tetrahedron(mesh, Vec3(0), 0.01, true);
  const std::atomic<bool> cancel{true};
  RunOptions run;
  run.cancel = &cancel;
  EXPECT_FALSE(drop_small_components(mesh, 1, 0, run).has_value());
  EXPECT_EQ(mesh.triangles.size(), 4u);
  EXPECT_EQ(drop_small_components(mesh, 1, 0, {})->closed_voids, 1u);
  EXPECT_TRUE(mesh.triangles.empty());
}

// Many components, each through all of the list, so that threads join the same sets at once.
TEST(MeshComponents, AreCountedAlikeByAnyNumberOfThreads) {
  constexpr std::uint32_t kPieces = 7, kRings = 60'000;
  Mesh mesh;
  for (std::uint32_t i = 0; i < kRings; ++i)
    for (std::uint32_t piece = 0; piece < kPieces; ++piece) mesh.positions.emplace_back(i % 3, i % 2, piece);
  for (std::uint32_t i = kRings - 2; i-- > 0;)
    for (std::uint32_t piece = 0; piece < kPieces; ++piece) {
      const std::uint32_t a = i * kPieces + piece;
      mesh.triangles.push_back({a, a + 2 * kPieces, a + kPieces});
    }
  for (const int threads : {1, 4}) {
    tbb::task_arena arena(threads);
    arena.execute([&] {
      Mesh copy = mesh;
      EXPECT_EQ(drop_small_components(copy, 0, 0, {})->components, kPieces);
      EXPECT_EQ(copy.triangles, mesh.triangles);
    });
  }
}

}  // namespace
}  // namespace cambium
