#include "blobtree/cell_grid.h"

#include "blobtree/input_error.h"
#include "random_blobtrees.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>

namespace cambium {
namespace {

TEST(CellGrid, CoversItsBoundsWithACellToSpare) {
  Draws draws(1);
  for (int i = 0; i < 200; ++i) {
    const Box bounds = draws.box({Vec3(-40), Vec3(60)});
    const double cell = draws.in(0.01, 3);
    const CellGrid grid = cell_grid(bounds, cell);
    const Box root = grid.box({0, 0, 0}, grid.levels);
    for (int a = 0; a < 3; ++a) {
      EXPECT_LE(root.lo[a], bounds.lo[a] - cell);
      EXPECT_GE(root.hi[a], bounds.hi[a] + cell);
    }
  }
}

TEST(CellGrid, NeighboursShareTheirFaceToTheLastBit) {
  const CellGrid grid = cell_grid({Vec3(-1.3, 0.2, 7), Vec3(2.1, 3, 9)}, 0.0371);
  for (std::uint32_t i = 0; i < 50; ++i) {
    EXPECT_EQ(grid.box({i, 3, 5}, 0).hi.x, grid.box({i + 1, 3, 5}, 0).lo.x);
    EXPECT_EQ(grid.box({4 * i, 8, 0}, 2).hi.x, grid.box({4 * i + 3, 8, 0}, 0).hi.x);   // and so do levels
  }
}

TEST(CellGrid, PlaceOfAPointIsTheCellThatHoldsIt) {
  Draws draws(2);
  for (int i = 0; i < 200; ++i) {
    const CellGrid grid = cell_grid(draws.box({Vec3(-40), Vec3(60)}), draws.in(0.01, 3));
    const Box root = grid.box({0, 0, 0}, grid.levels);
    const Vec3 inside = draws.point(root);
    const CellPlace of = grid.place_of(inside).value();
    const Box cell = grid.box(of, 0);
    for (int a = 0; a < 3; ++a) {
      EXPECT_LE(cell.lo[a], inside[a]);
      EXPECT_LT(inside[a], cell.hi[a]);
    }
    EXPECT_EQ(grid.place_of(cell.lo), of);   // low faces belong to the cell, to the last bit
    EXPECT_EQ(grid.place_of(root.lo), CellPlace{});
    Vec3 next = cell.lo;
    next.y = cell.hi.y;
    if (of[1] + 1 < 1u << grid.levels) EXPECT_EQ(grid.place_of(next), (CellPlace{of[0], of[1] + 1, of[2]}));
    for (int a = 0; a < 3; ++a) {
      for (const double beyond : {root.hi[a], std::nextafter(root.lo[a], -kInfinity), kInfinity, -kInfinity, std::nan("")}) {
        Vec3 p = inside;
        p[a] = beyond;
        EXPECT_FALSE(grid.place_of(p)) << beyond;
      }
    }
  }
}

TEST(CellGrid, RefusesCellsThatCannotBeCounted) {
  const Box bounds{Vec3(0), Vec3(10)}, far{Vec3(1e9), Vec3(1e9 + 1)};
  for (const double cell : {0.0, -1.0, std::nan(""), kInfinity, 1e-6}) EXPECT_THROW(cell_grid(bounds, cell), InputError) << cell;
  EXPECT_THROW(cell_grid(far, 1e-5), InputError);
  EXPECT_NO_THROW(cell_grid(bounds, 1e-5));
}

TEST(CellGrid, MortonKeysVisitTheOctreeDepthFirst) {
  EXPECT_EQ(morton_key({1, 0, 0}), 1u);
  EXPECT_EQ(morton_key({0, 1, 0}), 2u);
  EXPECT_EQ(morton_key({0, 0, 1}), 4u);
  EXPECT_EQ(morton_key({3, 3, 3}), 63u);
  EXPECT_EQ(morton_key({2, 0, 0}), 8u);
  const std::uint32_t top = (1u << kMostLevels) - 1;
  EXPECT_EQ(morton_key({top, top, top}), (std::uint64_t{1} << (3 * kMostLevels)) - 1);
}

}  // namespace
}  // namespace cambium
