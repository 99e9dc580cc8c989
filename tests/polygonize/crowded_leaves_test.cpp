#include "polygonize/crowded_leaves.h"

#include "tests/polygonize/octrees.h"

#include <gtest/gtest.h>

namespace cambium {
namespace {

TEST(CrowdedLeaves, TheirVerticesAreStrictlyInsideThemEvenWhereAllCrossingsAreOnOneFace) {
  std::size_t crowded = 0, flat = 0;
  for (std::uint64_t seed = 1; seed <= 120; ++seed) {
    SCOPED_TRACE(seed);
    const Field field = testing::any_field(seed);
    Draws draws(seed);
    testing::OnOctree on = testing::coarse_octree(field, testing::longest_side(field) / 6, 3);
    testing::contour_on(on);
    testing::split_at_random(on, draws, 0.1);
    const Contour contour = testing::contour_on(on);
    const std::vector<bool> shares = crowded_patches(contour);
    for (std::uint32_t p = 0; p < shares.size(); ++p) {
      if (!shares[p]) continue;
      ++crowded;
      const Box box = on.tree.box(on.tree.leaves()[contour.patches[p].leaf]);
      Box crossings;
      for (const std::uint32_t e : contour.ring(p)) crossings.extend(crossing_point(on.tree, contour, e));
      const Vec3 at = crowded_position(on.tree, contour, p);
      for (int a = 0; a < 3; ++a) {
        ASSERT_GT(at[a], box.lo[a]);
        ASSERT_LT(at[a], box.hi[a]);
        flat += crossings.lo[a] == crossings.hi[a] && (crossings.lo[a] == box.lo[a] || crossings.lo[a] == box.hi[a]);
      }
    }
  }
  EXPECT_GT(crowded, 500u);
  EXPECT_GT(flat, 0u) << "the case this is for";
}

}  // namespace
}  // namespace cambium
