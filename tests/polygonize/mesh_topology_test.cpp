#include "polygonize/verify.h"

#include "tests/polygonize/mesh_checks.h"
#include "tests/polygonize/simple_meshes.h"

#include <gtest/gtest.h>

#include <atomic>
#include <random>

namespace cambium {
namespace {

using testing::ball_mesh;
using testing::ring_mesh;

TEST(MeshTopology, ABallIsClosedWithEulerNumberTwoAndItsVolume) {
  const MeshTopology t = check_topology(ball_mesh(5, 2, Vec3(3, -1, 5)));
  EXPECT_TRUE(t.closed_manifold());
  EXPECT_EQ(t.euler, 2);
  EXPECT_EQ(t.components, 1u);
  EXPECT_EQ(t.unused_vertices, 0u);
  EXPECT_NEAR(t.volume, 4.0 / 3 * std::numbers::pi * 8, 0.1);
  EXPECT_LT(t.volume, 4.0 / 3 * std::numbers::pi * 8);
}

TEST(MeshTopology, ARingHasEulerNumberZeroAndTwoPartsAreTwoComponents) {
  const Mesh ring = ring_mesh(40, 20, 3, 0.5);
  EXPECT_EQ(check_topology(ring).euler, 0);
  const MeshTopology both = check_topology(testing::joined(ring, ball_mesh(2, 1)));
  EXPECT_EQ(both.components, 2u);
  EXPECT_EQ(both.euler, 2);
  EXPECT_TRUE(both.closed_manifold());
}

TEST(MeshTopology, AMissingTriangleLeavesThreeBoundaryEdges) {
  Mesh mesh = ball_mesh(2, 1);
  mesh.triangles.erase(mesh.triangles.begin() + 17);
  const MeshTopology t = check_topology(mesh);
  EXPECT_EQ(t.boundary_edges, 3u);
  EXPECT_EQ(t.nonmanifold_edges, 0u);
  EXPECT_EQ(t.nonmanifold_vertices, 0u);
  EXPECT_EQ(t.euler, 1);
  EXPECT_FALSE(t.closed_manifold());
}

TEST(MeshTopology, AFlippedTriangleHasThreeEdgesRunTheSameWayTwice) {
  Mesh mesh = ball_mesh(2, 1);
  std::swap(mesh.triangles[5][0], mesh.triangles[5][1]);
  const MeshTopology t = check_topology(mesh);
  EXPECT_EQ(t.nonmanifold_edges, 3u);
  EXPECT_EQ(t.boundary_edges, 0u);
}

TEST(MeshTopology, BallsThatHangTogetherByAVertexOrAnEdgeAreNotManifold) {
  const auto merged = [](std::vector<std::array<std::uint32_t, 2>> same) {
    Mesh mesh = testing::joined(ball_mesh(1, 1), ball_mesh(1, 1, Vec3(2, 0, 0)));
    for (auto& t : mesh.triangles)
      for (auto& v : t)
        for (const auto& [from, to] : same)
          if (v == from) v = to;
    return check_topology(mesh);
  };
  const std::uint32_t second = static_cast<std::uint32_t>(ball_mesh(1, 1).positions.size());
  const MeshTopology vertex = merged({{second + 1, 0}});
  EXPECT_EQ(vertex.nonmanifold_vertices, 1u);
  EXPECT_EQ(vertex.nonmanifold_edges, 0u);
  EXPECT_EQ(vertex.components, 1u);
  EXPECT_EQ(vertex.unused_vertices, 1u);
  EXPECT_EQ(vertex.euler, 3);
  const auto first = ball_mesh(1, 1).triangles[0];
  const MeshTopology edge = merged({{second + first[0], first[0]}, {second + first[1], first[1]}});
  EXPECT_EQ(edge.nonmanifold_edges, 1u);
  EXPECT_EQ(edge.unused_vertices, 2u);
}

TEST(MeshTopology, TrianglesWithoutAreaAreCounted) {
  Mesh mesh;
  mesh.positions = {{0, 0, 0}, {1, 1, 1}, {3, 3, 3}, {0, 1, 0}, {0.1, 0.1, 0.1}};
  mesh.triangles = {{0, 1, 2}, {0, 3, 3}, {0, 1, 3}};
  EXPECT_EQ(check_topology(mesh).degenerate_triangles, 2u);
  mesh.positions[1].x = std::nextafter(1.0, 2.0);   // by a hair off the line
  EXPECT_EQ(check_topology(mesh).degenerate_triangles, 1u);
}

TEST(MeshTopology, TornMeshesAgreeWithTheSlowCheck) {
  std::mt19937 random(3);
  for (int round = 0; round < 100; ++round) {
    Mesh mesh = round % 2 ? ball_mesh(3, 1) : ring_mesh(20, 10, 1, 0.3);
    for (int k = 0; k < round % 7; ++k) {   // drop, flip, double or rewire a triangle
      const std::size_t i = random() % mesh.triangles.size();
      switch (random() % 4) {
        case 0: mesh.triangles.erase(mesh.triangles.begin() + static_cast<std::ptrdiff_t>(i)); break;
        case 1: std::swap(mesh.triangles[i][0], mesh.triangles[i][1]); break;
        case 2: mesh.triangles.push_back(mesh.triangles[i]); break;
        default: mesh.triangles[i][random() % 3] = static_cast<std::uint32_t>(random() % mesh.positions.size());
      }
    }
    const MeshTopology fast = check_topology(mesh);
    const testing::MeshChecks slow = testing::check_mesh(mesh);
    EXPECT_EQ(fast.components, slow.components);
    EXPECT_EQ(fast.unused_vertices, slow.unused_vertices);
    EXPECT_EQ(fast.boundary_edges + fast.nonmanifold_edges == 0, slow.unpaired_edges + slow.repeated_edges == 0) << round;
    if (slow.unpaired_edges + slow.repeated_edges == 0) {
      EXPECT_EQ(fast.nonmanifold_vertices, slow.split_vertices) << round;
      EXPECT_EQ(fast.euler, slow.euler - static_cast<long>(slow.unused_vertices));
    }
    if (round % 7 == 0) {   // torn, it depends on where one stands
      EXPECT_NEAR(fast.volume, slow.volume, 1e-12) << round;
    }
  }
}

TEST(MeshTopology, NothingAtAll) {
  const MeshTopology t = check_topology(Mesh{});
  EXPECT_TRUE(t.closed_manifold());
  EXPECT_EQ(t.components, 0u);
  EXPECT_EQ(t.euler, 0);
  EXPECT_EQ(t.volume, 0);
}

TEST(MeshTopology, Cancelled) {
  const std::atomic<bool> cancel{true};
  RunOptions run;
  run.cancel = &cancel;
  EXPECT_FALSE(check_topology(ball_mesh(2, 1), run).has_value());
}

}  // namespace
}  // namespace cambium
