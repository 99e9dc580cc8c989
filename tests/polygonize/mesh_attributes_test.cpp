#include "polygonize/mesh_attributes.h"

#include "blobtree/input_error.h"
#include "small_tree.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <atomic>
#include <stdexcept>

namespace cambium {
namespace {

using namespace testing;

TEST(MeshAttributes, TheSameAtAnyThreadCount) {
  const Field field = small_tree();
  const Mesh mesh = small_tree_mesh(field);
  MeshAttributeOptions options;
  options.occlusion = OcclusionOptions{};
  RunOptions one, three;
  one.threads = 1;
  three.threads = 3;
  const auto a = mesh_attributes(field, mesh, options, one), b = mesh_attributes(field, mesh, options, three);
  ASSERT_TRUE(a && b);
  EXPECT_EQ(a->uvs, b->uvs);
  EXPECT_EQ(a->uv_triangles, b->uv_triangles);
  EXPECT_EQ(a->unrolled, b->unrolled);
  EXPECT_EQ(a->triangle_order, b->triangle_order);
  EXPECT_EQ(a->branch, b->branch);
  EXPECT_EQ(a->radius, b->radius);
  EXPECT_EQ(a->arc_length, b->arc_length);
  EXPECT_EQ(a->ridge, b->ridge);
  EXPECT_EQ(a->occlusion, b->occlusion);
  EXPECT_EQ(a->tile, b->tile);
}

TEST(MeshAttributes, BranchesBeyondTheTableHaveDefaults) {
  const Field field = small_tree();
  const Mesh mesh = small_tree_mesh(field);
  MeshAttributeOptions options;
  options.branches = small_tree_branches();
  options.branches.resize(4);
  const MeshAttributes a = *mesh_attributes(field, mesh, options, {});
  EXPECT_EQ(a.branch_info(kLimb).parent, static_cast<std::int32_t>(kTrunk));
  EXPECT_EQ(a.branch_info(kSawn).parent, -1);
  EXPECT_EQ(a.branch_info(kSawn).axis, Vec3(0, 0, 1));
  EXPECT_TRUE(std::find(a.branch.begin(), a.branch.end(), kSawn) != a.branch.end());
}

TEST(MeshAttributes, AnEmptyMeshHasNone) {
  const Field field = small_tree();
  const auto a = mesh_attributes(field, Mesh{}, {}, {});
  ASSERT_TRUE(a);
  EXPECT_TRUE(a->branch.empty());
  EXPECT_TRUE(a->uvs.empty());
  EXPECT_TRUE(a->uv_triangles.empty());
}

TEST(MeshAttributes, BadOptionsAreErrorsAndACancelledRunIsNothing) {
  const Field field = small_tree();
  Mesh mesh = small_tree_mesh(field);
  MeshAttributeOptions options;
  options.tile = -1;
  EXPECT_THROW(mesh_attributes(field, mesh, options, {}), InputError);
  options.tile.reset();
  options.aspect = 0;
  EXPECT_THROW(mesh_attributes(field, mesh, options, {}), InputError);
  std::atomic<bool> cancel{true};
  RunOptions run;
  run.cancel = &cancel;
  EXPECT_FALSE(mesh_attributes(field, mesh, {}, run));
  mesh.normals.clear();
  EXPECT_THROW(mesh_attributes(field, mesh, {}, {}), std::invalid_argument);
}

}  // namespace
}  // namespace cambium
