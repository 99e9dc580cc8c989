#include "polygonize/calm_sheet.h"

#include "polygonize/crowded_leaves.h"
#include "polygonize/verify.h"
#include "tests/polygonize/crease_curves.h"
#include "tests/polygonize/mesh_checks.h"
#include "tests/polygonize/octrees.h"

#include <gtest/gtest.h>

#include <algorithm>

namespace cambium {
namespace {

/// A calm sheet, and all that it looks at.
struct Sheet {
  testing::OnOctree on;
  Contour contour;
  std::vector<Vec3> positions;
  std::vector<std::optional<Split>> splits;
  std::vector<bool> crowded;
  CalmSheet calm;

  explicit Sheet(testing::OnOctree octree)
      : on(std::move(octree)), contour(testing::contour_on(on)), positions(testing::positions_of(contour)),
        splits(testing::splits_of(contour)), crowded(crowded_patches(contour)), calm(on.tree, contour, positions, splits, crowded) {}
};

testing::OnOctree cut_at_random(const Field& field, double cell, std::uint64_t seed) {
  Draws draws(seed);
  testing::OnOctree on = testing::coarse_octree(field, cell, 3);
  testing::contour_on(on);
  testing::split_at_random(on, draws, 0.1);
  return on;
}

Field spheres(const std::vector<Vec3>& centers) {
  BlobTreeBuilder builder;
  std::vector<NodeId> all;
  for (const Vec3& center : centers) all.push_back(builder.add(Sphere{center, 1.0}));
  return Field(builder.build(builder.add(Union{std::move(all)})));
}

TEST(CalmSheet, IsAllOfASphereWhoseMeshThenNeedsNoVerticesButThoseOfItsLeaves) {
  std::size_t unfit = 0;
  for (std::uint64_t seed = 1; seed <= 8; ++seed) {
    SCOPED_TRACE(seed);
    const Sheet sheet(cut_at_random(spheres({Vec3(0.013, 0.021, 0.008)}), 0.15, seed));
    for (std::uint32_t e = 0; e < sheet.contour.edges.size(); ++e) {
      EXPECT_TRUE(sheet.calm.split(e).has_value());
      const Ring ring = ring_of(sheet.contour.edges[e], sheet.contour.patch_of_quadrant[e]);
      const auto fits = fitting_splits(sheet.on.tree, sheet.contour, e, ring, sheet.positions);
      unfit += !fits[0] && !fits[1];
    }
    const DualMesh made = testing::polygons_on(sheet.on, sheet.contour);
    EXPECT_EQ(made.face_vertices, 0u);
    EXPECT_EQ(made.edge_vertices, 0u);
    const testing::MeshChecks checks = testing::check_mesh(made.mesh);
    EXPECT_TRUE(checks.closed_manifold()) << checks;
    EXPECT_TRUE(self_intersections(made.mesh, {}).value().empty());
  }
  EXPECT_GT(unfit, 20u) << "the case this is for";
}

TEST(CalmSheet, ReachesIntoLeavesOfTwoSheetsThatAPlaneParts) {
  const Vec3 apart = 2.07 * glm::normalize(Vec3(1, 0.35, 0.2));
  std::size_t calm_crowded = 0;
  for (std::uint64_t seed = 1; seed <= 8; ++seed) {
    SCOPED_TRACE(seed);
    const Sheet sheet(cut_at_random(spheres({Vec3(0.0), apart}), 0.1, seed));
    for (std::uint32_t e = 0; e < sheet.contour.edges.size(); ++e) {
      const auto& around = sheet.contour.patch_of_quadrant[e];
      calm_crowded += sheet.calm.split(e) && std::any_of(around.begin(), around.end(), [&](std::uint32_t p) { return sheet.crowded[p]; });
    }
    EXPECT_TRUE(self_intersections(testing::polygons_on(sheet.on, sheet.contour).mesh, {}).value().empty());
  }
  EXPECT_GT(calm_crowded, 20u);
}

TEST(CalmSheet, EndsBesideCreases) {
  for (const testing::CreasedSolid& solid : testing::creased_solids()) {
    SCOPED_TRACE(solid.name);
    const Sheet sheet(testing::coarse_octree(solid.field, 0.11, 3));
    std::size_t on_creases = 0;
    for (std::uint32_t e = 0; e < sheet.contour.edges.size(); ++e) {
      const auto& around = sheet.contour.patch_of_quadrant[e];
      if (std::none_of(around.begin(), around.end(), [&](std::uint32_t p) { return sheet.contour.vertices[p].crease; })) continue;
      ++on_creases;
      EXPECT_FALSE(sheet.calm.split(e).has_value());
    }
    EXPECT_GT(on_creases, 20u);
  }
}

TEST(CalmSheet, CutsAPolygonAsWasMeasuredOrNotAtAll) {
  Sheet sheet(cut_at_random(spheres({Vec3(0.013, 0.021, 0.008)}), 0.15, 3));
  for (const Split wanted : {Split::kFirst, Split::kSecond, Split::kFan}) {
    std::fill(sheet.splits.begin(), sheet.splits.end(), wanted);
    const CalmSheet calm(sheet.on.tree, sheet.contour, sheet.positions, sheet.splits, sheet.crowded);
    std::size_t cut = 0;
    for (std::uint32_t e = 0; e < sheet.contour.edges.size(); ++e) {
      const auto split = calm.split(e);
      cut += split.has_value();
      EXPECT_EQ(split.value_or(wanted), wanted);
    }
    EXPECT_EQ(cut > 0, wanted != Split::kFan);
  }
}

TEST(CalmSheet, AChordKeepsAmongLeavesThatTouchAlongItAndNotAcrossOthers) {
  const Sheet sheet(testing::coarse_octree(spheres({Vec3(0.013, 0.021, 0.008)}), 0.15, 3));
  const Contour& contour = sheet.contour;
  std::size_t near = 0, far = 0;
  for (std::uint32_t e = 0; e < contour.edges.size(); ++e) {
    const std::uint32_t p = contour.patch_of_quadrant[e][kRing[0]], r = contour.patch_of_quadrant[e][kRing[1]];
    near += sheet.calm.keeps_among({e, e}, {p, r});
    const std::uint32_t other = (e + static_cast<std::uint32_t>(contour.edges.size()) / 2) % static_cast<std::uint32_t>(contour.edges.size());
    const std::uint32_t away = contour.patch_of_quadrant[other][0];
    if (glm::distance(sheet.positions[p], sheet.positions[away]) < 0.8) continue;
    ++far;
    EXPECT_FALSE(sheet.calm.keeps_among({e, other}, {p, away}));
  }
  EXPECT_GT(near, contour.edges.size() / 2);
  EXPECT_GT(far, 20u);
}

}  // namespace
}  // namespace cambium
