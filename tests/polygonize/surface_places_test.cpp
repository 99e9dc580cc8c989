#include "polygonize/surface_places.h"

#include "small_tree.h"

#include <gtest/gtest.h>

#include <atomic>
#include <cmath>

namespace cambium {
namespace {

using namespace testing;

std::size_t nearest_vertex(const Mesh& mesh, const Vec3& p) {
  std::size_t best = 0;
  for (std::size_t i = 1; i < mesh.positions.size(); ++i)
    if (glm::distance(mesh.positions[i], p) < glm::distance(mesh.positions[best], p)) best = i;
  return best;
}

TEST(SurfacePlaces, VerticesTellTheirBranchRadiusAndLength) {
  const Field field = small_tree();
  const Mesh mesh = small_tree_mesh(field);
  MeshAttributes a;
  const auto places = surface_places(field, mesh, {}, a, {});
  ASSERT_TRUE(places);
  const std::size_t trunk = nearest_vertex(mesh, {-0.09, 0, 0.5});
  EXPECT_EQ(a.branch[trunk], kTrunk);
  EXPECT_EQ(a.order[trunk], 0u);
  EXPECT_NEAR(a.radius[trunk], 0.0925, 1e-3);
  EXPECT_NEAR(a.arc_length[trunk], mesh.positions[trunk].z, 0.01);
  EXPECT_EQ((*places)[static_cast<std::uint32_t>(trunk)].size(), 1u);
  const Vec3 along = glm::normalize(Vec3(1, 0, 0.6)), on_limb = Vec3(0.02, 0, 1) + 0.6 * along;
  const std::size_t limb = nearest_vertex(mesh, on_limb + Vec3(0, 0.04, 0));
  EXPECT_EQ(a.branch[limb], kLimb);
  EXPECT_EQ(a.order[limb], 1u);
  EXPECT_NEAR(a.radius[limb], 0.0384, 2e-3);
  EXPECT_NEAR(a.arc_length[limb], 1 + glm::dot(mesh.positions[limb] - Vec3(0.02, 0, 1), along), 1e-3);
}

// At the fork lengths and radii run from one branch to the other without a jump, while ids change at once.
TEST(SurfacePlaces, LengthsBlendWhereTheFieldBlends) {
  const Field field = small_tree();
  const Mesh mesh = small_tree_mesh(field, 0.006);
  MeshAttributes a;
  ASSERT_TRUE(surface_places(field, mesh, {}, a, {}));
  std::size_t across = 0;
  for (const auto& t : mesh.triangles)
    for (int c = 0; c < 3; ++c) {
      const std::uint32_t i = t[c], k = t[(c + 1) % 3];
      if (a.branch[i] == a.branch[k]) continue;
      ++across;
      EXPECT_LT(std::abs(a.arc_length[i] - a.arc_length[k]), 0.03) << mesh.positions[i].z;
      EXPECT_LT(std::abs(a.radius[i] - a.radius[k]), 0.02);
    }
  EXPECT_GT(across, 50u);
}

// A trunk's support reaches twelve of this twig's diameters along it.
TEST(SurfacePlaces, ATwigIsItselfFromWhereItLeavesTheTrunk) {
  BlobTreeBuilder builder;
  const NodeId trunk = builder.add(Chain{{{Vec3(0), 0.1}, {Vec3(0, 0, 1), 0.1}}, 1});
  builder.set_attributes(trunk, {2, 0, 0, Vec3(1, 0, 0)});
  const NodeId twig = builder.add(Chain{{{Vec3(0, 0, 0.5), 0.005}, {Vec3(0.4, 0, 0.5), 0.005}}, 1});
  builder.set_attributes(twig, {9, 1, 0.5, Vec3(0, 0, 1)});
  const Field field(builder.build(builder.add(Sum{{trunk, twig}})));
  PolygonizeOptions options;
  options.tolerance = 0.0005;
  const Mesh mesh = polygonize(field, options, {})->mesh;
  MeshAttributes a;
  const auto places = surface_places(field, mesh, {}, a, {});
  ASSERT_TRUE(places);
  std::size_t on_twig = 0, on_trunk = 0;
  for (std::uint32_t v = 0; v < mesh.positions.size(); ++v) {
    const Vec3& p = mesh.positions[v];
    float shares = 0;
    for (const SurfacePlace& place : (*places)[v]) shares += place.weight;
    EXPECT_NEAR(shares, 1, 1e-5);
    if (p.x > 0.125) {   // beyond where the two melt into each other
      ++on_twig;
      EXPECT_NEAR(a.radius[v], 0.005, 0.0005) << p.x;
      EXPECT_NEAR(a.arc_length[v], 0.5 + p.x, 0.01);
      EXPECT_EQ(a.branch[v], 9u);
      EXPECT_EQ(a.order[v], 1u);
    } else if (p.x < 0 || std::abs(p.z - 0.5) > 0.03) {
      ++on_trunk;
      EXPECT_NEAR(a.radius[v], 0.1, 0.005);
      EXPECT_EQ(a.branch[v], 2u);
    }
  }
  EXPECT_GT(on_twig, 200u);
  EXPECT_GT(on_trunk, 200u);
}

TEST(SurfacePlaces, RidgesAreOnlyWhereBranchesMeet) {
  const Field field = small_tree();
  const Mesh mesh = small_tree_mesh(field);
  MeshAttributes a;
  ASSERT_TRUE(surface_places(field, mesh, {}, a, {}));
  float most = 0;
  for (std::size_t i = 0; i < mesh.positions.size(); ++i) {
    most = std::max(most, a.ridge[i]);
    EXPECT_TRUE(mesh.positions[i].z > 0.6 || a.ridge[i] == 0);
  }
  EXPECT_GT(most, 0.5);
}

// A scar's stub has its branch's id and coordinates of its own, which are not its branch's.
TEST(SurfacePlaces, ThinPrimitivesOfABranchDoNotSpeakForIt) {
  BlobTreeBuilder builder;
  const NodeId trunk = builder.add(Chain{{{Vec3(0), 0.1}, {Vec3(0, 0, 1), 0.1}}, 1});
  builder.set_attributes(trunk, {5, 0, 0, Vec3(1, 0, 0)});
  const NodeId stub = builder.add(Capsule{Vec3(0.05, 0, 0.5), Vec3(0.12, 0, 0.5), 0.04, 1});
  builder.set_attributes(stub, {5, 0, 0.5, Vec3(0)});
  const Field field(builder.build(builder.add(Sum{{trunk, stub}})));
  const Mesh mesh = small_tree_mesh(field);
  MeshAttributes a;
  const auto places = surface_places(field, mesh, {}, a, {});
  ASSERT_TRUE(places);
  for (std::uint32_t v = 0; v < mesh.positions.size(); ++v) {
    ASSERT_EQ((*places)[v].size(), 1u);
    ASSERT_FLOAT_EQ((*places)[v][0].radius, 0.1f);
  }
}

TEST(SurfacePlaces, AVertexOffTheSurfaceIsReadAllTheSameAndOneFarAwayHasNothing) {
  const Field field = small_tree();
  Mesh mesh;
  mesh.positions = {Vec3(-0.11, 0, 0.5), Vec3(3, 3, 3), Vec3(0, 0, 0.5)};
  mesh.normals.assign(3, {0, 0, 1});
  MeshAttributes a;
  const auto places = surface_places(field, mesh, {}, a, {});
  ASSERT_TRUE(places);
  EXPECT_EQ((*places)[0].size(), 1u);
  EXPECT_TRUE((*places)[1].empty());
  EXPECT_EQ(places->heaviest(1), nullptr);
  EXPECT_EQ((*places)[2].size(), 1u);   // deep in the wood, where no cell of the surface is
  EXPECT_EQ(a.radius[1], 0);
}

TEST(SurfacePlaces, ColoursComeFromTheCallback) {
  const Field field = small_tree();
  const Mesh mesh = small_tree_mesh(field);
  MeshAttributes a;
  const SurfaceColor red_above_one = [](std::span<const Contribution>, const SurfaceTraits&, const VertexSite& at) {
    EXPECT_NEAR(glm::length(at.normal), 1, 1e-3);
    EXPECT_GT(at.spacing, 0);
    return std::array<std::uint8_t, 4>{static_cast<std::uint8_t>(at.position.z > 1 ? 200 : 10), 0, 0, 255};
  };
  ASSERT_TRUE(surface_places(field, mesh, red_above_one, a, {}));
  ASSERT_EQ(a.colors.size(), mesh.positions.size());
  for (std::size_t i = 0; i < a.colors.size(); ++i) EXPECT_EQ(a.colors[i][0], mesh.positions[i].z > 1 ? 200 : 10);
}

TEST(SurfacePlaces, CancelledItIsNothing) {
  const Field field = small_tree();
  const Mesh mesh = small_tree_mesh(field);
  std::atomic<bool> cancel{false};
  RunOptions run;
  run.cancel = &cancel;
  MeshAttributes a;
  const SurfaceColor stop = [&](std::span<const Contribution>, const SurfaceTraits&, const VertexSite&) {
    cancel = true;
    return std::array<std::uint8_t, 4>{};
  };
  EXPECT_FALSE(surface_places(field, mesh, stop, a, run));
}

}  // namespace
}  // namespace cambium
