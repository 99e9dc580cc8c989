#include "polygonize/vertex_balance.h"

#include "polygonize/polygon_distance.h"
#include "tests/polygonize/crease_curves.h"
#include "tests/polygonize/octrees.h"
#include "tests/polygonize/sample_fields.h"

#include <gtest/gtest.h>

#include <numeric>

namespace cambium {
namespace {

using testing::coarse_octree;
using testing::OnOctree;

VertexBalance balance(const OnOctree& on, const Contour& contour, double tolerance) {
  std::vector<std::uint32_t> all(contour.patches.size());
  std::iota(all.begin(), all.end(), 0u);
  VertexBalance balanced(tolerance);
  EXPECT_TRUE(balanced.update(on.tree, on.cover, contour, all, {}));
  return balanced;
}

TEST(VertexBalance, VerticesMoveNoFurtherThanHalfTheToleranceAndOnlyWithinTheirLeaves) {
  for (const Field& field : {testing::fork_field(), testing::chain_field(), testing::noise_field(4)}) {
    OnOctree on = coarse_octree(field, 0.12, 3, {.radii = 1});
    const Contour contour = testing::contour_on(on);
    for (const double tolerance : {0.002, 0.02, kInfinity}) {
      const VertexBalance balanced = balance(on, contour, tolerance);
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
        const bool crowded = (i > 0 && contour.patches[i - 1].leaf == contour.patches[i].leaf) ||
                             (i + 1 < contour.patches.size() && contour.patches[i + 1].leaf == contour.patches[i].leaf);
        if (crowded) continue;   // in the middle of its crossings
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
    const VertexBalance balanced = balance(on, contour, tolerance);
    double sum = 0;
    for (std::uint32_t e = 0; e < contour.edges.size(); ++e) sum += static_cast<double>(balanced.error(e));
    return sum / static_cast<double>(contour.edges.size());
  };
  EXPECT_LT(mean(1), 0.6 * mean(1e-9));
}

TEST(VertexBalance, PolygonsThatAreWithinAreWithinWhereTheFieldIsAskedToo) {
  std::size_t asked = 0, fans = 0, others = 0, off = 0;
  for (const Field& field : {testing::fork_field(), testing::contact_field(), testing::chain_field(), testing::cut_sphere().field}) {
    OnOctree on = coarse_octree(field, 0.12, 3, {.radii = 1.3});
    const Contour contour = testing::contour_on(on);
    const double tolerance = 0.01;
    const VertexBalance balanced = balance(on, contour, tolerance);
    ASSERT_EQ(balanced.splits().size(), contour.edges.size());
    std::vector<SplitPolygon> within;
    for (std::uint32_t e = 0; e < contour.edges.size(); ++e) {
      const auto split = balanced.splits()[e];
      if (!(balanced.error(e) <= kAim * tolerance)) continue;
      const Ring ring = ring_of(contour.edges[e], contour.patch_of_quadrant[e]);
      const Split own = split_of(on.tree, contour, e, ring, balanced.positions(), tolerance);
      within.push_back({e, split.value_or(own)});
      others += split && *split != own;
      fans += split == Split::kFan;
      if (split && *split != Split::kFan) {
        EXPECT_TRUE(fitting_splits(on.tree, contour, e, ring, balanced.positions())[static_cast<int>(*split)]);
      }
    }
    std::vector<float> distances;
    ASSERT_TRUE(measure_polygons(on.tree, on.cover, contour, balanced.positions(), within, distances, {}));
    for (std::size_t i = 0; i < within.size(); ++i) off += distances[i] > static_cast<float>(1.001 * tolerance);
    asked += within.size();
  }
  EXPECT_GT(asked, 2000u);
  EXPECT_GT(fans, 10u);
  EXPECT_GT(others, 10u) << "diagonals that were not the first choice";
  EXPECT_EQ(off, 0u);
}

TEST(VertexBalance, NoPolygonIsMeasuredWithoutATolerance) {
  OnOctree on = coarse_octree(testing::fork_field(), 0.12, 3, {.radii = 1.3});
  const Contour contour = testing::contour_on(on);
  const VertexBalance balanced = balance(on, contour, kInfinity);
  for (const auto& split : balanced.splits()) EXPECT_FALSE(split.has_value());
}

}  // namespace
}  // namespace cambium
