#include "raytrace/chain_segments.h"

#include "tests/blobtree/random_blobtrees.h"
#include "tests/raytrace/scenes.h"

#include <gtest/gtest.h>

namespace cambium {
namespace {

/// Of a chain of three pieces, the middle one a metre long and 4 cm thick, sawn off in the last one.
Field sawn_at_the_end() {
  BlobTreeBuilder builder;
  const NodeId log = scenes::add_chain(builder, {{{0, 0, 0}, 0.05}, {{0.2, 0, 0}, 0.04}, {{1.2, 0, 0}, 0.02}, {{2, 0, 0}, 0.02}});
  const NodeId beyond = builder.add(HalfSpace{{1.6, 0, 0}, {-1, 0, 0}, 0.01});
  return Field(builder.build(builder.add(Difference{{log, beyond}})));
}

ChainSegments segments_of(const SurfaceCover& cover) {
  ChainSegments segments;
  for (std::uint32_t cell = 0; cell < cover.size(); ++cell) {
    const PrunedField field = cover.field(cell);
    for (const ActiveChain& chain : ActiveChain::blended(field)) {
      const std::uint32_t first = segments.add(chain);
      for (std::size_t k = 0; k < chain.segment_count(); ++k) segments.note_cell(first + chain.segment_number(k), cell);
    }
  }
  segments.find_wood(cover);
  return segments;
}

TEST(ChainSegments, AreWoodAllAlongAForkedTree) {
  const Field field = scenes::forked();
  const SurfaceCover cover = *cover_surface(field, {}, {});
  const ChainSegments segments = segments_of(cover);
  ASSERT_EQ(segments.size(), 2u);
  EXPECT_TRUE(segments[0].is_wood);
  EXPECT_TRUE(segments[1].is_wood);
}

TEST(ChainSegments, AreNoWoodWhereASawMayTakeSomethingAway) {
  const Field field = sawn_at_the_end();
  const SurfaceCover cover = *cover_surface(field, {}, {});
  const ChainSegments segments = segments_of(cover);
  ASSERT_EQ(segments.size(), 3u);
  EXPECT_TRUE(segments[0].is_wood);
  EXPECT_TRUE(segments[1].is_wood);
  EXPECT_FALSE(segments[2].is_wood);
}

TEST(ChainSegments, HaveBoxesThatHoldAllOfTheWoodAndNoneLong) {
  const Field field = sawn_at_the_end();
  const SurfaceCover cover = *cover_surface(field, {}, {});
  const ChainSegments segments = segments_of(cover);
  const auto pieces = segments.wood_pieces();
  std::vector<Box> boxes;
  for (const auto& piece : pieces) {
    boxes.push_back(segments.box(piece));
    EXPECT_LT(boxes.back().size().x, 8.1 * segments[piece.segment].thickest);
    EXPECT_NE(piece.segment, 2u);
  }
  Draws draws(3);
  int inside = 0;
  for (int i = 0; i < 20000; ++i) {
    const Vec3 p = draws.point({Vec3(-0.06), Vec3(1.23, 0.06, 0.06)});
    bool in_wood = false, in_box = false;
    for (std::uint32_t k = 0; k < 2; ++k) in_wood |= swept_ratio(segments[k].swept, p) <= 1;
    for (const Box& box : boxes) in_box |= box.contains(p);
    inside += in_wood;
    if (in_wood) {
      EXPECT_TRUE(in_box) << i;
    }
  }
  EXPECT_GT(inside, 1000);
}

TEST(ChainSegments, AreMetAsTheirSolidIsFromWhereverTheRayBegins) {
  const Field field = scenes::trunk();
  const SurfaceCover cover = *cover_surface(field, {}, {});
  const ChainSegments segments = segments_of(cover);
  Draws draws(5);
  int met = 0;
  for (int i = 0; i < 20000; ++i) {
    const Ray ray{draws.point({Vec3(-1), Vec3(1, 1, 3)}), draws.direction()};
    for (std::uint32_t k = 0; k < segments.size(); ++k) {
      const auto t = segments.meet(k, ray, {0, 10});
      const auto expected = first_inside(segments[k].swept, ray, {0, 10});
      ASSERT_EQ(t.has_value(), expected.has_value()) << i;
      if (!t) continue;
      ++met;
      EXPECT_NEAR(*t, *expected, 1e-12) << i;
      EXPECT_LE(swept_ratio(segments[k].swept, ray.at(*t)), 1 + 1e-12) << i;
    }
  }
  EXPECT_GT(met, 500);
}

}  // namespace
}  // namespace cambium
