#include "polygonize/vertex_split.h"

#include "creased_meshes.h"
#include "small_tree.h"

#include <gtest/gtest.h>

#include <cmath>
#include <set>
#include <tuple>

namespace cambium {
namespace {

using namespace testing;

TEST(VertexSplit, WithoutAttributesOnlyCreasesSplit) {
  const Mesh cube = creased_cube();
  const SplitMesh split = split_vertices(cube, nullptr);
  EXPECT_EQ(split.vertex.size(), 24u);
  EXPECT_TRUE(split.uv.empty());
  EXPECT_TRUE(split.tangents.empty());
  Mesh smooth = cube;
  smooth.creases.clear();
  EXPECT_EQ(split_vertices(smooth, nullptr).vertex.size(), 8u);
  Mesh bare = smooth;
  bare.normals.clear();
  EXPECT_TRUE(split_vertices(bare, nullptr).normals.empty());
  EXPECT_EQ(split_vertices(bare, nullptr).vertex.size(), 8u);
}

TEST(VertexSplit, TrianglesKeepTheirCornersAndNoVertexIsTwice) {
  const Field field = small_tree();
  Mesh mesh = small_tree_mesh(field);
  mesh.creases.clear();   // every vertex has one normal
  const MeshAttributes a = small_tree_attributes(field, mesh);
  const SplitMesh split = split_vertices(mesh, &a);
  ASSERT_EQ(split.triangles.size(), mesh.triangles.size());
  ASSERT_EQ(split.uv.size(), split.vertex.size());
  for (std::size_t t = 0; t < mesh.triangles.size(); ++t)
    for (int c = 0; c < 3; ++c) {
      const std::uint32_t i = split.triangles[t][c];
      EXPECT_EQ(split.vertex[i], mesh.triangles[t][c]);
      EXPECT_EQ(split.uv[i], a.uv_triangles[t][c]);
      EXPECT_EQ(split.normals[i], mesh.normals[mesh.triangles[t][c]]);
    }
  std::set<std::pair<std::uint32_t, std::uint32_t>> seen;
  for (std::size_t i = 0; i < split.vertex.size(); ++i) EXPECT_TRUE(seen.insert({split.vertex[i], split.uv[i]}).second);
  EXPECT_EQ(split.vertex.size(), a.uvs.size());
  EXPECT_GT(split.vertex.size(), mesh.positions.size());
}

TEST(VertexSplit, TangentsRunAlongUAndLieAcrossTheNormal) {
  const Field field = small_tree();
  const Mesh mesh = small_tree_mesh(field);
  const MeshAttributes a = small_tree_attributes(field, mesh);
  const SplitMesh split = split_vertices(mesh, &a);
  ASSERT_EQ(split.tangents.size(), split.vertex.size());
  for (std::size_t i = 0; i < split.tangents.size(); ++i) {
    const glm::vec3 t(split.tangents[i]);
    ASSERT_NEAR(glm::length(t), 1, 1e-5);
    ASSERT_NEAR(glm::dot(t, split.normals[i]), 0, 1e-5);
    ASSERT_EQ(std::abs(split.tangents[i].w), 1);
  }
  // On the trunk below its branches u runs level around it, anticlockwise, and v upwards.
  std::size_t on_trunk = 0;
  for (std::size_t i = 0; i < split.tangents.size(); ++i) {
    const Vec3& p = mesh.positions[split.vertex[i]];
    if (p.z < 0.15 || p.z > 0.7) continue;
    ++on_trunk;
    const Vec3 around = glm::normalize(Vec3(-p.y, p.x, 0)), t(glm::vec3(split.tangents[i]));
    EXPECT_GT(glm::dot(t, around), 0.98);
    EXPECT_GT((glm::cross(Vec3(split.normals[i]), t) * static_cast<double>(split.tangents[i].w)).z, 0.98);
  }
  EXPECT_GT(on_trunk, 100u);
}

TEST(VertexSplit, AMirroredTextureHasItsSideInW) {
  Mesh mesh;
  mesh.positions = {{0, 0, 0}, {1, 0, 0}, {0, 1, 0}};
  mesh.normals.assign(3, {0, 0, 1});
  mesh.triangles = {{{0, 1, 2}}};
  MeshAttributes a;
  a.uv_triangles = {{{0, 1, 2}}};
  a.uvs = {{0, 0}, {-1, 0}, {0, 1}};
  const SplitMesh split = split_vertices(mesh, &a);
  EXPECT_EQ(split.tangents[0], glm::vec4(-1, 0, 0, -1));
  a.uvs = {{0, 0}, {0, 0}, {0, 0}};   // no texture at all still gives a frame
  EXPECT_NEAR(glm::length(glm::vec3(split_vertices(mesh, &a).tangents[0])), 1, 1e-6);
}

}  // namespace
}  // namespace cambium
