#include "polygonize/vertex_balance.h"

#include "tests/polygonize/octrees.h"
#include "tests/polygonize/sample_fields.h"

#include <gtest/gtest.h>

#include <numeric>

namespace cambium {
namespace {

using testing::coarse_octree;
using testing::OnOctree;

VertexBalance balance(const SurfaceOctree& tree, const Contour& contour, double tolerance) {
  std::vector<std::uint32_t> all(contour.patches.size());
  std::iota(all.begin(), all.end(), 0u);
  VertexBalance balanced(tolerance);
  balanced.update(tree, contour, all);
  return balanced;
}

TEST(VertexBalance, VerticesMoveNoFurtherThanHalfTheToleranceAndOnlyWithinTheirLeaves) {
  for (const Field& field : {testing::fork_field(), testing::chain_field(), testing::noise_field(4)}) {
    OnOctree on = coarse_octree(field, 0.12, 3, {.radii = 1});
    const Contour contour = testing::contour_on(on);
    for (const double tolerance : {0.002, 0.02, kInfinity}) {
      const VertexBalance balanced = balance(on.tree, contour, tolerance);
      ASSERT_EQ(balanced.positions().size(), contour.vertices.size());
      EXPECT_EQ(balanced.changed_edges().size(), contour.edges.size());
      double farthest = 0;
      for (std::size_t i = 0; i < balanced.positions().size(); ++i) {
        const PatchVertex& vertex = contour.vertices[i];
        const OctreeLeaf& leaf = on.tree.leaves()[contour.patches[i].leaf];
        const Box box = on.tree.box(leaf);
        for (int a = 0; a < 3; ++a) {
          ASSERT_GT(balanced.positions()[i][a], box.lo[a]);
          ASSERT_LT(balanced.positions()[i][a], box.hi[a]);
        }
        const double moved = glm::length(balanced.positions()[i] - vertex.position);
        if (vertex.crease) {
          EXPECT_EQ(moved, 0);
        }
        farthest = std::max(farthest, moved);
      }
      EXPECT_GT(farthest, 0);
      EXPECT_LT(farthest, 0.5001 * tolerance);
      for (std::uint32_t e = 0; e < contour.edges.size(); ++e) ASSERT_TRUE(balanced.error(e) >= 0 && std::isfinite(balanced.error(e)));
    }
  }
}

TEST(VertexBalance, BalancingHalvesTheErrorOnASphere) {
  const Field field = testing::sphere_field();
  OnOctree on = coarse_octree(field, 0.2, 0);
  const Contour contour = testing::contour_on(on);
  const auto mean = [&](double tolerance) {
    const VertexBalance balanced = balance(on.tree, contour, tolerance);
    double sum = 0;
    for (std::uint32_t e = 0; e < contour.edges.size(); ++e) sum += static_cast<double>(balanced.error(e));
    return sum / static_cast<double>(contour.edges.size());
  };
  EXPECT_LT(mean(1), 0.6 * mean(1e-9));
}

}  // namespace
}  // namespace cambium
