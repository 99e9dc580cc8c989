// Which cells are a lone chain's, and that the surface there is the swept volume of the segments that it names.
#include "blobtree/lone_chain.h"

#include "blobtree/skeleton_primitives.h"
#include "blobtree/surface_cover.h"

#include <gtest/gtest.h>

#include <cmath>

namespace cambium {
namespace {

const Chain kTrunk{{{{0, 0, 0}, 0.10}, {{0.02, 0, 1}, 0.08}, {{0, 0.03, 2}, 0.06}}};
const Chain kLimb{{{{0, 0, 1}, 0.06}, {{0.6, 0, 1.5}, 0.04}}};

Field forked() {
  BlobTreeBuilder b;
  const NodeId trunk = b.add(kTrunk), limb = b.add(kLimb);
  b.set_attributes(trunk, {.branch = 7, .order = 2});
  b.set_attributes(limb, {.branch = 8, .order = 3});
  return Field(b.build(b.add(Fork{trunk, {{limb, {0, 0, 1}, {0, 0, 1}, 0.04, 0.3}}})));
}

Field single(const Chain& chain) {
  BlobTreeBuilder b;
  return Field(b.build(b.add(chain)));
}

// The smallest distance over local radius to the segments of a lone chain.
double swept_ratio_of(const LoneChain& lone, const Vec3& p) {
  double smallest = kInfinity;
  for (std::size_t k = 0; k < lone.segment_count(); ++k) {
    const auto [a, b] = lone.segment(k);
    const double length = glm::distance(a.position, b.position);
    const SweptSegment<double> swept{a.position, (b.position - a.position) / length, 0, length, a.radius, (b.radius - a.radius) / length};
    smallest = std::min(smallest, swept_ratio(swept, p));
  }
  return smallest;
}

TEST(LoneChain, IsTheTrunkBelowAForkAndNothingInTheCrotch) {
  const Field field = forked();
  const PrunedField below = field.prune({{-0.2, -0.2, 0.2}, {0.2, 0.2, 0.3}});
  const auto lone = LoneChain::of(below);
  ASSERT_TRUE(lone);
  EXPECT_EQ(lone->branch(), 7u);
  EXPECT_EQ(lone->order(), 2u);
  ASSERT_EQ(lone->nodes().size(), 3u);
  EXPECT_EQ(lone->nodes()[2].radius, 0.06);
  ASSERT_EQ(lone->segment_count(), 1u);
  EXPECT_EQ(lone->segment_number(0), 0u);
  Evaluator evaluator;
  std::vector<Contribution> contributions;
  evaluator.contributions(below, {0.05, 0, 0.25}, contributions);
  ASSERT_EQ(contributions.size(), 1u);
  EXPECT_EQ(contributions[0].primitive, lone->primitive());
  EXPECT_FALSE(LoneChain::of(field.prune({{0.05, -0.05, 1.0}, {0.15, 0.05, 1.1}})));
  EXPECT_FALSE(LoneChain::of(field.prune({{5, 5, 5}, {6, 6, 6}})));
}

TEST(LoneChain, NamesSegmentsByTheirPlaceInTheChain) {
  const Field field = forked();
  const PrunedField top = field.prune({{-0.2, -0.2, 1.7}, {0.2, 0.2, 1.8}});
  const auto upper = LoneChain::of(top);
  ASSERT_TRUE(upper);
  ASSERT_EQ(upper->segment_count(), 1u);
  EXPECT_EQ(upper->segment_number(0), 1u);
  EXPECT_EQ(upper->segment(0)[0].position, kTrunk.nodes[1].position);
  EXPECT_EQ(upper->segment(0)[1].position, kTrunk.nodes[2].position);
}

TEST(LoneChain, IsNoneWhereItsStrengthMovesItsSurface) {
  Chain weak = kTrunk;
  weak.strength = 0.8;
  EXPECT_TRUE(LoneChain::of(single(kTrunk).whole()));
  EXPECT_FALSE(LoneChain::of(single(weak).whole()));
}

TEST(LoneChain, IsNoneUnderAWarp) {
  BlobTreeBuilder b;
  const Field field(b.build(b.add(Twist{{0, 0, 0}, {0, 0, 1}, 1.0, b.add(kTrunk)})));
  EXPECT_FALSE(LoneChain::of(field.whole()));
}

TEST(ActiveChain, AllOfACellAreListedButWarpedOnes) {
  const Field field = forked();
  std::vector<ActiveChain> chains;
  const PrunedField crotch = field.prune({{0.05, -0.05, 1.0}, {0.15, 0.05, 1.1}});
  ActiveChain::append(crotch, chains);
  ASSERT_EQ(chains.size(), 2u);
  EXPECT_EQ(chains[0].branch(), 7u);
  EXPECT_EQ(chains[0].segment_number(0), 0u);
  EXPECT_EQ(chains[1].branch(), 8u);
  EXPECT_EQ(chains[1].nodes().size(), 2u);
  ActiveChain::append(field.prune({{5, 5, 5}, {6, 6, 6}}), chains);
  EXPECT_EQ(chains.size(), 2u);
  BlobTreeBuilder b;
  const Field warped(b.build(b.add(Twist{{0, 0, 0}, {0, 0, 1}, 1.0, b.add(kTrunk)})));
  ActiveChain::append(warped.whole(), chains);
  EXPECT_EQ(chains.size(), 2u);
}

TEST(LoneChain, ItsSegmentsSweepTheSurfaceOfEveryCellItIsIn) {
  const Field field = forked();
  CoverOptions options;
  options.cell = 0.03;
  const auto cover = cover_surface(field, options, {});
  ASSERT_TRUE(cover);
  Evaluator evaluator;
  std::size_t lone_cells = 0;
  for (std::size_t i = 0; i < cover->size(); ++i) {
    const PrunedField cell = cover->field(i);
    const auto lone = LoneChain::of(cell);
    if (!lone) continue;
    ++lone_cells;
    for (int corner = 0; corner < 8; ++corner) {
      const Vec3 t(0.1 + 0.8 * (corner & 1), 0.1 + 0.8 * (corner >> 1 & 1), 0.1 + 0.8 * (corner >> 2 & 1));
      const Vec3 p = glm::mix(cell.box().lo, cell.box().hi, t);
      const double ratio = swept_ratio_of(*lone, p);
      if (std::abs(ratio - 1) > 1e-9) { EXPECT_EQ(evaluator.value(cell, p) >= kIso, ratio < 1); }
    }
  }
  EXPECT_GT(lone_cells, cover->size() / 2);
}

TEST(LoneChain, WhatIsWarpedWeakOrTakenAwayDoesNotOnlyBlend) {
  EXPECT_TRUE(ActiveChain::only_blend(forked().whole()));
  EXPECT_TRUE(ActiveChain::only_blend(single(kTrunk).whole()));
  EXPECT_FALSE(ActiveChain::only_blend(PrunedField{}));
  BlobTreeBuilder knotted;
  const NodeId stem = knotted.add(kTrunk), knot = knotted.add(Sphere{{0.1, 0, 1}, 0.05, 1}), dent = knotted.add(Sphere{{-0.1, 0, 1}, 0.05, -1});
  const Field bumpy(knotted.build(knotted.add(Sum{{stem, knot, dent}})));
  EXPECT_FALSE(ActiveChain::only_blend(bumpy.whole()));
  EXPECT_TRUE(ActiveChain::only_blend(bumpy.prune({{0.1, -0.05, 0.95}, {0.2, 0.05, 1.05}}))) << "the dent is not here";
  BlobTreeBuilder b;
  const NodeId trunk = b.add(kTrunk), limb = b.add(kLimb);
  const Field cut(b.build(b.add(Difference{{trunk, limb}})));
  EXPECT_FALSE(ActiveChain::only_blend(cut.whole()));
  EXPECT_TRUE(ActiveChain::only_blend(cut.prune({{-0.2, -0.2, 0.2}, {0.2, 0.2, 0.3}}))) << "the limb is not here";
  Chain weak = kTrunk;
  weak.strength = 0.5;
  EXPECT_FALSE(ActiveChain::only_blend(single(weak).whole()));
}

TEST(LoneChain, AllOfTheFieldIsJudgedInABoxFromAnyPartOfIt) {
  BlobTreeBuilder b;
  const NodeId trunk = b.add(kTrunk), limb = b.add(kLimb);
  const Field cut(b.build(b.add(Difference{{trunk, limb}})));
  const Box below{{-0.2, -0.2, 0.2}, {0.2, 0.2, 0.3}};
  for (const PrunedField& part : {cut.whole(), cut.prune(below)}) {
    EXPECT_TRUE(ActiveChain::all_blend(part, below)) << "the limb is not here";
    EXPECT_FALSE(ActiveChain::all_blend(part, cut.bounds()));
  }
  const Field fork = forked();
  EXPECT_TRUE(ActiveChain::all_blend(fork.prune(Box{Vec3(0), Vec3(0)}), {Vec3(-kInfinity), Vec3(kInfinity)}));
}

}  // namespace
}  // namespace cambium
