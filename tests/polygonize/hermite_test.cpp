#include "polygonize/hermite.h"

#include "tests/polygonize/octrees.h"
#include "tests/polygonize/sample_fields.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <atomic>
#include <numeric>

namespace cambium {
namespace {

using testing::coarse_octree;
using testing::OnOctree;

std::vector<Crossing> all_crossings(const OnOctree& on, const std::vector<MinimalEdge>& edges) {
  Contour contour;
  contour.edges = edges;
  contour.crossings.resize(edges.size());
  std::vector<std::uint32_t> all(edges.size());
  std::iota(all.begin(), all.end(), 0u);
  EXPECT_TRUE(find_crossings(on.tree, on.cover, all, contour, {}));
  return contour.crossings;
}

/// Whether some point of an edge no more than `reach` from t has the field's iso-value, or nearly so.
bool on_the_surface(const Field& field, const SurfaceOctree& tree, const MinimalEdge& edge, double t, double reach) {
  const auto inside = [&](double s) { return field.value(edge_point(tree, edge, std::clamp(s, 0.0, 1.0))) >= kIso; };
  return std::abs(field.value(edge_point(tree, edge, t)) - kIso) < 2e-4 || inside(t - reach) != inside(t + reach);
}

TEST(Hermite, EdgePointsAreThoseOfTheGrid) {
  OnOctree on = coarse_octree(testing::noise_field(4), 0.2, 3);
  const auto edges = crossed_minimal_edges(on.tree, {}).value().edges;
  ASSERT_GT(edges.size(), 100u);
  for (const MinimalEdge& edge : edges) {
    CellPlace place = testing::low_place(on.tree, edge);
    EXPECT_EQ(edge_point(on.tree, edge, 0), on.tree.point(place));
    place[edge.axis] += 1u << on.tree.leaves()[edge.owner()].level;
    EXPECT_EQ(edge_point(on.tree, edge, 1), on.tree.point(place));
  }
}

TEST(Hermite, CrossingsOfSmoothFieldsAreExactAndTheirNormalsTooOnLeavesThatFit) {
  std::size_t found = 0, less_exact = 0;
  for (const Field& field : {testing::sphere_field(), testing::torus_field(), testing::chain_field()}) {
    OnOctree on = coarse_octree(field, 0.2, 4, {.radii = 0.5});
    const auto edges = crossed_minimal_edges(on.tree, {}).value().edges;
    const auto crossings = all_crossings(on, edges);
    ASSERT_GT(edges.size(), 100u);
    for (std::size_t i = 0; i < edges.size(); ++i) {
      const double t = static_cast<double>(crossings[i].t), edge = on.tree.edge(on.tree.leaves()[edges[i].owner()]);
      const Sample sample = field.sample(edge_point(on.tree, edges[i], t));
      const double slope = glm::length(sample.gradient);
      EXPECT_LT(std::abs(sample.value - kIso), 1e-4 + 1e-3 * edge * slope) << "edge " << i;
      ++found;
      less_exact += std::abs(sample.value - kIso) > 1e-4 + 1e-4 * edge * slope;   // a batch is right to 1e-4
      EXPECT_GT(glm::dot(Vec3(crossings[i].normal), -sample.gradient / slope), 0.9999);
    }
  }
  EXPECT_LT(static_cast<double>(less_exact), 0.01 * static_cast<double>(found));
}

TEST(Hermite, CrossingsOfAnyFieldAreWithinTheirEdgesAndNearlyAllOnTheSurface) {
  std::size_t found = 0, off = 0;
  for (std::uint64_t seed = 1; seed <= 45; ++seed) {
    const Field field = testing::any_field(seed);
    OnOctree on = coarse_octree(field, testing::longest_side(field) / 8, 3, {.radii = 1});
    const auto edges = crossed_minimal_edges(on.tree, {}).value().edges;
    const auto crossings = all_crossings(on, edges);
    for (std::size_t i = 0; i < edges.size(); ++i) {
      const double t = static_cast<double>(crossings[i].t);
      ASSERT_GT(t, 0);
      ASSERT_LT(t, 1);
      const float length = glm::length(crossings[i].normal);
      ASSERT_TRUE(length == 0 || std::abs(length - 1) < 1e-4f);
      ++found;
      off += !on_the_surface(field, on.tree, edges[i], t, 1e-3);
    }
  }
  ASSERT_GT(found, 10000u);
  RecordProperty("found", static_cast<int>(found));
  RecordProperty("off", static_cast<int>(off));
  EXPECT_LT(static_cast<double>(off), 0.02 * static_cast<double>(found));
}

// Also where the field has kinks or falls to nothing within the edge.
TEST(Hermite, NoCrossingIsFartherOffThanItsBound) {
  std::size_t found = 0;
  for (std::uint64_t seed = 1; seed <= 20; ++seed) {
    const Field field = testing::any_field(seed);
    OnOctree on = coarse_octree(field, testing::longest_side(field) / 8, 3, {.radii = 1});
    const auto edges = crossed_minimal_edges(on.tree, {}).value().edges;
    const auto crossings = all_crossings(on, edges);
    for (std::size_t i = 0; i < edges.size(); ++i) {
      const double t = static_cast<double>(crossings[i].t), from_end = std::min(t, 1 - t);
      ++found;
      EXPECT_TRUE(on_the_surface(field, on.tree, edges[i], t, from_end < 1.1e-3 ? 1.1e-3 : 1.1e-4))
          << "seed " << seed << ", edge " << i << ", f " << field.value(edge_point(on.tree, edges[i], t));
    }
  }
  EXPECT_GT(found, 20000u);
}

TEST(Hermite, FindsTheEdgesListedAndLeavesTheOthersAlone) {
  OnOctree on = coarse_octree(testing::noise_field(8), 0.25, 4);
  Contour contour;
  contour.edges = crossed_minimal_edges(on.tree, {}).value().edges;
  contour.crossings.assign(contour.edges.size(), Crossing{-1, glm::vec3(0)});
  std::vector<std::uint32_t> odd;
  for (std::uint32_t i = 1; i < contour.edges.size(); i += 2) odd.push_back(i);
  ASSERT_TRUE(find_crossings(on.tree, on.cover, odd, contour, {}));
  const auto all = all_crossings(on, contour.edges);
  for (std::size_t i = 0; i < all.size(); ++i) EXPECT_NEAR(contour.crossings[i].t, i % 2 ? all[i].t : -1.0f, 2e-3f);
  const std::atomic<bool> cancel{true};
  RunOptions run;
  run.cancel = &cancel;
  EXPECT_FALSE(find_crossings(on.tree, on.cover, odd, contour, run));
}

}  // namespace
}  // namespace cambium
