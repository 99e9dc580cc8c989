#include "blobtree/cell_search.h"

#include "blobtree/input_error.h"
#include "blobtree/progress_meter.h"
#include "random_blobtrees.h"

#include <gtest/gtest.h>

#include <array>
#include <mutex>
#include <set>

namespace cambium {
namespace {

Field field_of(Node node) {
  BlobTreeBuilder b;
  const NodeId root = b.add(std::move(node));
  return Field(b.build(root));
}

struct Found {
  std::set<CellPlace> places;
  bool complete = false;
};

Found search(const Field& field, const CellGrid& grid, Wanted wanted, const RunOptions& run = {}) {
  Found found;
  std::mutex mutex;
  ProgressMeter progress(run, "searching");
  found.complete = visit_cells(
      field, grid, wanted,
      [&](Evaluator&, const PrunedField& pruned, const CellPlace& place) {
        EXPECT_FALSE(pruned.empty());
        EXPECT_EQ(pruned.box().lo, grid.box(place, 0).lo);
        EXPECT_EQ(pruned.box().hi, grid.box(place, 0).hi);
        const std::lock_guard lock(mutex);
        EXPECT_TRUE(found.places.insert(place).second) << "visited twice";
      },
      run, progress);
  return found;
}

TEST(CellGrid, CoversTheBoundsWithACellToSpare) {
  const Box bounds{Vec3(-3.3, 1.7, 100.2), Vec3(4.1, 2.0, 131)};
  for (const double cell : {0.1, 3.2, 56.0}) {
    const CellGrid grid = cell_grid(bounds, cell);
    const Box root = grid.box({0, 0, 0}, grid.levels);
    for (int a = 0; a < 3; ++a) {
      EXPECT_LE(root.lo[a], bounds.lo[a] - cell * 0.999);
      EXPECT_GE(root.hi[a], bounds.hi[a] + cell * 0.999);
    }
  }
}

TEST(CellGrid, NeighboursShareCornersToTheLastBitAndKeysGoDepthFirst) {
  const CellGrid grid = cell_grid({Vec3(-1), Vec3(1)}, 0.013);
  for (std::uint32_t i = 0; i < 50; ++i) {
    EXPECT_EQ(grid.box({i, 3, 5}, 0).hi.x, grid.box({i + 1, 3, 5}, 0).lo.x);
    EXPECT_EQ(grid.box({4 * i, 8, 4}, 2).hi.y, grid.box({4 * i, 12, 4}, 1).lo.y);
  }
  EXPECT_EQ(morton_key({1, 0, 0}), 1u);
  EXPECT_EQ(morton_key({0, 1, 0}), 2u);
  EXPECT_EQ(morton_key({3, 3, 3}), 63u);
  EXPECT_EQ(morton_key({0, 0, (1u << 21) - 1}), 0x4924924924924924u);
}

TEST(CellGrid, CellsTooFineToCountAreAnInputError) {
  EXPECT_THROW(cell_grid({Vec3(0), Vec3(100)}, 1e-5), InputError);
  EXPECT_THROW(cell_grid({Vec3(1e9), Vec3(1e9 + 1)}, 1e-6), InputError);
  EXPECT_THROW(cell_grid({Vec3(0), Vec3(1)}, 0), InputError);
  EXPECT_NO_THROW(cell_grid({Vec3(0), Vec3(100)}, 1e-4));
}

TEST(CellSearch, NoCellWithASignChangeOrMatterIsMissed) {
  for (std::uint64_t seed = 1; seed < 16; ++seed) {
    SCOPED_TRACE(seed);
    const Field field(random_blobtree(seed, 3));
    const double cell = 0.3;
    const CellGrid grid = cell_grid(field.bounds(), cell);
    const Found surface = search(field, grid, Wanted::kSurface), matter = search(field, grid, Wanted::kMatter);
    EXPECT_TRUE(surface.complete && matter.complete);
    const std::uint32_t cells = 1u << grid.levels;
    for (std::uint32_t z = 0; z < cells; ++z)
      for (std::uint32_t y = 0; y < cells; ++y)
        for (std::uint32_t x = 0; x < cells; ++x) {
          const Box box = grid.box({x, y, z}, 0);
          if (!box.intersects(field.bounds())) {
            ASSERT_FALSE(matter.places.count({x, y, z}));
            continue;
          }
          bool inside = false, outside = false, above = false;
          for (int i = 0; i < 27; ++i) {
            const double f = field.value(box.lo + box.size() * Vec3(i % 3, i / 3 % 3, i / 9) / 2.0);
            (f >= kIso ? inside : outside) = true;
            above = above || f > 0;
          }
          ASSERT_TRUE(!(inside && outside) || surface.places.count({x, y, z}));
          ASSERT_TRUE(!above || matter.places.count({x, y, z}));
        }
  }
}

TEST(CellSearch, RejectsNearlyAllThatHoldsNoSurface) {
  const Field ball = field_of(Sphere{{0.03, -0.02, 0.01}, 1, 1});
  const double cell = 0.06;
  const Found found = search(ball, cell_grid(ball.bounds(), cell), Wanted::kSurface);
  // A sphere of area 12.6 meets about 1.5 cells for each cell^2 of it.
  EXPECT_GT(found.places.size(), 1.2 * 12.57 / (cell * cell));
  EXPECT_LT(found.places.size(), 4 * 12.57 / (cell * cell));
}

TEST(CellSearch, WorkFollowsTheSurfaceAndNotTheBox) {
  // A twig of 1 mm in a diagonal 20 m long: a dense grid of these cells would have 10^9 of them.
  const Field field = field_of(Chain{{{Vec3(0), 0.001}, {Vec3(12, 11, 13), 0.001}}, 1});
  const Found found = search(field, cell_grid(field.bounds(), 0.016), Wanted::kSurface);
  EXPECT_GT(found.places.size(), 1000u);
  EXPECT_LT(found.places.size(), 20000u);
}

TEST(CellSearch, CancelledOrStoppedItSaysSo) {
  const std::atomic<bool> yes{true};
  RunOptions run;
  run.cancel = &yes;
  const Field field = field_of(Sphere{{0, 0, 0}, 1, 1});
  const CellGrid grid = cell_grid(field.bounds(), 0.1);
  EXPECT_FALSE(search(field, grid, Wanted::kSurface, run).complete);
  const RunOptions quiet;
  ProgressMeter progress(quiet, "searching");
  const auto visit = [](Evaluator&, const PrunedField&, const CellPlace&) {};
  EXPECT_FALSE(visit_cells(field, grid, Wanted::kSurface, visit, quiet, progress, &yes));
}

}  // namespace
}  // namespace cambium
