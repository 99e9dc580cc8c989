#include "polygonize/patch_vertices.h"

#include "tests/polygonize/crease_curves.h"
#include "tests/polygonize/octrees.h"
#include "tests/polygonize/sample_fields.h"

#include <gtest/gtest.h>

#include <algorithm>

namespace cambium {
namespace {

using testing::coarse_octree;
using testing::OnOctree;

TEST(PatchVertices, AreStrictlyInsideTheirLeavesWhateverTheFieldIs) {
  std::size_t vertices = 0, creases = 0;
  for (std::uint64_t seed = 1; seed <= 45; ++seed) {
    SCOPED_TRACE(seed);
    const Field field = testing::any_field(seed);
    Draws draws(seed);
    OnOctree on = coarse_octree(field, testing::longest_side(field) / 6, 3, {.radii = seed % 2 ? kInfinity : 1.0});
    testing::split_at_random(on, draws, 0.05);
    const Contour contour = testing::contour_on(on);
    ASSERT_EQ(contour.vertices.size(), contour.patches.size());
    for (std::size_t i = 0; i < contour.vertices.size(); ++i) {
      const PatchVertex& vertex = contour.vertices[i];
      const OctreeLeaf& leaf = on.tree.leaves()[contour.patches[i].leaf];
      const Box box = on.tree.box(leaf);
      const double margin = 0.999 * (vertex.crease ? kCreaseMargin * on.tree.grid().cell : kVertexMargin * on.tree.edge(leaf));
      for (int a = 0; a < 3; ++a) {
        ASSERT_GE(vertex.position[a], box.lo[a] + margin) << "vertex " << i;
        ASSERT_LE(vertex.position[a], box.hi[a] - margin) << "vertex " << i;
      }
      ASSERT_NEAR(glm::length(vertex.normal), 1, 1e-4);
      creases += vertex.crease;
    }
    vertices += contour.vertices.size();
  }
  EXPECT_GT(vertices, 10000u);
  EXPECT_GT(creases, 500u);
}

TEST(PatchVertices, OfSmoothFieldsAreOnTheSurfaceWhereTheirLeavesFit) {
  for (const Field& field : {testing::sphere_field(), testing::torus_field(), testing::chain_field()}) {
    OnOctree on = coarse_octree(field, 0.1, 4, {.radii = 0.3});
    const Contour contour = testing::contour_on(on);
    std::size_t off = 0;
    for (std::size_t i = 0; i < contour.vertices.size(); ++i) {
      const PatchVertex& vertex = contour.vertices[i];
      const double edge = on.tree.edge(on.tree.leaves()[contour.patches[i].leaf]);
      const Sample sample = field.sample(vertex.position);
      const double slope = glm::length(sample.gradient), distance = std::abs(sample.value - kIso) / slope;
      EXPECT_LT(distance, 0.04 * edge);   // a grazed leaf holds its vertex back
      off += distance > 0.004 * edge;
      EXPECT_GT(glm::dot(Vec3(vertex.normal), -sample.gradient / slope), 0.999);
      EXPECT_FALSE(vertex.crease);
    }
    EXPECT_LT(off, contour.vertices.size() / 10);
  }
}

TEST(PatchVertices, OnCreasesAreOnBothSheets) {
  for (const testing::CreasedSolid& solid : testing::creased_solids()) {
    SCOPED_TRACE(solid.name);
    for (const double cell : {0.2, 0.05}) {
      OnOctree on = coarse_octree(solid.field, cell, 1);
      const Contour contour = testing::contour_on(on);
      std::size_t creases = 0, exact = 0;
      for (std::size_t i = 0; i < contour.vertices.size(); ++i) {
        const PatchVertex& vertex = contour.vertices[i];
        if (!vertex.crease) continue;
        ++creases;
        const double off = solid.from_crease(vertex.position);
        EXPECT_LT(off, 0.1 * cell) << "vertex " << i;   // on a chord, where the crease passes the leaf by
        exact += off < 0.01 * cell;
        if (off >= 1e-6) continue;
        glm::vec3 mean(0.0f);
        for (const Vec3& normal : solid.sheet_normals(vertex.position)) mean += glm::vec3(normal);
        EXPECT_GT(glm::dot(glm::normalize(mean), vertex.normal), 0.98f);   // of the sides that its leaf has
      }
      EXPECT_GT(static_cast<double>(exact), 0.97 * static_cast<double>(creases));
      EXPECT_GT(static_cast<double>(creases), 0.9 * solid.length / cell);
    }
  }
}

TEST(PatchVertices, CreasesRunFromLeafToLeafAlongTheCurve) {
  for (const testing::CreasedSolid& solid : testing::creased_solids()) {
    SCOPED_TRACE(solid.name);
    OnOctree on = coarse_octree(solid.field, 0.04, 1);
    const Contour contour = testing::contour_on(on);
    EXPECT_TRUE(std::is_sorted(contour.exits.begin(), contour.exits.end()));
    EXPECT_EQ(std::adjacent_find(contour.exits.begin(), contour.exits.end()), contour.exits.end());
    const auto creases = crease_edges(contour);   // they stop at leaves that the crease passes by
    EXPECT_TRUE(std::is_sorted(creases.begin(), creases.end()));
    for (const auto& [p, r] : creases) {
      EXPECT_LT(p, r);
      EXPECT_TRUE(contour.vertices[p].crease && contour.vertices[r].crease);
      const Vec3 from = contour.vertices[p].position, to = contour.vertices[r].position;
      EXPECT_LT(glm::length(to - from), 0.16);
      EXPECT_LT(solid.from_crease((from + to) / 2.0), 0.01);
    }
    EXPECT_GT(creases.size(), 30u);
  }
}

}  // namespace
}  // namespace cambium
