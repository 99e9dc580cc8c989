#include "polygonize/surface_octree.h"

#include "tests/polygonize/octrees.h"
#include "tests/polygonize/sample_fields.h"

#include <gtest/gtest.h>
#include <tbb/global_control.h>

#include <algorithm>
#include <atomic>
#include <map>

namespace cambium {
namespace {

using testing::coarse_octree;
using testing::live_leaves;
using testing::OnOctree;

double volume_of(const SurfaceOctree& tree) {
  double units = 0;
  for (const std::uint32_t leaf : live_leaves(tree)) units += std::ldexp(1.0, 3 * tree.leaves()[leaf].level);
  return units;
}

void expect_tiled(const OnOctree& on, int finer) {
  double cover_units = 0;
  for (std::size_t i = 0; i < on.cover.size(); ++i) cover_units += std::ldexp(1.0, 3 * (on.cover.level(i) + finer));
  EXPECT_EQ(volume_of(on.tree), cover_units);
  for (const std::uint32_t i : live_leaves(on.tree)) {
    const OctreeLeaf& leaf = on.tree.leaves()[i];
    const Box cube = on.cover.cube(leaf.cell), box = on.tree.box(leaf);
    for (int a = 0; a < 3; ++a) {
      ASSERT_EQ(leaf.place[a] & ((1u << leaf.level) - 1), 0u);
      ASSERT_GE(box.lo[a], cube.lo[a]);
      ASSERT_LE(box.hi[a], cube.hi[a]);
    }
    for (int c = 0; c < 8; ++c) {   // the unit cubes in its corners are its own
      CellPlace place = leaf.place;
      for (int a = 0; a < 3; ++a) place[a] += (c >> a & 1) ? (1u << leaf.level) - 1 : 0;
      ASSERT_EQ(on.tree.find(place), i);
    }
  }
}

void expect_true_corners(const OnOctree& on, const Field& field) {
  for (const std::uint32_t i : live_leaves(on.tree)) {
    const OctreeLeaf& leaf = on.tree.leaves()[i];
    for (int c = 0; c < 8; ++c) {
      CellPlace place = leaf.place;
      for (int a = 0; a < 3; ++a) place[a] += static_cast<std::uint32_t>(c >> a & 1) << leaf.level;
      ASSERT_EQ(leaf.mask >> c & 1, field.value(on.tree.point(place)) >= kIso ? 1 : 0) << "leaf " << i << " corner " << c;
    }
  }
}

TEST(SurfaceOctree, LeavesTileTheCoverAndTheirCornersAreTheFieldsOwn) {
  for (std::uint64_t seed = 1; seed <= 18; ++seed) {
    SCOPED_TRACE(seed);
    const Field field = testing::any_field(seed);
    OnOctree on = coarse_octree(field, testing::longest_side(field) / 7, 4, {.radii = seed % 3 == 0 ? kInfinity : 2.0});
    expect_tiled(on, 4);
    expect_true_corners(on, field);
    Draws draws(seed);
    for (int turn = 0; turn < 2; ++turn) testing::split_at_random(on, draws, 0.05);
    expect_tiled(on, 4);
    expect_true_corners(on, field);
  }
}

TEST(SurfaceOctree, LeavesFollowTheRadiusTheSagittaAndTheLongest) {
  BlobTreeBuilder b;
  const NodeId trunk = b.add(Chain{{{Vec3(0, 0, 0), 0.3}, {Vec3(0, 0, 2), 0.3}}, 1});
  const NodeId twig = b.add(Chain{{{Vec3(2, 0, 0), 0.03}, {Vec3(2, 0, 1), 0.03}}, 1});
  const Field field(b.build(b.add(Sum{{trunk, twig}})));
  const OnOctree plain = coarse_octree(field, 0.08, 5, {.radii = 1});
  const OnOctree flat = coarse_octree(field, 0.08, 5, {.radii = 1, .sagitta = 0.003});
  const OnOctree small = coarse_octree(field, 0.08, 5, {.radii = 1, .longest = 0.05});
  const auto largest = [](const OnOctree& on, bool at_twig) {
    double edge = 0;
    for (const std::uint32_t i : live_leaves(on.tree)) {
      const OctreeLeaf& leaf = on.tree.leaves()[i];
      if ((on.tree.box(leaf).center().x > 1) == at_twig && !leaf.uniform()) edge = std::max(edge, on.tree.edge(leaf));
    }
    return edge;
  };
  EXPECT_DOUBLE_EQ(largest(plain, false), 0.08);   // the cover's own
  EXPECT_DOUBLE_EQ(largest(plain, true), 0.02);    // the halving of 0.08 that is no longer than 0.03
  EXPECT_DOUBLE_EQ(largest(flat, false), 0.02);    // sqrt(0.003 0.3) = 0.03
  EXPECT_DOUBLE_EQ(largest(flat, true), 0.005);    // sqrt(0.003 0.03) = 0.0095
  EXPECT_DOUBLE_EQ(largest(small, false), 0.04);
  EXPECT_DOUBLE_EQ(largest(small, true), 0.02);
  const LeafRule rule{.radii = 2, .sagitta = 0.5, .longest = 0.7};
  EXPECT_DOUBLE_EQ(rule.edge(0.02), 0.04);
  EXPECT_DOUBLE_EQ(rule.edge(0.5), 0.5);
  EXPECT_DOUBLE_EQ(rule.edge(kInfinity), 0.7);
}

// Two spheres 0.02 apart in cells of 0.25: corners all inside say nothing of the gap, the tangents do.
TEST(SurfaceOctree, AGapBetweenCornersThatAreInsideIsCutUntilItShows) {
  BlobTreeBuilder b;
  const NodeId left = b.add(Sphere{Vec3(-0.385, 0.125, 0.125), 0.5, 1}), right = b.add(Sphere{Vec3(0.635, 0.125, 0.125), 0.5, 1});
  const Field field(b.build(b.add(Union{{left, right}})));
  const auto outside_in_the_gap = [&](double shortest_gap) {
    const OnOctree on = coarse_octree(field, 0.25, 6, {.radii = kInfinity, .shortest_gap = shortest_gap});
    int corners = 0;
    for (const std::uint32_t i : live_leaves(on.tree)) {
      const OctreeLeaf& leaf = on.tree.leaves()[i];
      const Box box = on.tree.box(leaf);
      for (int c = 0; c < 8; ++c) {
        const Vec3 p(c & 1 ? box.hi.x : box.lo.x, c & 2 ? box.hi.y : box.lo.y, c & 4 ? box.hi.z : box.lo.z);
        if (p.x > 0.1 && p.x < 0.15 && std::hypot(p.y - 0.125, p.z - 0.125) < 0.13) corners += !(leaf.mask >> c & 1);
      }
    }
    return corners;
  };
  EXPECT_EQ(outside_in_the_gap(kInfinity), 0) << "the case this is for";
  EXPECT_GT(outside_in_the_gap(0), 0);
  EXPECT_EQ(outside_in_the_gap(0.2), 0) << "but not below what is asked for";
}

// Cracks that are too narrow for the leaves are filled corner by corner, which every leaf must see alike.
TEST(SurfaceOctree, LeavesAgreeOnTheCornersTheyShare) {
  std::size_t shared = 0, filled = 0;
  const auto try_field = [&](std::uint64_t seed, double cells, double gaps) {
    SCOPED_TRACE(seed);
    const Field field = testing::any_field(seed);
    const double side = testing::longest_side(field);
    OnOctree on = coarse_octree(field, side / cells, 3, {.radii = 2.0, .shortest_gap = side / gaps});
    Draws draws(seed);
    testing::split_at_random(on, draws, 0.05);
    std::map<CellPlace, int> inside;
    for (const std::uint32_t i : live_leaves(on.tree)) {
      const OctreeLeaf& leaf = on.tree.leaves()[i];
      for (int c = 0; c < 8; ++c) {
        CellPlace place = leaf.place;
        for (int a = 0; a < 3; ++a) place[a] += static_cast<std::uint32_t>(c >> a & 1) << leaf.level;
        const int bit = leaf.mask >> c & 1;
        const auto [known, first] = inside.try_emplace(place, bit);
        ASSERT_EQ(known->second, bit) << "at a corner of leaf " << i;
        shared += !first;
        filled += first && bit != (field.value(on.tree.point(place)) >= kIso);
      }
    }
  };
  for (std::uint64_t seed = 1; seed <= 45; ++seed) try_field(seed, 12, 40);
  try_field(3, 8, 80);    // beside a crack the next cell's field is smooth
  try_field(48, 8, 40);
  EXPECT_GT(shared, 10000u);
  EXPECT_GT(filled, 10u) << "the case this is for";
}

TEST(SurfaceOctree, ASplitLeafIsReplacedByEightAndNeighboursKeepUp) {
  const Field field = testing::noise_field(11);
  OnOctree on = coarse_octree(field, 0.3, 5);
  testing::contour_on(on);
  Draws draws(3);
  for (int turn = 0; turn < 4; ++turn) {
    std::vector<std::uint32_t> wanted;
    for (const std::uint32_t i : live_leaves(on.tree))
      if (on.tree.leaves()[i].level > 1 && draws.chance(0.02)) wanted.push_back(i);
    ASSERT_FALSE(wanted.empty());
    const std::size_t before = on.tree.leaves().size();
    const double volume = volume_of(on.tree);
    const auto cut = on.tree.split(on.cover, wanted, {});
    EXPECT_TRUE(std::includes(cut.begin(), cut.end(), wanted.begin(), wanted.end()));
    EXPECT_EQ(volume_of(on.tree), volume);
    EXPECT_EQ((on.tree.leaves().size() - before) % 8, 0u);
    for (const std::uint32_t i : wanted) {
      const OctreeLeaf& leaf = on.tree.leaves()[i];
      const auto now = on.tree.find(leaf.place);
      ASSERT_TRUE(now.has_value());
      EXPECT_NE(*now, i);
      EXPECT_LT(on.tree.leaves()[*now].level, leaf.level);
      EXPECT_GE(*now, before);
    }
  }
}

TEST(SurfaceOctree, IsTheSameForAnyNumberOfThreads) {
  const Field field = testing::noise_field(5);
  std::vector<OctreeLeaf> first;
  for (const std::size_t threads : {1u, 2u, 4u}) {
    const tbb::global_control limit(tbb::global_control::max_allowed_parallelism, threads);
    OnOctree on = coarse_octree(field, 0.3, 4, {.radii = 1});
    Draws draws(9);
    testing::split_at_random(on, draws, 0.1);
    const auto& leaves = on.tree.leaves();
    if (first.empty()) first = leaves;
    EXPECT_TRUE(std::equal(first.begin(), first.end(), leaves.begin(), leaves.end(), [](const OctreeLeaf& a, const OctreeLeaf& b) {
      return a.cell == b.cell && a.place == b.place && a.level == b.level && a.mask == b.mask;
    }));
  }
}

TEST(SurfaceOctree, StopsWhenCancelled) {
  const Field field = testing::sphere_field();
  OnOctree on = coarse_octree(field, 0.2, 3);
  const std::atomic<bool> cancel{true};
  RunOptions run;
  run.cancel = &cancel;
  EXPECT_FALSE(SurfaceOctree::build(on.cover, 3, {}, run));
  EXPECT_TRUE(on.tree.split(on.cover, live_leaves(on.tree), run).empty());
  EXPECT_FALSE(crossed_minimal_edges(on.tree, run));
}

TEST(SurfaceOctree, OfAnEmptyCoverIsEmpty) {
  const SurfaceOctree tree = SurfaceOctree::build(SurfaceCover{}, 3, {}, {}).value();
  EXPECT_TRUE(tree.leaves().empty());
  EXPECT_FALSE(tree.find({0, 0, 0}));
  EXPECT_TRUE(crossed_minimal_edges(tree, {})->edges.empty());
}

}  // namespace
}  // namespace cambium
