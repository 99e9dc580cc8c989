// The guarantee of the patches is about signs and integers, so these octrees need not fit their fields: most are far too coarse.
#include "polygonize/surface_patches.h"

#include "polygonize/crowded_leaves.h"
#include "polygonize/polygon_ring.h"
#include "tests/polygonize/mesh_checks.h"
#include "tests/polygonize/octrees.h"
#include "tests/polygonize/sample_fields.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <map>
#include <set>

namespace cambium {
namespace {

using testing::coarse_octree;
using testing::OnOctree;

/// Every polygon as a fan around a vertex of its own: the mesh that any way of drawing the polygons is homeomorphic to.
testing::MeshChecks check_fans(const Contour& contour) {
  Mesh mesh;
  for (std::uint32_t i = 0; i < contour.edges.size(); ++i) {
    const Ring ring = ring_of(contour.edges[i], contour.patch_of_quadrant[i]);
    EXPECT_GE(ring.count, 3);
    const auto center = static_cast<std::uint32_t>(contour.patches.size()) + i;
    for (int k = 0; k < ring.count; ++k) mesh.triangles.push_back({center, ring.patches[k], ring.patches[(k + 1) % ring.count]});
  }
  return testing::check_mesh(mesh, false, contour.patches.size() + contour.edges.size());
}

/// Each patch is a cycle of its leaf's edges, each crossed edge is in one patch of every leaf around it, and no two patches are
/// joined by two lines.
void expect_consistent(const SurfaceOctree& tree, const Contour& contour) {
  for (std::uint32_t p = 0; p < contour.patches.size(); ++p) {
    const Patch& patch = contour.patches[p];
    ASSERT_GE(patch.edge_count, 3u);
    EXPECT_EQ(tree.find(tree.leaves()[patch.leaf].place), patch.leaf);
    std::set<std::uint32_t> met;
    for (const std::uint32_t e : contour.ring(p)) {
      EXPECT_TRUE(met.insert(e).second);
      for (int q = 0; q < 4; ++q) {
        if (contour.edges[e].leaves[q] == patch.leaf) {
          EXPECT_EQ(contour.patch_of_quadrant[e][q], p);
        }
      }
    }
  }
  std::map<std::array<std::uint32_t, 2>, int> ends;   // of the lines between two patches
  for (std::size_t i = 0; i < contour.edges.size(); ++i) {
    for (int k = 0; k < 4; ++k) {
      const std::uint32_t p = contour.patch_of_quadrant[i][kRing[k]], r = contour.patch_of_quadrant[i][kRing[(k + 1) % 4]];
      ASSERT_NE(p, kNoPatch);
      if (p != r) ++ends[{std::min(p, r), std::max(p, r)}];
    }
  }
  for (const auto& [pair, count] : ends) EXPECT_EQ(count, 2) << pair[0] << " and " << pair[1];
}

TEST(SurfacePatches, MakeAManifoldWhateverTheSignsAre) {
  std::size_t relinked = 0, crowded = 0, of_several_sizes = 0;
  for (std::uint64_t seed = 1; seed <= 63; ++seed) {
    SCOPED_TRACE(seed);
    const Field field = testing::any_field(seed);
    Draws draws(seed);
    OnOctree on = coarse_octree(field, testing::longest_side(field) / (4 + draws.below(8)), 3);
    for (int turn = 0; turn < 3; ++turn) {
      if (turn > 0) testing::split_at_random(on, draws, turn == 1 ? 0.1 : 0.02);
      const Contour contour = testing::contour_on(on, &relinked);
      const testing::MeshChecks checks = check_fans(contour);
      ASSERT_TRUE(checks.closed_manifold()) << checks;
      expect_consistent(on.tree, contour);
      for (const bool shares : crowded_patches(contour)) crowded += shares;
      for (const MinimalEdge& edge : contour.edges)
        for (const std::uint32_t leaf : edge.leaves) of_several_sizes += on.tree.leaves()[leaf].level != on.tree.leaves()[edge.owner()].level;
    }
  }
  // The cases this is for.
  EXPECT_GT(relinked, 10u);
  EXPECT_GT(crowded, 500u);
  EXPECT_GT(of_several_sizes, 1000u);
  RecordProperty("relinked", static_cast<int>(relinked));
  RecordProperty("crowded", static_cast<int>(crowded));
}

TEST(SurfacePatches, OfNoiseAtTheSizeOfItsLeavesAreRelinkedAndStillAManifold) {
  std::size_t relinked = 0;
  for (std::uint64_t seed = 1; seed <= 6; ++seed) {
    SCOPED_TRACE(seed);
    Draws draws(seed);
    OnOctree on = coarse_octree(testing::noise_field(seed, 500), draws.in(0.07, 0.16), 2);
    for (int turn = 0; turn < 2; ++turn) {
      if (turn > 0) testing::split_at_random(on, draws, 0.05);
      const Contour contour = testing::contour_on(on, &relinked);
      const testing::MeshChecks checks = check_fans(contour);
      ASSERT_TRUE(checks.closed_manifold()) << checks;
      expect_consistent(on.tree, contour);
    }
  }
  EXPECT_GT(relinked, 10u) << "the case this is for";
  RecordProperty("relinked", static_cast<int>(relinked));
}

TEST(SurfacePatches, OfASphereInEightLeavesIsOneInEach) {
  OnOctree on = coarse_octree(testing::sphere_field(0.3, Vec3(0.01, 0.02, 0.03)), 1, 0);
  const Contour contour = testing::contour_on(on);
  ASSERT_EQ(contour.patches.size(), 8u);
  for (const Patch& patch : contour.patches) EXPECT_EQ(patch.edge_count, 3u);
  EXPECT_EQ(check_fans(contour).euler, 2);
}

}  // namespace
}  // namespace cambium
