#include "polygonize/crossing_guard.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <atomic>

namespace cambium {
namespace {

using Corners = CrossingGuard::Corners;

/// Two square sheets of n x n cells of 1, facing each other across a gap: the lower one faces up, the other down.
struct Sheets {
  explicit Sheets(double gap, std::uint32_t cells = 8) : n(cells) {
    for (const double z : {0.0, gap})
      for (std::uint32_t y = 0; y <= n; ++y)
        for (std::uint32_t x = 0; x <= n; ++x) positions.push_back({x, y, z});
    for (std::uint32_t sheet = 0; sheet < 2; ++sheet)
      for (std::uint32_t y = 0; y < n; ++y)
        for (std::uint32_t x = 0; x < n; ++x) {
          const std::uint32_t a = at(x, y, sheet), b = a + 1, c = b + n + 1, d = a + n + 1;
          if (sheet == 0) triangles.insert(triangles.end(), {{a, b, c}, {a, c, d}});
          else triangles.insert(triangles.end(), {{a, c, b}, {a, d, c}});
        }
  }
  std::uint32_t at(std::uint32_t x, std::uint32_t y, std::uint32_t sheet) const { return sheet * (n + 1) * (n + 1) + y * (n + 1) + x; }
  std::vector<std::uint32_t> star(std::uint32_t v) const {
    std::vector<std::uint32_t> star;
    for (std::uint32_t t = 0; t < triangles.size(); ++t)
      for (const std::uint32_t c : triangles[t])
        if (c == v) star.push_back(t);
    return star;
  }
  /// What is left of the star of v when it moves onto `to`.
  std::vector<Corners> fan(std::uint32_t v, std::uint32_t to) const {
    std::vector<Corners> fan;
    for (const std::uint32_t t : star(v)) {
      Corners c = triangles[t];
      if (std::find(c.begin(), c.end(), to) != c.end()) continue;
      std::replace(c.begin(), c.end(), v, to);
      fan.push_back(c);
    }
    return fan;
  }

  std::uint32_t n;
  std::vector<Vec3> positions;
  std::vector<Corners> triangles;
};

TEST(CrossingGuard, FlatSheetsMayBeThinnedOut) {
  const Sheets sheets(0.1);
  CrossingGuard guard(sheets.positions, sheets.triangles, {});
  const std::uint32_t v = sheets.at(4, 4, 0), to = sheets.at(5, 4, 0);
  EXPECT_FALSE(guard.crosses(sheets.star(v), sheets.fan(v, to)));
}

/// A bump in the lower sheet, as high as the gap nearly, under a dent of the upper one.
Sheets bumpy(std::uint32_t cells = 8) {
  Sheets sheets(0.5, cells);
  sheets.positions[sheets.at(4, 4, 0)].z = 0.9;   // through the upper sheet's plane
  sheets.positions[sheets.at(4, 4, 1)].z = 1.4;   // which makes way for it
  return sheets;
}

TEST(CrossingGuard, ASheetMayNotBeFlattenedThroughAnother) {
  const Sheets sheets = bumpy();
  CrossingGuard guard(sheets.positions, sheets.triangles, {});
  const std::uint32_t upper = sheets.at(4, 4, 1), lower = sheets.at(4, 4, 0);
  EXPECT_TRUE(guard.crosses(sheets.star(upper), sheets.fan(upper, sheets.at(5, 4, 1))));
  EXPECT_FALSE(guard.crosses(sheets.star(lower), sheets.fan(lower, sheets.at(5, 4, 0))));
}

TEST(CrossingGuard, KnowsWhatHasChangedAndGone) {
  const Sheets sheets = bumpy();
  CrossingGuard guard(sheets.positions, sheets.triangles, {});
  const std::uint32_t lower = sheets.at(4, 4, 0), upper = sheets.at(4, 4, 1);
  // The bump goes first; then the sheet above may be flattened too.
  const auto fan = sheets.fan(lower, sheets.at(5, 4, 0));
  std::size_t next = 0;
  for (const std::uint32_t t : sheets.star(lower)) {
    const Corners& c = sheets.triangles[t];
    if (std::find(c.begin(), c.end(), sheets.at(5, 4, 0)) != c.end()) guard.remove(t);
    else guard.change(t, fan[next++]);
  }
  EXPECT_FALSE(guard.crosses(sheets.star(upper), sheets.fan(upper, sheets.at(5, 4, 1))));
}

TEST(CrossingGuard, GrowingTrianglesAreFoundWhereTheyGrowTo) {
  Sheets sheets = bumpy();
  const auto below = static_cast<std::uint32_t>(sheets.positions.size());
  sheets.positions.push_back({4.2, 4.1, -1});
  CrossingGuard guard(sheets.positions, sheets.triangles, {});
  const std::uint32_t lower = sheets.at(4, 4, 0);
  const auto star = sheets.star(lower);
  const auto fan = sheets.fan(lower, sheets.at(5, 4, 0));
  ASSERT_FALSE(guard.crosses(star, fan));
  guard.change(0, {below, sheets.at(3, 5, 1), sheets.at(5, 5, 1)});   // that of a far corner comes to stand across the place
  EXPECT_TRUE(guard.crosses(star, fan));
}

// Half of it gone, the tree is built anew: the answers stay.
TEST(CrossingGuard, RemembersAllWhenItsTreeIsBuiltAnew) {
  const Sheets sheets = bumpy(24);
  CrossingGuard guard(sheets.positions, sheets.triangles, {});
  const std::uint32_t upper = sheets.at(4, 4, 1);
  for (std::uint32_t t = 0; t < sheets.triangles.size(); ++t) {
    Vec3 middle(0.0);
    for (const std::uint32_t c : sheets.triangles[t]) middle += sheets.positions[c] / 3.0;
    if (middle.x > 8 || middle.y > 8) guard.remove(t);
  }
  EXPECT_TRUE(guard.crosses(sheets.star(upper), sheets.fan(upper, sheets.at(5, 4, 1))));
  EXPECT_FALSE(guard.crosses(sheets.star(sheets.at(2, 2, 1)), sheets.fan(sheets.at(2, 2, 1), sheets.at(3, 2, 1))));
}

TEST(CrossingGuard, MayBeEmptyAndItsBuildingMayBeCancelled) {
  const std::vector<Vec3> none;
  CrossingGuard guard(none, {}, {});
  EXPECT_FALSE(guard.crosses({}, {}));
  std::atomic<bool> cancel{true};
  RunOptions run;
  run.cancel = &cancel;
  const Sheets sheets(1, 200);
  CrossingGuard cancelled(sheets.positions, sheets.triangles, run);   // returns
}

}  // namespace
}  // namespace cambium
