#include "skeletons/graph/settled_cells.h"

#include "tests/blobtree/random_blobtrees.h"

#include <gtest/gtest.h>

namespace cambium {
namespace {

using Kind = SettledCells::Kind;

/// A ball of radius 1 whose surface is in small boxes.
SettledCells cells_of_ball(const Vec3& scale, std::size_t wanted, int* asked = nullptr) {
  std::vector<Box> pieces;
  Draws draws(1);
  for (int i = 0; i < 30000; ++i) {
    const Vec3 p = scale * draws.direction();
    pieces.push_back(Box{p, p}.padded(0.02));
  }
  Box bounds{-scale, scale};
  return SettledCells(bounds.padded(0.03), wanted, pieces.size(), [&](std::size_t i) { return pieces[i]; },
                      [&, asked](const Vec3& p) {
                        if (asked) ++*asked;
                        return glm::length(p / scale) < 1;
                      });
}

TEST(SettledCells, KnowMostPlacesAndNoneOfThemWrong) {
  int asked = 0;
  const SettledCells cells = cells_of_ball(Vec3(1), 30000, &asked);
  EXPECT_LT(asked, 4000) << "once for each row between two pieces";
  Draws draws(2);
  int known = 0;
  for (int i = 0; i < 20000; ++i) {
    const Vec3 p = draws.point({Vec3(-1.2), Vec3(1.2)});
    const Kind kind = cells.at(p);
    known += kind != Kind::kUnknown;
    EXPECT_NE(kind, glm::length(p) < 1 ? Kind::kOutside : Kind::kInside);
  }
  EXPECT_GT(known, 15000);
}

TEST(SettledCells, ThinAndFlatBoundsAreNotDividedBeyondMeasure) {
  for (const Vec3& scale : {Vec3(1, 1, 1e-7), Vec3(1e6, 1e-3, 1e-3), Vec3(1, 1e-9, 1e3)}) {
    int asked = 0;
    const SettledCells cells = SettledCells({-scale, scale}, 1000, 0, [](std::size_t) { return Box{}; },
                                            [&](const Vec3&) { return ++asked > 0; });
    EXPECT_LE(asked, 8000);
    EXPECT_EQ(cells.at(Vec3(0)), Kind::kInside);
    EXPECT_EQ(cells.at(2.0 * scale), Kind::kOutside);
  }
  const SettledCells flat({Vec3(0), Vec3(1, 1, 0)}, 100, 0, [](std::size_t) { return Box{}; }, [](const Vec3& p) { return p.x < 0.5; });
  EXPECT_EQ(flat.at({0.2, 1, 0}), Kind::kInside) << "a row without pieces is of its first cell's kind";
}

TEST(SettledCells, OfNothingKnowThatItIsOutside) { EXPECT_EQ(SettledCells().at(Vec3(0)), Kind::kOutside); }

}  // namespace
}  // namespace cambium
