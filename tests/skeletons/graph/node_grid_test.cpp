#include "skeletons/graph/node_grid.h"

#include "tests/skeletons/graph/node_clouds.h"

#include <gtest/gtest.h>

namespace cambium {
namespace {

using namespace testing;

constexpr auto kNoneSkipped = [](int, int) { return false; };

TEST(NodeGrid, RingsHoldEachNodeOnceAndClearanceIsKept) {
  const std::vector<Vec3> places = random_places(700, 2);
  const NodeGrid grid(places, 0.1);
  for (const std::uint32_t u : {0u, 5u, 100u, 699u}) {
    const NodeGrid::Cell cell = grid.cell_of(places[u]);
    std::vector<int> ring_of(places.size(), -1);
    for (int ring = 0; ring < 40; ++ring)
      grid.visit_ring(cell, ring, kNoneSkipped, [&](std::uint32_t v) {
        EXPECT_EQ(ring_of[v], -1);
        ring_of[v] = ring;
      });
    for (std::uint32_t v = 0; v < places.size(); ++v) {
      ASSERT_GE(ring_of[v], 0);
      if (ring_of[v] > 0) { EXPECT_GE(glm::length(places[v] - places[u]), grid.clearance(places[u], cell, ring_of[v] - 1)); }
    }
    EXPECT_EQ(grid.clearance(places[u], cell, 40), kInfinity);
  }
}

TEST(NodeGrid, RowsThatAreSkippedAreLeftOutAndNoOthers) {
  const std::vector<Vec3> places = random_places(700, 2);
  const NodeGrid grid(places, 0.1);
  const NodeGrid::Cell cell = grid.cell_of({0.5, 0.5, 0.5});
  std::size_t visited = 0, expected = 0;
  grid.visit_ring(cell, 2, [](int dy, int dz) { return dy < 0 || dz != 1; }, [&](std::uint32_t v) {
    const NodeGrid::Cell other = grid.cell_of(places[v]);
    EXPECT_GE(other[1], cell[1]);
    EXPECT_EQ(other[2], cell[2] + 1);
    ++visited;
  });
  grid.visit_ring(cell, 2, kNoneSkipped, [&](std::uint32_t v) {
    const NodeGrid::Cell other = grid.cell_of(places[v]);
    expected += other[1] >= cell[1] && other[2] == cell[2] + 1;
  });
  EXPECT_EQ(visited, expected);
  EXPECT_GT(visited, 0u);
}

TEST(NodeGrid, SlabsAreAsFarAsTheirNearestPlace) {
  const std::vector<Vec3> places = random_places(300, 6);
  const NodeGrid grid(places, 0.15);
  for (std::uint32_t u = 0; u < 20; ++u)
    for (std::uint32_t v = 0; v < places.size(); ++v)
      for (std::size_t axis = 0; axis < 3; ++axis) {
        const NodeGrid::Cell a = grid.cell_of(places[u]), b = grid.cell_of(places[v]);
        const double along = std::abs(places[v][int(axis)] - places[u][int(axis)]);
        EXPECT_LE(grid.distance_to(places[u], a, axis, b[axis] - a[axis]), along + 1e-12);
        EXPECT_GE(grid.distance_to(places[u], a, axis, b[axis] - a[axis]), along - grid.side() - 1e-12);
      }
}

TEST(NodeGrid, NaturalSpacingIsThatOfNodesStrewnByPoissonDisc) {
  const PoissonDiscNodes nodes = poisson_disc(ball(1), {}, {.count = 20000}, threads(1)).value();
  for (const double side : {0.1, 1.25, 1.5, 2.5})
    EXPECT_NEAR(NodeGrid(nodes.positions, side * nodes.spacing).natural_spacing() / nodes.spacing, 1, 0.3) << side;
}

TEST(NodeGrid, OfNoNodesOrOfManyAtOnePlaceIsSound) {
  const NodeGrid none({}, 1);
  EXPECT_GT(none.natural_spacing(), 0);
  const std::vector<Vec3> same(50, Vec3{1, 1, 1});
  const NodeGrid one(same, 1e-9);
  std::size_t count = 0;
  one.visit_ring(one.cell_of(same[0]), 0, kNoneSkipped, [&](std::uint32_t) { ++count; });
  EXPECT_EQ(count, 50u);
}

}  // namespace
}  // namespace cambium
