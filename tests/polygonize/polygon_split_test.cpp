#include "polygonize/polygon_split.h"

#include "tests/polygonize/octrees.h"
#include "tests/polygonize/sample_fields.h"

#include <gtest/gtest.h>

namespace cambium {
namespace {

using testing::coarse_octree;
using testing::OnOctree;

TEST(PolygonSplit, TakesADiagonalThatFitsIfAnyDoesAndTheFanOnlyIfNot) {
  std::array<std::size_t, 3> taken{};
  for (std::uint64_t seed = 1; seed <= 12; ++seed) {
    const Field field = testing::any_field(seed);
    OnOctree on = coarse_octree(field, testing::longest_side(field) / 6, 3, {.radii = 2.0});
    const Contour contour = testing::contour_on(on);
    const std::vector<Vec3> positions = testing::positions_of(contour);
    for (std::uint32_t e = 0; e < contour.edges.size(); ++e) {
      const Ring ring = ring_of(contour.edges[e], contour.patch_of_quadrant[e]);
      const auto fits = fitting_splits(on.tree, contour, e, ring, positions);
      const Split split = split_of(on.tree, contour, e, ring, positions, 1e-3);
      ++taken[static_cast<std::size_t>(split)];
      if (split == Split::kFan) {
        EXPECT_FALSE(fits[0] || fits[1]);
      } else {
        EXPECT_TRUE(fits[static_cast<std::size_t>(split)]);
      }
      if (ring.count == 3) {
        EXPECT_NE(split, Split::kSecond);
      }
    }
  }
  for (const std::size_t n : taken) EXPECT_GT(n, 100u);
}

TEST(PolygonSplit, OfTwoDiagonalsThatFitTheOneThatIsOffGivesWay) {
  OnOctree on = coarse_octree(testing::torus_field(), 0.15, 1);
  const Contour contour = testing::contour_on(on);
  const std::vector<Vec3> positions = testing::positions_of(contour);
  std::size_t decided = 0, turned = 0;
  for (std::uint32_t e = 0; e < contour.edges.size(); ++e) {
    const Ring ring = ring_of(contour.edges[e], contour.patch_of_quadrant[e]);
    if (ring.count != 4) continue;
    const auto fits = fitting_splits(on.tree, contour, e, ring, positions);
    if (!fits[0] || !fits[1]) continue;
    const PolygonFit fit = polygon_fit(ring, positions, crossing_point(on.tree, contour, e), contour.edges[e].axis);
    if (!(std::abs(fit.error[0] - fit.error[1]) > 1e-6)) continue;
    const int nearer = fit.error[1] < fit.error[0];
    ++decided;
    const Split split = split_of(on.tree, contour, e, ring, positions, 1e-9);
    EXPECT_EQ(static_cast<int>(split), nearer);
    turned += split_of(on.tree, contour, e, ring, positions, kInfinity) != split;
  }
  EXPECT_GT(decided, 200u);
  EXPECT_GT(turned, 20u) << "that shape alone would have taken the other way";
}

}  // namespace
}  // namespace cambium
