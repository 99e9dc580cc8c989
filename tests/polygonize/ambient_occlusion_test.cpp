#include "polygonize/ambient_occlusion.h"

#include "blobtree/input_error.h"
#include "polygonize/vertex_clusters.h"
#include "sample_fields.h"
#include "small_tree.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <atomic>
#include <cmath>
#include <numeric>
#include <stdexcept>

namespace cambium {
namespace {

using namespace testing;

TEST(AmbientOcclusion, NothingIsInTheWayOfAConvexShape) {
  const Mesh mesh = small_tree_mesh(sphere_field(), 0.08);
  const auto open = ambient_occlusion(mesh, {}, {});
  ASSERT_TRUE(open);
  for (const float share : *open) EXPECT_GT(share, 0.98f);
}

/// A horizontal plate with another above it.
Mesh plates(double gap) {
  Mesh mesh;
  const int n = 20;
  for (const double z : {0.0, gap})
    for (int y = 0; y <= n; ++y)
      for (int x = 0; x <= n; ++x) {
        mesh.positions.push_back({x - 0.5 * n, y - 0.5 * n, z});
        mesh.normals.push_back({0, 0, z > 0 ? -1 : 1});
      }
  for (std::uint32_t plate = 0; plate < 2; ++plate)
    for (std::uint32_t y = 0; y < n; ++y)
      for (std::uint32_t x = 0; x < n; ++x) {
        const std::uint32_t a = plate * (n + 1) * (n + 1) + y * (n + 1) + x;
        mesh.triangles.push_back({a, a + 1, a + n + 2});
        mesh.triangles.push_back({a, a + n + 2, a + n + 1});
      }
  return mesh;
}

// Seen from the middle of a wide plate, the one above is hit at gap / cos: the mean of min(1, gap / (reach cos)) over a
// cosine-weighted sky is 2 g - g^2, where g = gap / reach.
TEST(AmbientOcclusion, BetweenTwoPlatesItIsWhatTheIntegralSays) {
  const Mesh mesh = plates(0.5);
  OcclusionOptions options;
  options.reach = 2;
  options.rays = 256;
  const auto open = ambient_occlusion(mesh, options, {});
  ASSERT_TRUE(open);
  const double g = 0.25;
  EXPECT_NEAR((*open)[10 * 21 + 10], 2 * g - g * g, 0.02);
}

TEST(AmbientOcclusion, FarObstaclesDoNotCount) {
  OcclusionOptions options;
  options.reach = 2;
  const auto open = ambient_occlusion(plates(3), options, {});
  ASSERT_TRUE(open);
  for (const float share : *open) EXPECT_EQ(share, 1.0f);
}

TEST(AmbientOcclusion, CrotchesAreDarkerThanTheRest) {
  const Field field = small_tree();
  const Mesh mesh = small_tree_mesh(field);
  OcclusionOptions options;
  options.reach = 0.3;
  const auto open = ambient_occlusion(mesh, options, {});
  ASSERT_TRUE(open);
  double crotch = 1, below = 0, count = 0;
  for (std::size_t i = 0; i < mesh.positions.size(); ++i) {
    ASSERT_GE((*open)[i], 0.0f);
    ASSERT_LE((*open)[i], 1.0f);
    if (glm::distance(mesh.positions[i], Vec3(0.12, 0, 1.15)) < 0.05) crotch = std::min<double>(crotch, (*open)[i]);
    if (mesh.positions[i].z < 0.5 && mesh.positions[i].z > 0.1) below += (*open)[i], ++count;
  }
  EXPECT_LT(crotch, 0.85);
  EXPECT_GT(below / count, 0.95);
}

/// How far apart, in the mean and for all but a hundredth.
struct Difference {
  double mean = 0, p99 = 0;
};

Difference difference(const std::vector<float>& a, const std::vector<float>& b) {
  std::vector<double> apart(a.size());
  for (std::size_t i = 0; i < a.size(); ++i) apart[i] = std::abs(a[i] - b[i]);
  std::sort(apart.begin(), apart.end());
  return {std::accumulate(apart.begin(), apart.end(), 0.0) / static_cast<double>(a.size()), apart[a.size() * 99 / 100]};
}

TEST(AmbientOcclusion, FewPlacesAndRaysAgreeWithEveryVertexAndMany) {
  const Field field = small_tree();
  const Mesh mesh = small_tree_mesh(field, 0.005);
  OcclusionOptions few, many;
  few.reach = many.reach = 0.6;
  few.spacing = 0.02;
  many.spacing = 0;
  many.rays = 256;
  const auto a = ambient_occlusion(mesh, few, {}), b = ambient_occlusion(mesh, many, {});
  ASSERT_TRUE(a && b);
  ASSERT_LT(3 * cluster_vertices(mesh, 0.02, {}).middle.size(), mesh.positions.size());   // there is something to leave out
  const Difference found = difference(*a, *b);
  EXPECT_LT(found.mean, 0.025);
  EXPECT_LT(found.p99, 0.12);
}

TEST(AmbientOcclusion, NoSpacingTakesEveryVertex) {
  const Field field = small_tree();
  const Mesh mesh = small_tree_mesh(field);
  OcclusionOptions options;
  options.spacing = 0;
  options.rays = 64;
  const auto a = ambient_occlusion(mesh, options, {});
  options.seed = 1'000'000;
  const auto b = ambient_occlusion(mesh, options, {});
  ASSERT_TRUE(a && b);
  EXPECT_LT(difference(*a, *b).p99, 0.02);
  EXPECT_EQ(cluster_vertices(mesh, 0, {}).middle.size(), mesh.positions.size());
}

TEST(AmbientOcclusion, AFlatPlateHasNothingInTheWay) {
  Mesh mesh = plates(1);
  mesh.positions.resize(21 * 21), mesh.normals.resize(21 * 21);
  mesh.triangles.resize(800);
  OcclusionOptions options;
  options.spacing = 100;
  const auto open = ambient_occlusion(mesh, options, {});
  ASSERT_TRUE(open);
  for (const float share : *open) EXPECT_EQ(share, 1.0f);
}

TEST(AmbientOcclusion, ThreadsDoNotChangeIt) {
  const Field field = small_tree();
  const Mesh mesh = small_tree_mesh(field);
  RunOptions one, four;
  one.threads = 1, four.threads = 4;
  EXPECT_EQ(ambient_occlusion(mesh, {}, one), ambient_occlusion(mesh, {}, four));
}

TEST(AmbientOcclusion, BadOptionsAreErrorsACancelledRunIsNothingAndAnEmptyMeshHasNoValues) {
  const Mesh mesh = plates(1);
  OcclusionOptions options;
  options.rays = 0;
  EXPECT_THROW(ambient_occlusion(mesh, options, {}), InputError);
  options.rays = 4;
  options.reach = 0;
  EXPECT_THROW(ambient_occlusion(mesh, options, {}), InputError);
  options.reach.reset();
  options.spacing = -1;
  EXPECT_THROW(ambient_occlusion(mesh, options, {}), InputError);
  std::atomic<bool> cancel{true};
  RunOptions run;
  run.cancel = &cancel;
  EXPECT_FALSE(ambient_occlusion(mesh, {}, run));
  EXPECT_TRUE(ambient_occlusion(Mesh{}, {}, {})->empty());
  Mesh bare = mesh;
  bare.normals.clear();
  EXPECT_THROW(ambient_occlusion(bare, {}, {}), std::invalid_argument);
}

}  // namespace
}  // namespace cambium
