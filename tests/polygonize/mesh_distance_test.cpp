#include "polygonize/mesh_distance.h"

#include "tests/blobtree/random_blobtrees.h"
#include "tests/polygonize/simple_meshes.h"

#include <gtest/gtest.h>

namespace cambium {
namespace {

const Box kAround{Vec3(-2), Vec3(2)};

double slowly(const Mesh& mesh, const Vec3& p) {
  double least = kInfinity;
  for (const auto& t : mesh.triangles) {
    least = std::min(least, distance2_to_triangle(p, mesh.positions[t[0]], mesh.positions[t[1]], mesh.positions[t[2]]));
  }
  return std::sqrt(least);
}

TEST(MeshDistance, TheTreeFindsTheNearestOfTrianglesOfAnySize) {
  Draws draws(1);
  Mesh mesh = testing::joined(testing::ball_mesh(4, 1), testing::ball_mesh(3, 0.004, Vec3(1.02, 0, 0)));
  mesh = testing::joined(std::move(mesh), testing::ball_mesh(0, 50, Vec3(0, 0, -60)));
  const MeshDistance distance(mesh);
  for (int i = 0; i < 300; ++i) {
    const Vec3 p = i % 3 ? draws.point(kAround) : Vec3(1.02, 0, 0) + 0.01 * draws.direction();
    const double true_distance = slowly(mesh, p);
    EXPECT_EQ(distance(p), true_distance);
    EXPECT_EQ(distance(p, true_distance), true_distance);
    EXPECT_EQ(distance(p, 1.5 * true_distance), true_distance);
  }
}

TEST(MeshDistance, ToNoTriangleIsInfinite) {
  const Mesh empty;
  EXPECT_EQ(MeshDistance(empty)(Vec3(0)), kInfinity);
}

}  // namespace
}  // namespace cambium
