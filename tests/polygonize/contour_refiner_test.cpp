#include "polygonize/contour_refiner.h"

#include "polygonize/polygon_ring.h"
#include "polygonize/tube_runs.h"
#include "tests/polygonize/mesh_checks.h"
#include "tests/polygonize/octrees.h"
#include "tests/polygonize/sample_fields.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <atomic>
#include <map>
#include <set>
#include <tuple>

namespace cambium {
namespace {

using testing::coarse_octree;
using testing::OnOctree;

using EdgeKey = std::tuple<int, CellPlace, int>;   // axis, low end, level

EdgeKey key_of(const SurfaceOctree& tree, const MinimalEdge& edge) {
  return {edge.axis, testing::low_place(tree, edge), tree.leaves()[edge.owner()].level};
}

/// By edge: its crossing; and the patches as sets of their leaf and edges, each with its vertex.
struct Described {
  std::map<EdgeKey, float> crossings;
  std::map<std::pair<CellPlace, std::set<EdgeKey>>, std::tuple<std::array<double, 3>, bool>> patches;
};

Described described(const SurfaceOctree& tree, const Contour& contour) {
  Described result;
  for (std::size_t i = 0; i < contour.edges.size(); ++i) result.crossings[key_of(tree, contour.edges[i])] = contour.crossings[i].t;
  for (std::uint32_t p = 0; p < contour.patches.size(); ++p) {
    std::set<EdgeKey> ring;
    for (const std::uint32_t e : contour.ring(p)) ring.insert(key_of(tree, contour.edges[e]));
    const Vec3& at = contour.vertices[p].position;
    result.patches[{tree.leaves()[contour.patches[p].leaf].place, ring}] = {{at.x, at.y, at.z}, contour.vertices[p].crease};
  }
  return result;
}

/// The same edges, crossings and patches; a vertex may differ by what the order of its crossings does to sums.
void expect_same(const Described& a, const Described& b) {
  EXPECT_EQ(a.crossings.size(), b.crossings.size());
  for (const auto& [edge, t] : a.crossings) {
    ASSERT_TRUE(b.crossings.contains(edge));
    ASSERT_EQ(b.crossings.at(edge), t);
  }
  EXPECT_EQ(a.patches.size(), b.patches.size());
  for (const auto& [patch, vertex] : a.patches) {
    ASSERT_TRUE(b.patches.contains(patch));
    const auto& [at, crease] = vertex;
    const auto& [other, other_crease] = b.patches.at(patch);
    EXPECT_EQ(crease, other_crease);
    for (int axis = 0; axis < 3; ++axis) EXPECT_NEAR(at[axis], other[axis], 1e-8);
  }
}

std::vector<std::uint32_t> some_leaves(const SurfaceOctree& tree, Draws& draws, double share) {
  std::vector<std::uint32_t> leaves;
  for (const std::uint32_t leaf : testing::live_leaves(tree))
    if (tree.leaves()[leaf].level > 0 && draws.chance(share)) leaves.push_back(leaf);
  return leaves;
}

// What is kept from round to round must be what the octree as it is now would give.
TEST(ContourRefiner, KeepsWhatBeginningAnewWouldFind) {
  std::size_t edges = 0, relinked = 0;
  for (std::uint64_t seed = 1; seed <= 36; ++seed) {
    SCOPED_TRACE(seed);
    const Field field = testing::any_field(seed);
    Draws draws(seed);
    OnOctree on = coarse_octree(field, testing::longest_side(field) / (4 + draws.below(6)), 3);
    ContourRefiner refiner = ContourRefiner::begin(on.tree, on.cover, {}).value();
    for (int round = 0; round < 4; ++round) {
      if (round > 0) {
        ASSERT_TRUE(refiner.split(some_leaves(refiner.tree(), draws, 0.04), {}));
      }
      if (round != 1) {   // rounds need not place what they find
        ASSERT_TRUE(refiner.place({}));
      }
    }
    EXPECT_TRUE(crossed_minimal_edges(refiner.tree(), {})->to_split.empty());
    refiner.compact(living_part(refiner.contour()));
    ContourRefiner fresh = ContourRefiner::begin(refiner.tree(), on.cover, {}).value();
    ASSERT_EQ(fresh.tree().leaves().size(), refiner.tree().leaves().size()) << "something had to be cut";
    ASSERT_TRUE(fresh.place({}));
    fresh.compact(living_part(fresh.contour()));
    const Described now = described(refiner.tree(), refiner.contour()), anew = described(fresh.tree(), fresh.contour());
    ASSERT_EQ(now.crossings.size(), anew.crossings.size());
    for (auto a = now.crossings.begin(), b = anew.crossings.begin(); a != now.crossings.end(); ++a, ++b) {
      ASSERT_EQ(a->first, b->first);
      ASSERT_NEAR(a->second, b->second, 5e-3f);   // the owner, and so the cell whose field is asked, may be another
    }
    EXPECT_EQ(now.patches.size(), anew.patches.size());
    std::size_t other = 0;
    for (const auto& [patch, vertex] : now.patches) other += !anew.patches.contains(patch);
    if (refiner.relinked_faces() == 0 && fresh.relinked_faces() == 0) {
      EXPECT_EQ(other, 0u);
    }
    edges += now.crossings.size();
    relinked += refiner.relinked_faces();
  }
  EXPECT_GT(edges, 10000u);
  EXPECT_GT(relinked, 0u) << "a case this is for";
}

TEST(ContourRefiner, StaysAManifoldFromRoundToRoundWhateverTheSignsAre) {
  std::size_t relinked = 0;
  for (std::uint64_t seed = 1; seed <= 6; ++seed) {
    SCOPED_TRACE(seed);
    Draws draws(seed);
    OnOctree on = coarse_octree(testing::noise_field(seed, 500), draws.in(0.1, 0.2), 3);
    ContourRefiner refiner = ContourRefiner::begin(on.tree, on.cover, {}).value();
    for (int round = 0; round < 4; ++round) {
      if (round > 0) {
        ASSERT_TRUE(refiner.split(some_leaves(refiner.tree(), draws, 0.03), {}));
      }
      ASSERT_TRUE(refiner.place({}));
      if (round % 2 == 1) refiner.compact(living_part(refiner.contour()));   // and goes on from there
      Contour contour = refiner.contour();
      compact(contour, living_part(contour));
      Mesh mesh;
      for (std::uint32_t i = 0; i < contour.edges.size(); ++i) {
        const Ring ring = ring_of(contour.edges[i], contour.patch_of_quadrant[i]);
        const auto center = static_cast<std::uint32_t>(contour.patches.size()) + i;
        for (int k = 0; k < ring.count; ++k) mesh.triangles.push_back({center, ring.patches[k], ring.patches[(k + 1) % ring.count]});
      }
      const auto checks = testing::check_mesh(mesh, false, contour.patches.size() + contour.edges.size());
      ASSERT_TRUE(checks.closed_manifold()) << "round " << round << ": " << checks;
      relinked += refiner.relinked_faces();
    }
  }
  EXPECT_GT(relinked, 10u) << "the case this is for";
}

// A twig with two shoots, whose stretches between are tubes at first.
TEST(ContourRefiner, FilledWhereTubesRanItIsTheContourWithoutThem) {
  BlobTreeBuilder b;
  const Vec3 up = glm::normalize(Vec3(1, 0.3, 1));
  std::vector<Lateral> shoots;
  for (const double z : {0.08, 0.22}) {
    const NodeId shoot = b.add(Chain{{{Vec3(0, 0, z), 0.002}, {Vec3(0, 0, z) + 0.1 * up, 0.002}}});
    shoots.push_back({shoot, {0, 0, z}, {0, 0, 1}, 0.002, 0.01});
  }
  const NodeId twig = b.add(Chain{{{{0, 0, 0}, 0.003}, {{0, 0.01, 0.15}, 0.003}, {{0, 0, 0.3}, 0.003}}});
  const Field field(b.build(b.add(Fork{twig, shoots, 0.5, 1})));
  const LeafRule rule{.radii = 1.1};
  CoverOptions options;
  options.unit = rule.edge(0.002) / 2;
  options.cell_radii = 3.2;
  const SurfaceCover cover = cover_surface(field, options, {}).value();
  const auto begun = [&](const TubeRuns& runs) {
    ContourRefiner refiner = ContourRefiner::begin(SurfaceOctree::build(cover, 0, rule, {}, &runs).value(), cover, {}).value();
    refiner.place({});
    refiner.compact(living_part(refiner.contour()));
    return refiner;
  };
  for (const std::vector<std::uint32_t>& misfits : {std::vector<std::uint32_t>{0, 1, 2, 3, 4}, {1}, {0, 3}}) {
    TubeRuns runs = TubeRuns::find(cover, rule, {.tolerance = 0.0005}, {}).value();
    ASSERT_EQ(runs.size(), 5u);
    ContourRefiner refiner = begun(runs);
    const std::size_t before = refiner.contour().edges.size();
    runs.remove(misfits);
    ASSERT_TRUE(refiner.fill({}));
    ASSERT_TRUE(refiner.place({}));
    refiner.compact(living_part(refiner.contour()));
    EXPECT_GT(refiner.contour().edges.size(), before + 100 * misfits.size());
    const ContourRefiner fresh = begun(runs);
    expect_same(described(refiner.tree(), refiner.contour()), described(fresh.tree(), fresh.contour()));
  }
}

TEST(ContourRefiner, StopsWhenCancelled) {
  OnOctree on = coarse_octree(testing::noise_field(3), 0.2, 3);
  std::atomic<bool> cancel{true};
  RunOptions run;
  run.cancel = &cancel;
  EXPECT_FALSE(ContourRefiner::begin(on.tree, on.cover, run));
  ContourRefiner refiner = ContourRefiner::begin(on.tree, on.cover, {}).value();
  EXPECT_FALSE(refiner.place(run));
  Draws draws(1);
  EXPECT_FALSE(refiner.split(some_leaves(refiner.tree(), draws, 0.1), run));
}

}  // namespace
}  // namespace cambium
