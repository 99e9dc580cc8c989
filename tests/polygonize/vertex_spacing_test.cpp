#include "polygonize/vertex_spacing.h"

#include "small_tree.h"

#include <gtest/gtest.h>
#include <tbb/task_arena.h>

#include <cmath>

namespace cambium {
namespace {

using namespace testing;

TEST(VertexSpacing, IsBetweenTheShortestAndTheLongestEdge) {
  Mesh mesh;
  mesh.positions = {Vec3(0, 0, 0), Vec3(9, 0, 0), Vec3(0, 4, 0), Vec3(7, 7, 7)};
  mesh.triangles = {{0, 1, 2}};
  const auto spacing = vertex_spacing(mesh, {});
  ASSERT_EQ(spacing.size(), 4u);
  const double slant = std::sqrt(97.0);
  EXPECT_NEAR(spacing[0], std::sqrt(9.0 * 4.0), 1e-5);
  EXPECT_NEAR(spacing[1], std::sqrt(9.0 * slant), 1e-5);
  EXPECT_NEAR(spacing[2], std::sqrt(4.0 * slant), 1e-5);
  EXPECT_EQ(spacing[3], 0);   // no edge leads there
}

TEST(VertexSpacing, IsTheSameAtAnyThreadCount) {
  const Mesh mesh = small_tree_mesh(small_tree());
  std::vector<std::vector<float>> found;
  for (const int threads : {1, 2, 4}) {
    tbb::task_arena arena(threads);
    arena.execute([&] { found.push_back(vertex_spacing(mesh, {})); });
  }
  EXPECT_EQ(found[0], found[1]);
  EXPECT_EQ(found[0], found[2]);
}

}  // namespace
}  // namespace cambium
