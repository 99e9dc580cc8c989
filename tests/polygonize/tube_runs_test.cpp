// Which stretches of chains become tubes.
#include "polygonize/tube_runs.h"

#include <gtest/gtest.h>

#include <cmath>

namespace cambium {
namespace {

constexpr double kTolerance = 0.0005;

struct Model {
  Field field;
  SurfaceCover cover;
  LeafRule leaves;
  TubeRuns runs;

  explicit Model(const BlobTree& tree, double min_sides = 6) : field(tree) {
    leaves.radii = 1.1;
    leaves.sagitta = 8 * kTolerance;
    CoverOptions options;
    options.cell_radii = 3.2;
    options.sagitta = 64 * leaves.sagitta;
    cover = *cover_surface(field, options, {});
    runs = *TubeRuns::find(cover, leaves, {kTolerance, min_sides}, {});
  }
};

BlobTree single(const Chain& chain) {
  BlobTreeBuilder b;
  return b.build(b.add(chain));
}

BlobTree twig_with_two_shoots() {
  BlobTreeBuilder b;
  const NodeId twig = b.add(Chain{{{{0, 0, 0}, 0.003}, {{0, 0, 0.15}, 0.003}, {{0, 0, 0.3}, 0.003}}});
  const Vec3 up = glm::normalize(Vec3(1, 0, 1));
  std::vector<Lateral> shoots;
  for (const double z : {0.08, 0.22}) {
    const NodeId shoot = b.add(Chain{{{Vec3(0, 0, z), 0.002}, {Vec3(0, 0, z) + 0.1 * up, 0.002}}});
    shoots.push_back({shoot, {0, 0, z}, {0, 0, 1}, 0.002, 0.01});
  }
  return b.build(b.add(Fork{twig, shoots, 0.5, 1}));
}

TEST(TubeRuns, BetweenForksAndEndsThereIsOneEach) {
  const Model model(twig_with_two_shoots());
  ASSERT_EQ(model.runs.size(), 5u);   // three of the twig, one of each shoot
  for (std::size_t i = 0; i < model.runs.size(); ++i) {
    const TubeRun& run = model.runs[i];
    EXPECT_LT(run.stretch.begin, run.rings.front().at);
    EXPECT_GT(run.stretch.end, run.rings.back().at);
    const ChainPath& path = model.runs.path(run);
    for (double s = run.stretch.begin; s < run.stretch.end; s += 0.0005)
      for (int k = 0; k < 6; ++k) {
        const Vec3 side = glm::cross(path.tangent(s), Vec3(std::cos(k), std::sin(k), 0.3));
        const auto cell = model.cover.find(path.surface(s, glm::normalize(side)).position);
        ASSERT_TRUE(cell);
        EXPECT_TRUE(LoneChain::of(model.cover.cube_field(*cell)));
      }
  }
}

TEST(TubeRuns, CellsKnowWhatBelongsToThem) {
  const Model model(single(Chain{{{{0, 0, 0}, 0.003}, {{0.01, 0, 0.2}, 0.003}}}));
  ASSERT_EQ(model.runs.size(), 1u);
  const Stretch stretch = model.runs[0].stretch;
  std::size_t whole = 0;
  for (std::size_t i = 0; i < model.cover.size(); ++i) {
    const TubeRuns::InCell tubes = model.runs.in(model.cover.cube_field(i));
    if (tubes.none()) continue;
    const Box cube = model.cover.cube(i);
    const TubeRuns::Share share = tubes.share(cube);
    whole += share == TubeRuns::Share::kAll;
    const double z = cube.center().z;
    const ChainPath& path = model.runs.path(model.runs[0]);
    if (share == TubeRuns::Share::kAll && path.reaching(cube, 0, 0)) {
      EXPECT_GT(z, stretch.begin - 0.01);
      EXPECT_LT(z, stretch.end + 0.01);
    }
    const double place = tubes.place(cube.center());
    EXPECT_EQ(tubes.holds(cube.center()), stretch.begin < place && place < stretch.end);
  }
  EXPECT_GT(whole, model.cover.size() / 3);
}

TEST(TubeRuns, EndsAreFoundByPlace) {
  const Model model(single(Chain{{{{0, 0, 0}, 0.003}, {{0, 0, 0.2}, 0.003}}}));
  ASSERT_EQ(model.runs.size(), 1u);
  const auto end_at = [&](const Vec3& p) { return model.runs.nearest_end(model.cover.cube_field(*model.cover.find(p)), p).value().end; };
  EXPECT_EQ(end_at({0.003, 0, 0.006}), 0);
  EXPECT_EQ(end_at({0.003, 0, 0.194}), 1);
}

TEST(TubeRuns, WhatIsShortHasNone) {
  EXPECT_EQ(Model(single(Chain{{{{0, 0, 0}, 0.003}, {{0, 0, 0.009}, 0.003}}})).runs.size(), 0u);
  EXPECT_EQ(Model(single(Chain{{{{0, 0, 0}, 0.003}, {{0, 0, 0.2}, 0.003}}, 0.8})).runs.size(), 0u);   // its surface is elsewhere
}

TEST(TubeRuns, InsideOfSomethingThickerThereIsNone) {
  BlobTreeBuilder b;
  const NodeId trunk = b.add(Chain{{{{0, 0, -1}, 0.2}, {{0, 0, 1}, 0.2}}});
  const NodeId core = b.add(Chain{{{{0, 0, -0.5}, 0.003}, {{0, 0, 0.5}, 0.003}}});
  const Model model(b.build(b.add(Union{{trunk, core}})));
  for (std::size_t i = 0; i < model.runs.size(); ++i) EXPECT_GT(model.runs.path(model.runs[i]).radius(0), 0.1);
}

TEST(TubeRuns, AChainThatComesBackBesideItselfIsLeftAloneThere) {
  Chain hairpin;
  for (int i = 0; i <= 20; ++i) hairpin.nodes.push_back({{0, 0, 0.02 * i}, 0.003});
  for (int i = 1; i <= 10; ++i) {
    const double angle = 0.31415926 * i;
    hairpin.nodes.push_back({{0.02 - 0.02 * std::cos(angle), 0, 0.4 + 0.02 * std::sin(angle)}, 0.003});
  }
  for (int i = 1; i <= 10; ++i) hairpin.nodes.push_back({{0.04 - 0.0032 * i, 0, 0.4 - 0.02 * i}, 0.003});   // to 8 mm from the first part
  const Model model(single(hairpin));
  ASSERT_GE(model.runs.size(), 2u);
  for (std::size_t i = 0; i < model.runs.size(); ++i) {
    const Stretch& stretch = model.runs[i].stretch;
    EXPECT_FALSE(stretch.begin < 0.205 && stretch.end > 0.205);   // beside the tip
  }
}

TEST(TubeRuns, ThoseRemovedAreGone) {
  Model model(twig_with_two_shoots());
  const Stretch second = model.runs[1].stretch, last = model.runs[4].stretch;
  model.runs.remove({0, 2, 3});
  ASSERT_EQ(model.runs.size(), 2u);
  EXPECT_EQ(model.runs[0].stretch.begin, second.begin);
  EXPECT_EQ(model.runs[1].stretch.begin, last.begin);
  const Vec3 p(0.003, 0, 0.05);   // of the first
  EXPECT_FALSE(model.runs.in(model.cover.cube_field(*model.cover.find(p))).holds(p));
}

}  // namespace
}  // namespace cambium
