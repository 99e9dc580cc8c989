#include "polygonize/block_search.h"

#include "blobtree/progress_meter.h"
#include "tests/polygonize/sample_fields.h"

#include <gtest/gtest.h>

#include <atomic>
#include <mutex>
#include <set>

namespace cambium {
namespace {

struct Found {
  std::set<CellPlace> places;
  bool complete = false;
};

Found search(const Field& field, const Lattice& lattice, IntervalTest wanted, const RunOptions& run = {}) {
  Found found;
  std::mutex mutex;
  ProgressMeter progress(run, "searching");
  found.complete = search_blocks(
      field, lattice, wanted,
      [&](Evaluator&, const PrunedField& pruned, const CellPlace& place) {
        EXPECT_FALSE(pruned.empty());
        const std::lock_guard lock(mutex);
        EXPECT_TRUE(found.places.insert(place).second) << "visited twice";
      },
      run, progress);
  return found;
}

TEST(BlockSearch, NoBlockWithASignChangeIsMissed) {
  for (unsigned seed = 1; seed < 5; ++seed) {
    const Field field = testing::random_field(seed);
    const Lattice lattice = make_lattice(field.bounds(), 0.06);
    const Found found = search(field, lattice, holds_surface);
    EXPECT_TRUE(found.complete);
    const std::uint32_t blocks = 1u << lattice.levels;
    std::size_t crossed = 0;
    for (std::uint32_t bz = 0; bz < blocks; ++bz)
      for (std::uint32_t by = 0; by < blocks; ++by)
        for (std::uint32_t bx = 0; bx < blocks; ++bx) {
          const Box box = lattice.box({bx, by, bz}, 0);
          if (!box.intersects(field.bounds())) continue;
          bool inside = false, outside = false;
          for (int i = 0; i < 125; ++i) {
            const Vec3 p = box.lo + box.size() * Vec3(i % 5, i / 5 % 5, i / 25) / 4.0;
            (field.value(p) >= kIso ? inside : outside) = true;
          }
          if (inside && outside) {
            ++crossed;
            EXPECT_TRUE(found.places.count({bx, by, bz}));
          }
        }
    EXPECT_GT(crossed, 20u);
    EXPECT_LT(found.places.size(), 4 * crossed) << "hardly anything is rejected";
  }
}

TEST(BlockSearch, WorkFollowsTheSurfaceAndNotTheBox) {
  // A twig of 1 mm in a diagonal 20 m long: a dense grid of these blocks would have 10^9 of them.
  const Field field = testing::field_of(Chain{{{Vec3(0), 0.001}, {Vec3(12, 11, 13), 0.001}}, 1});
  const Lattice lattice = make_lattice(field.bounds(), 0.002);
  const Found found = search(field, lattice, holds_surface);
  EXPECT_GT(found.places.size(), 1000u);
  EXPECT_LT(found.places.size(), 20000u);
}

TEST(BlockSearch, CancelledItSaysSo) {
  const std::atomic<bool> cancel{true};
  RunOptions run;
  run.cancel = &cancel;
  const Field field = testing::sphere_field();
  EXPECT_FALSE(search(field, make_lattice(field.bounds(), 0.1), holds_surface, run).complete);
}

}  // namespace
}  // namespace cambium
