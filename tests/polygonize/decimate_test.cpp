#include "polygonize/decimate.h"

#include "blobtree/input_error.h"
#include "polygonize/polygonize.h"
#include "polygonize/verify.h"
#include "tests/polygonize/mesh_checks.h"
#include "tests/polygonize/sample_fields.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <atomic>
#include <map>
#include <set>

namespace cambium {
namespace {

Mesh mesh_of(const Field& field, double voxel) {
  PolygonizeOptions options;
  options.voxel = voxel;
  return polygonize(field, options, {})->mesh;
}

Mesh decimated(const Mesh& mesh, std::size_t triangles) { return decimate(mesh, {.triangles = triangles}, {}).value(); }

std::set<std::array<double, 3>> places(const Mesh& mesh) {
  std::set<std::array<double, 3>> result;
  for (const Vec3& p : mesh.positions) result.insert({p.x, p.y, p.z});
  return result;
}

// A cube of n x n squares a face, its twelve edges creases.
Mesh creased_cube(int n) {
  Mesh mesh;
  std::map<std::array<int, 3>, std::uint32_t> numbers;
  const auto vertex = [&](std::array<int, 3> at) {
    const auto [it, is_new] = numbers.emplace(at, static_cast<std::uint32_t>(mesh.positions.size()));
    if (is_new) {
      const Vec3 p = 2.0 / n * Vec3(at[0], at[1], at[2]) - Vec3(1.0);
      mesh.positions.push_back(p);
      mesh.normals.push_back(glm::vec3(0.0f));
    }
    return it->second;
  };
  for (int axis = 0; axis < 3; ++axis)
    for (const int side : {0, n})
      for (int i = 0; i < n; ++i)
        for (int j = 0; j < n; ++j) {
          std::array<std::uint32_t, 4> q{};
          for (int c = 0; c < 4; ++c) {
            std::array<int, 3> at{};
            at[axis] = side;
            at[(axis + 1) % 3] = i + (c == 1 || c == 2);
            at[(axis + 2) % 3] = j + (c >= 2);
            q[c] = vertex(at);
          }
          if (side == 0) std::swap(q[1], q[3]);
          mesh.triangles.push_back({q[0], q[1], q[2]});
          mesh.triangles.push_back({q[0], q[2], q[3]});
          for (const std::uint32_t v : q) mesh.normals[v][axis] = side ? 1.0f : -1.0f;
        }
  for (auto& normal : mesh.normals) normal = glm::normalize(normal);
  const auto on_edge = [&](const Vec3& p) {
    return (std::abs(p.x) == 1) + (std::abs(p.y) == 1) + (std::abs(p.z) == 1) >= 2;
  };
  std::set<std::array<std::uint32_t, 2>> creases;
  for (const auto& t : mesh.triangles)
    for (int i = 0; i < 3; ++i) {
      const std::uint32_t a = t[i], b = t[(i + 1) % 3];
      const Vec3 middle = 0.5 * (mesh.positions[a] + mesh.positions[b]);
      if (on_edge(middle)) creases.insert({std::min(a, b), std::max(a, b)});
    }
  mesh.creases.assign(creases.begin(), creases.end());
  return mesh;
}

TEST(Decimate, ManifoldsStayClosedManifoldsOfTheSameEulerNumber) {
  const std::pair<Field, double> fields[] = {{testing::sphere_field(), 0.05}, {testing::torus_field(), 0.04},
                                             {testing::fork_field(), 0.02},   {testing::contact_field(), 0.03},
                                             {testing::chain_field(), 0.02},  {testing::random_field(3), 0.03},
                                             {testing::random_field(11), 0.03}};
  for (const auto& [field, voxel] : fields) {
    const Mesh mesh = mesh_of(field, voxel);
    const auto before = testing::check_mesh(mesh);
    for (const std::size_t divisor : {3, 20}) {
      const Mesh fewer = decimated(mesh, mesh.triangles.size() / divisor);
      const auto after = testing::check_mesh(fewer);
      SCOPED_TRACE(::testing::Message() << mesh.triangles.size() << " to " << fewer.triangles.size() << ": " << after);
      EXPECT_LE(fewer.triangles.size(), mesh.triangles.size() / divisor);
      EXPECT_TRUE(after.closed_manifold());
      EXPECT_EQ(after.degenerate_triangles, 0u);
      EXPECT_EQ(after.euler, before.euler);
      EXPECT_EQ(after.components, before.components);
      EXPECT_EQ(after.inward_components, before.inward_components);
      EXPECT_NEAR(after.volume / before.volume, 1, divisor == 3 ? 0.01 : 0.1);
    }
  }
}

TEST(Decimate, NothingCrossesItselfThatDidNotBefore) {
  // Two sheets a cell apart: collapses on one do not see the other.
  BlobTreeBuilder builder;
  const NodeId outer = builder.add(Sphere{Vec3(0.03, -0.02, 0.01), 1, 1}), inner = builder.add(Sphere{Vec3(0.03, -0.02, 0.01), 0.93, 1});
  const NodeId shell = builder.add(Difference{{outer, inner}});
  const std::pair<Field, double> fields[] = {{Field(builder.build(shell)), 0.06}, {testing::chain_field(), 0.02},
                                             {testing::fork_field(), 0.02},       {testing::torus_field(), 0.03}};
  for (const auto& [field, voxel] : fields) {
    const Mesh mesh = mesh_of(field, voxel);
    ASSERT_EQ(self_intersections(mesh, {})->size(), 0u);
    for (const std::size_t divisor : {10, 50}) {
      const Mesh fewer = decimated(mesh, mesh.triangles.size() / divisor);
      EXPECT_EQ(self_intersections(fewer, {})->size(), 0u) << mesh.triangles.size() << " to " << fewer.triangles.size();
      EXPECT_TRUE(check_topology(fewer).closed_manifold());
    }
  }
}

TEST(Decimate, VerticesThatRemainAreAmongThoseThatWere) {
  const Mesh mesh = mesh_of(testing::fork_field(), 0.03);
  const Mesh fewer = decimated(mesh, mesh.triangles.size() / 5);
  const auto before = places(mesh);
  for (const auto& p : places(fewer)) EXPECT_TRUE(before.contains(p));
  ASSERT_EQ(fewer.normals.size(), fewer.positions.size());
  std::map<std::array<double, 3>, glm::vec3> normal;
  for (std::size_t v = 0; v < mesh.positions.size(); ++v) {
    const Vec3& p = mesh.positions[v];
    normal[{p.x, p.y, p.z}] = mesh.normals[v];
  }
  for (std::size_t v = 0; v < fewer.positions.size(); ++v) {
    const Vec3& p = fewer.positions[v];
    EXPECT_EQ((normal[{p.x, p.y, p.z}]), fewer.normals[v]);
  }
}

TEST(Decimate, ACubeComesDownToItsTwelveTrianglesAndTwelveCreases) {
  const Mesh fewer = decimated(creased_cube(8), 12);
  EXPECT_EQ(fewer.triangles.size(), 12u);
  EXPECT_EQ(fewer.creases.size(), 12u);
  EXPECT_TRUE(testing::check_mesh(fewer).closed_manifold());
  EXPECT_NEAR(testing::check_mesh(fewer).volume, 8, 1e-12);
  for (const Vec3& p : fewer.positions) EXPECT_EQ(glm::abs(p), Vec3(1.0));   // corners only
}

TEST(Decimate, CreaseEdgesAreEdgesOfTwoTrianglesAndStayOnTheCrease) {
  const Mesh mesh = creased_cube(12);
  const Mesh fewer = decimated(mesh, 100);
  double length = 0;
  std::map<std::array<std::uint32_t, 2>, int> uses;
  for (const auto& t : fewer.triangles)
    for (int i = 0; i < 3; ++i) ++uses[{std::min(t[i], t[(i + 1) % 3]), std::max(t[i], t[(i + 1) % 3])}];
  for (const auto& edge : fewer.creases) {
    EXPECT_LT(edge[0], edge[1]);
    EXPECT_EQ(uses[edge], 2);
    length += glm::distance(fewer.positions[edge[0]], fewer.positions[edge[1]]);
  }
  EXPECT_NEAR(length, 24, 1e-12);
  EXPECT_TRUE(std::is_sorted(fewer.creases.begin(), fewer.creases.end()));
}

TEST(Decimate, ATwigKeepsThreeSidesAtLeastAndIsNeverASheet) {
  const Field field = testing::field_of(Chain{{{Vec3(0, 0, 0), 0.02}, {Vec3(0.1, 0.05, 1), 0.018}, {Vec3(0, 0.1, 2), 0.015}}, 1});
  const Mesh mesh = mesh_of(field, 0.01);
  const double volume = testing::check_mesh(mesh).volume;
  for (const std::size_t triangles : {1000u, 200u, 60u, 40u}) {
    const Mesh fewer = decimated(mesh, triangles);
    const auto checks = testing::check_mesh(fewer);
    SCOPED_TRACE(::testing::Message() << fewer.triangles.size() << ": " << checks);
    EXPECT_LE(fewer.triangles.size(), triangles);
    EXPECT_TRUE(checks.closed_manifold());
    EXPECT_EQ(checks.inward_components, 0u);
    // An inscribed triangle has 0.41 of its circle.
    EXPECT_GT(checks.volume, (triangles >= 200 ? 0.6 : 0.3) * volume);
  }
}

TEST(Decimate, AComponentKeepsATetrahedron) {
  const Mesh mesh = mesh_of(testing::sphere_field(), 0.1);
  const Mesh fewer = decimated(mesh, 1);
  const auto checks = testing::check_mesh(fewer);
  EXPECT_GE(fewer.triangles.size(), 4u);
  EXPECT_LE(fewer.triangles.size(), 12u);
  EXPECT_TRUE(checks.closed_manifold());
  EXPECT_GT(checks.volume, 0);
}

TEST(Decimate, FewEnoughTrianglesAreLeftAsTheyAre) {
  const Mesh mesh = mesh_of(testing::sphere_field(), 0.2);
  const Mesh same = decimated(mesh, mesh.triangles.size());
  EXPECT_EQ(same.triangles, mesh.triangles);
  EXPECT_EQ(places(same), places(mesh));
}

TEST(Decimate, TheSameTwiceIsTheSame) {
  const Mesh mesh = mesh_of(testing::random_field(5), 0.04);
  const Mesh first = decimated(mesh, 500), second = decimated(mesh, 500);
  EXPECT_EQ(first.triangles, second.triangles);
  EXPECT_EQ(first.positions, second.positions);
}

TEST(Decimate, CancelledItGivesNothingAndOpenOrZeroIsRefused) {
  Mesh mesh = mesh_of(testing::sphere_field(), 0.1);
  std::atomic<bool> cancel{true};
  RunOptions run;
  run.cancel = &cancel;
  EXPECT_FALSE(decimate(mesh, {.triangles = 10}, run).has_value());
  EXPECT_THROW(decimate(mesh, {.triangles = 0}, {}), InputError);
  mesh.triangles.pop_back();
  EXPECT_THROW(decimate(mesh, {.triangles = 10}, {}), InputError);
}

}  // namespace
}  // namespace cambium
