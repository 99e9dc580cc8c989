#include "polygonize/nearby_polygons.h"

#include "tests/polygonize/octrees.h"
#include "tests/polygonize/sample_fields.h"

#include <gtest/gtest.h>

#include <algorithm>

namespace cambium {
namespace {

using testing::coarse_octree;
using testing::OnOctree;

struct Contoured {
  OnOctree on;
  Contour contour;
  std::vector<Vec3> positions;
  std::vector<std::optional<Split>> splits;

  explicit Contoured(const Field& field) : on(coarse_octree(field, 0.2, 2)) {
    Draws draws(5);
    testing::split_at_random(on, draws, 0.3);
    contour = testing::contour_on(on);
    positions = testing::positions_of(contour);
    splits = testing::splits_of(contour);
  }
};

TEST(NearbyPolygons, AreThoseOfAllThatAreWithinReach) {
  const Contoured made(testing::fork_field());
  const PlacedPolygons placed{made.positions, made.splits, kInfinity};
  const PatchesOfLeaves patches(made.contour, made.on.tree.leaves().size());
  NearbyPolygons nearby(made.on.tree, made.contour, placed, patches), all(made.on.tree, made.contour, placed, patches);
  Box around;
  for (const Vec3& p : made.positions) around.extend(p);
  all.turn_to(around, 1);
  Draws draws(1);
  int near = 0;
  for (int i = 0; i < 300; ++i) {
    const Vec3 low = draws.point(around);
    const Box box{low, low + Vec3(0.1)};
    nearby.turn_to(box, 0.1);
    for (int k = 0; k < 10; ++k) {
      const Vec3 p = draws.point(box);
      const double exact = all.distance(p, 0), enough = draws.in(0, 0.1), told = nearby.distance(p, enough);
      EXPECT_GE(told, exact);
      if (exact > 0.1 || told <= enough) continue;
      EXPECT_EQ(told, exact);
      ++near;
    }
  }
  EXPECT_GT(near, 100);
}

TEST(NearbyPolygons, AreTheSameHoweverSmallTheBoxIsBesideTheReach) {
  const Contoured made(testing::fork_field());
  const PlacedPolygons placed{made.positions, made.splits, kInfinity};
  const PatchesOfLeaves patches(made.contour, made.on.tree.leaves().size());
  NearbyPolygons nearby(made.on.tree, made.contour, placed, patches), all(made.on.tree, made.contour, placed, patches);
  Box around;
  for (const Vec3& p : made.positions) around.extend(p);
  Draws draws(2);
  int near = 0;
  for (int i = 0; i < 300; ++i) {
    const Vec3 p = draws.point(around);
    nearby.turn_to({p - 0.001, p + 0.001}, 0.2);   // looked for five times over
    all.turn_to(around, 1);
    const double exact = all.distance(p, 0);
    if (exact > 0.2) continue;
    EXPECT_LE(nearby.distance(p, 0.05), std::max(exact, 0.05));
    EXPECT_EQ(nearby.distance(p, 0), exact);
    EXPECT_EQ(nearby.distance_to_vertex(p, around.padded(1)), all.distance_to_vertex(p, around.padded(1)));
    ++near;
  }
  EXPECT_GT(near, 50);
}

TEST(NearbyPolygons, HoldTheMiddlesOfTriangles) {
  const Contoured made(testing::torus_field());
  const PlacedPolygons placed{made.positions, made.splits, kInfinity};
  const PatchesOfLeaves patches(made.contour, made.on.tree.leaves().size());
  NearbyPolygons nearby(made.on.tree, made.contour, placed, patches);
  int triangles = 0;
  for (std::uint32_t e = 0; e < made.contour.edges.size(); ++e) {
    const Ring ring = ring_of(made.contour.edges[e], made.contour.patch_of_quadrant[e]);
    if (ring.count != 3) continue;
    Vec3 middle(0.0);
    for (int k = 0; k < 3; ++k) middle += made.positions[ring.patches[k]] / 3.0;
    nearby.turn_to({middle, middle}, 0.2);
    if (split_of(made.on.tree, made.contour, e, ring, made.positions, kInfinity) == Split::kFan) continue;
    ASSERT_NEAR(nearby.distance(middle, 0), 0, 1e-9);
    ++triangles;
  }
  EXPECT_GT(triangles, 20);
}

TEST(NearbyPolygons, KnowTheNearestVertexOfTheLeavesAround) {
  const Contoured made(testing::fork_field());
  const PlacedPolygons placed{made.positions, made.splits, kInfinity};
  const PatchesOfLeaves patches(made.contour, made.on.tree.leaves().size());
  NearbyPolygons nearby(made.on.tree, made.contour, placed, patches);
  const Box everywhere{Vec3(-kInfinity), Vec3(kInfinity)};
  for (const Patch& patch : made.contour.patches) {
    const Box box = made.on.tree.box(made.on.tree.leaves()[patch.leaf]);
    nearby.turn_to(box, 0);
    double least = kInfinity;
    for (std::size_t p = 0; p < made.positions.size(); ++p)
      if (made.on.tree.box(made.on.tree.leaves()[made.contour.patches[p].leaf]).intersects(box))
        least = std::min(least, glm::distance(made.positions[p], box.center()));
    ASSERT_NEAR(nearby.distance_to_vertex(box.center(), everywhere), least, 1e-12);
    ASSERT_GE(nearby.distance_to_vertex(box.center(), box), least - 1e-12);
  }
}

TEST(PatchesOfLeaves, AreAllThatLiveEachWithItsLeaf) {
  const Contoured made(testing::torus_field());
  const auto leaves = static_cast<std::uint32_t>(made.on.tree.leaves().size());
  const PatchesOfLeaves patches(made.contour, leaves);
  std::size_t count = 0;
  for (std::uint32_t leaf = 0; leaf < leaves; ++leaf)
    for (const std::uint32_t p : patches.of(leaf)) {
      EXPECT_EQ(made.contour.patches[p].leaf, leaf);
      ++count;
    }
  EXPECT_EQ(count, made.contour.patches.size());
}

}  // namespace
}  // namespace cambium
