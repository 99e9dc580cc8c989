// Polygons on octrees that need not fit their fields: what they promise is about boxes and signs.
#include "polygonize/patch_polygons.h"

#include "polygonize/crowded_leaves.h"
#include "polygonize/verify.h"
#include "tests/polygonize/cgal_check.h"
#include "tests/polygonize/crease_curves.h"
#include "tests/polygonize/mesh_checks.h"
#include "tests/polygonize/octrees.h"
#include "tests/polygonize/sample_fields.h"

#include <gtest/gtest.h>
#include <tbb/global_control.h>

#include <algorithm>
#include <atomic>
#include <set>

namespace cambium {
namespace {

using testing::coarse_octree;
using testing::OnOctree;

OnOctree ill_fitting(const Field& field, std::uint64_t seed) {
  Draws draws(seed);
  OnOctree on = coarse_octree(field, testing::longest_side(field) / (4 + draws.below(5)), 3,
                              {.radii = seed % 2 ? kInfinity : 2.0});
  testing::contour_on(on);
  testing::split_at_random(on, draws, 0.08);
  return on;
}

TEST(PatchPolygons, WindOnceAroundEveryInsideCornerAndNoOther) {
  std::size_t asked = 0;
  for (std::uint64_t seed = 1; seed <= 63; ++seed) {
    SCOPED_TRACE(seed);
    const Field field = testing::any_field(seed);
    OnOctree on = ill_fitting(field, seed);
    const Contour contour = testing::contour_on(on);
    const DualMesh made = testing::polygons_on(on, contour);
    const testing::MeshChecks checks = testing::check_mesh(made.mesh);
    ASSERT_TRUE(checks.closed_manifold()) << checks;
    ASSERT_EQ(check_topology(made.mesh).degenerate_triangles, 0u);
    if (made.mesh.triangles.empty()) continue;
    Draws draws(seed);
    const auto live = testing::live_leaves(on.tree);
    for (int k = 0; k < 24; ++k) {
      const OctreeLeaf& leaf = on.tree.leaves()[live[static_cast<std::size_t>(draws.below(static_cast<int>(live.size())))]];
      const int c = draws.below(8);
      CellPlace place = leaf.place;
      for (int a = 0; a < 3; ++a) place[a] += static_cast<std::uint32_t>(c >> a & 1) << leaf.level;
      ++asked;
      ASSERT_NEAR(testing::winding_number(made.mesh, on.tree.point(place)), leaf.mask >> c & 1, 1e-6);
    }
  }
  EXPECT_GT(asked, 1000u);
}

TEST(PatchPolygons, DoNotCrossWhereEveryLeafHasOnePatchEvenOnLeavesThatDoNotFit) {
  std::size_t meshes = 0, of_cgal = 0, crowded = 0, face_vertices = 0, edge_vertices = 0;
  for (std::uint64_t seed = 1; seed <= 90; ++seed) {
    SCOPED_TRACE(seed);
    const Field field = testing::any_field(seed);
    OnOctree on = ill_fitting(field, seed);
    const Contour contour = testing::contour_on(on);
    const DualMesh made = testing::polygons_on(on, contour);
    const auto pairs = self_intersections(made.mesh, {}).value();
    face_vertices += made.face_vertices, edge_vertices += made.edge_vertices;
    std::set<std::uint32_t> of_crowded;
    const std::vector<bool> shares = crowded_patches(contour);
    for (std::size_t p = 0; p < shares.size(); ++p)
      if (shares[p]) of_crowded.insert(contour.patches[p].leaf);
    if (!of_crowded.empty()) {   // every crossing is in a leaf of several patches
      ++crowded;
      for (const auto& [t, u] : pairs) {
        bool near = false;
        for (const std::uint32_t leaf : of_crowded) {
          const Box box = on.tree.box(on.tree.leaves()[leaf]);
          for (const std::uint32_t triangle : {t, u}) {
            Box around;
            for (const std::uint32_t v : made.mesh.triangles[triangle]) around.extend(Box{made.mesh.positions[v], made.mesh.positions[v]});
            near = near || box.intersects(around);
          }
        }
        EXPECT_TRUE(near) << "triangles " << t << " and " << u;
      }
      continue;
    }
    ++meshes;
    EXPECT_TRUE(pairs.empty()) << pairs.size();
    if (seed % 4 == 0 && !made.mesh.triangles.empty()) {
      ++of_cgal;
      EXPECT_TRUE(testing::cgal_self_intersections(made.mesh).empty());
    }
  }
  EXPECT_GT(meshes, 20u);
  EXPECT_GT(of_cgal, 3u);
  // The cases this is for.
  EXPECT_GT(crowded, 10u);
  EXPECT_GT(face_vertices, 1000u);
  EXPECT_GT(edge_vertices, 1000u);
}

TEST(PatchPolygons, CreasesAreEdgesOfTheMeshAndFaceVerticesOfThemAreOnTheCurve) {
  std::size_t passed_by = 0, exact = 0, all = 0;
  for (const testing::CreasedSolid& solid : testing::creased_solids()) {
    SCOPED_TRACE(solid.name);
    OnOctree on = coarse_octree(solid.field, 0.11, 3);
    Draws draws(1);
    for (int turn = 0; turn < 2; ++turn) {
      testing::contour_on(on);
      testing::split_at_random(on, draws, 0.1);
    }
    const Contour contour = testing::contour_on(on);
    const DualMesh made = testing::polygons_on(on, contour);
    const std::size_t patches = contour.patches.size();
    std::set<std::array<std::uint32_t, 2>> edges;
    for (const auto& t : made.mesh.triangles)
      for (std::size_t k = 0; k < 3; ++k) edges.insert({t[k], t[(k + 1) % 3]});
    EXPECT_GT(made.mesh.creases.size(), 20u);
    passed_by += crease_edges(contour).size() - made.mesh.creases.size();
    all += made.mesh.creases.size();
    EXPECT_TRUE(std::is_sorted(made.mesh.creases.begin(), made.mesh.creases.end()));
    for (const auto& [p, r] : made.mesh.creases) {
      EXPECT_LT(p, r);
      EXPECT_TRUE(edges.contains({p, r}) && edges.contains({r, p}));
      const double p_off = solid.from_crease(made.mesh.positions[p]);
      EXPECT_LT(p_off, 0.1 * 0.11);   // on a chord, where the crease passes the leaf by
      exact += p_off < 1e-6;
      if (r < patches) {
        EXPECT_LT(solid.from_crease(made.mesh.positions[r]), 0.1 * 0.11);
      } else {
        EXPECT_LT(solid.from_crease(made.mesh.positions[r]), 1e-6) << "where the crease passes the face by it is none";
      }
    }
  }
  EXPECT_GT(exact, 0.8 * static_cast<double>(all));
  EXPECT_GT(passed_by, 5u) << "the case this is for";
}

TEST(PatchPolygons, AreSplitAsTheyWereToldAndAnyMayBeAFan) {
  const Field field = testing::fork_field();
  OnOctree on = coarse_octree(field, 0.1, 3);
  const Contour contour = testing::contour_on(on);
  const std::vector<std::optional<Split>> fans(contour.edges.size(), Split::kFan);
  const DualMesh made =
      build_polygons(on.tree, on.cover, contour, testing::positions_of(contour), fans, kInfinity, {}).value();
  EXPECT_EQ(made.edge_vertices, contour.edges.size());
  const testing::MeshChecks checks = testing::check_mesh(made.mesh);
  EXPECT_TRUE(checks.closed_manifold()) << checks;
  EXPECT_TRUE(self_intersections(made.mesh, {})->empty());
}

TEST(PatchPolygons, AreTheSameForAnyNumberOfThreadsAndNoneWhenCancelled) {
  const Field field = testing::octant().field;
  OnOctree on = coarse_octree(field, 0.06, 2);
  const Contour contour = testing::contour_on(on);
  const DualMesh first = testing::polygons_on(on, contour);
  ASSERT_GT(first.mesh.creases.size(), 20u);
  for (const std::size_t threads : {1u, 2u, 4u}) {
    const tbb::global_control limit(tbb::global_control::max_allowed_parallelism, threads);
    const DualMesh other = testing::polygons_on(on, contour);
    EXPECT_EQ(other.mesh.positions, first.mesh.positions);
    EXPECT_EQ(other.mesh.normals, first.mesh.normals);
    EXPECT_EQ(other.mesh.triangles, first.mesh.triangles);
    EXPECT_EQ(other.mesh.creases, first.mesh.creases);
  }
  const std::atomic<bool> cancel{true};
  RunOptions run;
  run.cancel = &cancel;
  EXPECT_FALSE(build_polygons(on.tree, on.cover, contour, testing::positions_of(contour), testing::splits_of(contour), kInfinity, run));
}

}  // namespace
}  // namespace cambium
