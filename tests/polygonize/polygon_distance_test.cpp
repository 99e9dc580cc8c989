#include "polygonize/polygon_distance.h"

#include "tests/polygonize/crease_curves.h"
#include "tests/polygonize/octrees.h"
#include "tests/polygonize/sample_fields.h"

#include <gtest/gtest.h>

#include <atomic>

namespace cambium {
namespace {

using testing::coarse_octree;
using testing::OnOctree;

/// The farthest of some points by the whole field, to first order.
double farthest(const Field& field, const std::vector<Vec3>& points) {
  double most = 0;
  for (const Vec3& p : points) {
    const Sample s = field.sample(p);
    most = std::max(most, std::abs(s.value - kIso) / glm::length(s.gradient));
  }
  return most;
}

TEST(PolygonDistance, IsThatOfTheFarthestCentroidOrMiddleOfASideWhicheverCellItIsIn) {
  for (const Field& field : {testing::sphere_field(), testing::fork_field(), testing::cut_sphere().field}) {
    OnOctree on = coarse_octree(field, 0.15, 1);
    const Contour contour = testing::contour_on(on);
    const std::vector<Vec3> positions = testing::positions_of(contour);
    std::vector<SplitPolygon> polygons;
    for (std::uint32_t e = 0; e < contour.edges.size(); ++e)
      for (const Split split : {Split::kFirst, Split::kSecond, Split::kFan}) polygons.push_back({e, split});
    std::vector<float> distances;
    ASSERT_TRUE(measure_polygons(on.tree, on.cover, contour, positions, polygons, distances, {}));
    std::size_t quads = 0, sides = 0;
    for (std::size_t i = 0; i < polygons.size(); ++i) {
      const auto [edge, split] = polygons[i];
      const Ring ring = ring_of(contour.edges[edge], contour.patch_of_quadrant[edge]);
      std::vector<Vec3> p, points;
      for (int k = 0; k < ring.count; ++k) p.push_back(positions[ring.patches[k]]);
      const std::size_t n = p.size();
      for (std::size_t k = 0; k < n; ++k) {
        const PatchVertex &a = contour.vertices[ring.patches[k]], &b = contour.vertices[ring.patches[(k + 1) % n]];
        if (chord_known(a, b)) continue;
        points.push_back((p[k] + p[(k + 1) % n]) / 2.0);
        ++sides;
      }
      if (split == Split::kFan) {
        const Vec3 x = crossing_point(on.tree, contour, edge);
        for (std::size_t k = 0; k < n; ++k) {
          points.push_back((x + p[k]) / 2.0);
          points.push_back((x + p[k] + p[(k + 1) % n]) / 3.0);
        }
      } else if (n == 4) {
        ++quads;
        const std::size_t k = split == Split::kSecond;
        points.push_back((p[k] + p[k + 2]) / 2.0);
        points.push_back((p[k] + p[k + 1] + p[k + 2]) / 3.0);
        points.push_back((p[k] + p[k + 2] + p[(k + 3) % 4]) / 3.0);
      } else if (split == Split::kFirst) {
        points.push_back((p[0] + p[1] + p[2]) / 3.0);
      } else {
        continue;
      }
      EXPECT_NEAR(static_cast<double>(distances[i]), farthest(field, points), 1e-4) << "edge " << edge;
    }
    EXPECT_GT(quads, 100u);
    if (contour.exits.empty()) {
      EXPECT_EQ(sides, 0u);
    } else {
      EXPECT_GT(sides, 50u);
    }
  }
}

TEST(PolygonDistance, NothingIsMeasuredOnceCancelled) {
  OnOctree on = coarse_octree(testing::sphere_field(), 0.2, 0);
  const Contour contour = testing::contour_on(on);
  const std::atomic<bool> cancel{true};
  RunOptions run;
  run.cancel = &cancel;
  std::vector<float> distances;
  EXPECT_FALSE(measure_polygons(on.tree, on.cover, contour, testing::positions_of(contour), {{0, Split::kFan}}, distances, run));
}

}  // namespace
}  // namespace cambium
