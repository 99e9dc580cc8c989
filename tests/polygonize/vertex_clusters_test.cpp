#include "polygonize/vertex_clusters.h"

#include "small_tree.h"

#include <gtest/gtest.h>

#include <atomic>
#include <set>

namespace cambium {
namespace {

using namespace testing;

const Mesh& dense_tree() {
  static const Mesh mesh = small_tree_mesh(small_tree(), 0.006);
  return mesh;
}

TEST(VertexClusters, AClusterIsNarrowAndFacesOneWay) {
  const Mesh& mesh = dense_tree();
  const double spacing = 0.02;
  const VertexClusters clusters = cluster_vertices(mesh, spacing, {});
  ASSERT_EQ(clusters.of_vertex.size(), mesh.positions.size());
  EXPECT_LT(3 * clusters.middle.size(), mesh.positions.size());
  std::vector<std::vector<std::uint32_t>> members(clusters.middle.size());
  for (std::uint32_t v = 0; v < clusters.of_vertex.size(); ++v) members[clusters.of_vertex[v]].push_back(v);
  for (std::size_t c = 0; c < members.size(); ++c) {
    EXPECT_EQ(clusters.of_vertex[clusters.middle[c]], c);
    for (const std::uint32_t a : members[c])
      for (const std::uint32_t b : members[c]) {
        EXPECT_LE(glm::distance(mesh.positions[a], mesh.positions[b]), spacing * (1 + 1e-12));
        EXPECT_GE(glm::dot(mesh.normals[a], mesh.normals[b]), 0.2f);   // each within 38 degrees of the first
      }
  }
}

TEST(VertexClusters, TrianglesBetweenThreeClustersAreKept) {
  const Mesh& mesh = dense_tree();
  const VertexClusters clusters = cluster_vertices(mesh, 0.02, {});
  std::vector<std::array<std::uint32_t, 3>> expected;
  for (const auto& t : mesh.triangles) {
    const std::array<std::uint32_t, 3> c{clusters.of_vertex[t[0]], clusters.of_vertex[t[1]], clusters.of_vertex[t[2]]};
    if (std::set<std::uint32_t>(c.begin(), c.end()).size() == 3) expected.push_back(c);
  }
  EXPECT_FALSE(expected.empty());
  EXPECT_EQ(clusters.triangles, expected);
}

TEST(VertexClusters, WithoutASpacingEachVertexIsItsOwn) {
  const Mesh& mesh = dense_tree();
  const VertexClusters clusters = cluster_vertices(mesh, 0, {});
  for (std::uint32_t v = 0; v < mesh.positions.size(); ++v) {
    EXPECT_EQ(clusters.of_vertex[v], v);
    EXPECT_EQ(clusters.middle[v], v);
  }
  EXPECT_EQ(clusters.triangles, mesh.triangles);
}

TEST(VertexClusters, AnEmptyMeshHasNoneAndACancelledRunGivesNone) {
  EXPECT_TRUE(cluster_vertices(Mesh{}, 1, {}).middle.empty());
  std::atomic<bool> cancel{true};
  RunOptions run;
  run.cancel = &cancel;
  EXPECT_TRUE(cluster_vertices(dense_tree(), 0.02, run).of_vertex.empty());
}

}  // namespace
}  // namespace cambium
