#include "polygonize/minimal_edges.h"

#include "tests/polygonize/octrees.h"
#include "tests/polygonize/sample_fields.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <map>
#include <set>
#include <tuple>

namespace cambium {
namespace {

using testing::coarse_octree;
using testing::live_leaves;
using testing::OnOctree;

struct Expected {
  std::set<std::tuple<int, CellPlace, std::array<std::uint32_t, 4>, bool>> edges;   // axis, low end, leaves, low_inside
  std::set<std::uint32_t> to_split;
};

/// All edges of all leaves, line by line; those that no shorter one lies in are minimal.
Expected brute_force(const SurfaceOctree& tree) {
  struct Piece {
    std::uint64_t begin, end;
    bool low_inside, crossed;
    auto operator<=>(const Piece&) const = default;
  };
  std::map<std::array<std::uint32_t, 3>, std::vector<Piece>> lines;   // axis, and where on the other two
  for (const std::uint32_t i : live_leaves(tree)) {
    const OctreeLeaf& leaf = tree.leaves()[i];
    for (int e = 0; e < 12; ++e) {
      const int a = e / 4, low = edge_low_corner(e), high = edge_high_corner(e);
      CellPlace at = leaf.place;
      for (int k = 0; k < 3; ++k) at[k] += static_cast<std::uint32_t>(low >> k & 1) << leaf.level;
      const bool low_inside = leaf.mask >> low & 1, high_inside = leaf.mask >> high & 1;
      lines[{static_cast<std::uint32_t>(a), at[(a + 1) % 3], at[(a + 2) % 3]}].push_back(
          {at[a], at[a] + (std::uint64_t{1} << leaf.level), low_inside, low_inside != high_inside});
    }
  }
  Expected expected;
  for (auto& [line, pieces] : lines) {
    std::sort(pieces.begin(), pieces.end());
    pieces.erase(std::unique(pieces.begin(), pieces.end()), pieces.end());
    const int a = static_cast<int>(line[0]), b = (a + 1) % 3, c = (a + 2) % 3;
    for (const Piece& piece : pieces) {
      const auto within = [&](const Piece& o) { return o.begin >= piece.begin && o.end <= piece.end && o != piece; };
      if (!piece.crossed || std::any_of(pieces.begin(), pieces.end(), within)) continue;
      CellPlace low{};
      low[a] = static_cast<std::uint32_t>(piece.begin), low[b] = line[1], low[c] = line[2];
      std::array<std::uint32_t, 4> leaves{};
      for (int q = 0; q < 4; ++q) {
        CellPlace unit = low;
        if (!(q & 1)) --unit[b];
        if (!(q >> 1)) --unit[c];
        const auto found = tree.find(unit);
        EXPECT_TRUE(found.has_value()) << "a crossed edge beside nothing";
        leaves[q] = found.value_or(0);
      }
      expected.edges.insert({a, low, leaves, piece.low_inside});
      for (const std::uint32_t i : leaves) {
        const OctreeLeaf& leaf = tree.leaves()[i];
        const std::uint64_t edge = std::uint64_t{1} << leaf.level;
        bool cut = edge > 2 * (piece.end - piece.begin);
        for (int e = 4 * a; e < 4 * a + 4; ++e) {   // the leaf's edge that holds this one, if one does
          CellPlace at = leaf.place;
          for (int k = 0; k < 3; ++k) at[k] += static_cast<std::uint32_t>(edge_low_corner(e) >> k & 1) << leaf.level;
          if (at[b] == low[b] && at[c] == low[c] && !edge_crossed(leaf.mask, e)) cut = true;
        }
        if (cut) expected.to_split.insert(i);
      }
    }
  }
  return expected;
}

std::size_t expect_same(const SurfaceOctree& tree, const MinimalEdges& found) {
  const Expected expected = brute_force(tree);
  std::set<std::tuple<int, CellPlace, std::array<std::uint32_t, 4>, bool>> edges;
  for (const MinimalEdge& edge : found.edges) {
    const OctreeLeaf& owner = tree.leaves()[edge.owner()];
    for (const std::uint32_t leaf : edge.leaves) EXPECT_GE(tree.leaves()[leaf].level, owner.level);
    EXPECT_TRUE(edges.insert({edge.axis, testing::low_place(tree, edge), edge.leaves, edge.low_inside}).second) << "found twice";
  }
  EXPECT_EQ(edges, expected.edges);
  EXPECT_EQ(std::set<std::uint32_t>(found.to_split.begin(), found.to_split.end()), expected.to_split);
  EXPECT_TRUE(std::is_sorted(found.to_split.begin(), found.to_split.end()));
  EXPECT_EQ(found.to_split.size(), expected.to_split.size());
  return edges.size();
}

TEST(MinimalEdges, AreThoseOfBruteForce) {
  std::size_t edges = 0, unsettled = 0;
  for (std::uint64_t seed = 1; seed <= 45; ++seed) {
    SCOPED_TRACE(seed);
    const Field field = testing::any_field(seed);
    // Straight from build() neighbours differ by any number of levels; after split() they do not.
    OnOctree on = coarse_octree(field, testing::longest_side(field) / 5, 4, {.radii = seed % 2 ? 3.0 : 10.0});
    const MinimalEdges raw = crossed_minimal_edges(on.tree, {}).value();
    edges += expect_same(on.tree, raw);
    unsettled += raw.to_split.size();
    Draws draws(seed);
    testing::split_at_random(on, draws, 0.1);
    edges += expect_same(on.tree, crossed_minimal_edges(on.tree, {}).value());
    testing::contour_on(on);
    const MinimalEdges settled = crossed_minimal_edges(on.tree, {}).value();
    edges += expect_same(on.tree, settled);
    EXPECT_TRUE(settled.to_split.empty());
  }
  EXPECT_GT(edges, 20000u);
  EXPECT_GT(unsettled, 100u) << "the case this is for";
}

TEST(MinimalEdges, OfOneSphereInEightLeaves) {
  const OnOctree on = coarse_octree(testing::sphere_field(0.3, Vec3(0.01, 0.02, 0.03)), 1, 0);
  const MinimalEdges found = crossed_minimal_edges(on.tree, {}).value();
  ASSERT_EQ(found.edges.size(), 6u);   // from the origin, which is inside, along each axis
  for (const MinimalEdge& edge : found.edges) {
    EXPECT_EQ(std::set<std::uint32_t>(edge.leaves.begin(), edge.leaves.end()).size(), 4u);
    EXPECT_EQ(edge.finest, 0);
  }
  EXPECT_TRUE(found.to_split.empty());
}

}  // namespace
}  // namespace cambium
