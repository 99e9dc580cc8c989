#include "skeletons/graph/closed_mesh.h"

#include "blobtree/input_error.h"
#include "blobtree/triangle_distance.h"
#include "skeletons/graph/mesh_closing.h"
#include "tests/blobtree/random_blobtrees.h"
#include "tests/skeletons/graph/closed_shapes.h"

#include <gtest/gtest.h>

namespace cambium {
namespace {

using testing::ball_shape;
using testing::box_shape;
using testing::Shape;

ClosedMesh mesh_of(const Shape& shape) { return ClosedMesh(shape.positions, shape.triangles); }

/// By the solid angles that all triangles are seen under (van Oosterom and Strackee 1983).
double winding_of(const Shape& shape, const Vec3& p) {
  double sum = 0;
  for (const auto& t : shape.triangles) {
    const Vec3 a = shape.positions[t[0]] - p, b = shape.positions[t[1]] - p, c = shape.positions[t[2]] - p;
    const double la = glm::length(a), lb = glm::length(b), lc = glm::length(c);
    sum += 2 * std::atan2(glm::dot(a, glm::cross(b, c)), la * lb * lc + glm::dot(a, b) * lc + glm::dot(b, c) * la + glm::dot(c, a) * lb);
  }
  return sum / (4 * std::numbers::pi);
}

TEST(ClosedMesh, ContainsWhatItWindsAround) {
  Draws draws(1);
  Shape crossing = ball_shape(9, 14, 1, Vec3(0), 5);
  crossing.add(ball_shape(8, 9, 0.8, {0.7, 0.2, 0.1}));
  Shape hollow = box_shape(Vec3(-1), Vec3(1)), hole = box_shape(Vec3(-0.5), Vec3(0.5));
  hole.turn_inside_out();
  hollow.add(hole);
  for (const Shape& shape : {ball_shape(20, 30, 1.2, Vec3(0.1), 7), crossing, hollow, box_shape({-1, -1, 0}, {1, 1, 1e-3})}) {
    const ClosedMesh mesh = mesh_of(shape);
    int inside = 0;
    for (int i = 0; i < 2000; ++i) {
      const Vec3 p = draws.point({mesh.bounds().lo - 0.1 * mesh.bounds().size(), mesh.bounds().hi + 0.1 * mesh.bounds().size()});
      const bool wanted = std::abs(winding_of(shape, p)) > 0.5;
      EXPECT_EQ(mesh.contains(p), wanted);
      inside += wanted;
    }
    EXPECT_GT(inside, 300);
  }
}

TEST(ClosedMesh, WaysUpThroughVerticesAndEdgesAreNotMistaken) {
  // The places of a lattice are above and below corners, edges and upright faces of the same lattice.
  Shape steps;
  for (int i = 0; i < 4; ++i) steps.add(box_shape({i, 0, 0}, {i + 1, 4, i + 1}));
  const ClosedMesh mesh = mesh_of(steps);
  for (int x = 0; x <= 16; ++x)
    for (int y = 1; y < 16; ++y)
      for (int z = 1; z < 18; ++z) {
        const Vec3 p{0.25 * x, 0.25 * y, 0.25 * z};
        const double here = std::ceil(p.x), next = std::floor(p.x) + 1;   // of the column, or of the two that meet in x
        if (x == 0 || x == 16 || p.z == here || p.z == next) continue;    // on the surface
        if (here != next && (p.z > here) != (p.z > next)) continue;
        EXPECT_EQ(mesh.contains(p), p.z < here) << p.x << " " << p.y << " " << p.z;
      }
}

TEST(ClosedMesh, IsAsDeepAsItsNearestTriangleIsFar) {
  Draws draws(2);
  const Shape shape = ball_shape(12, 17, 1, Vec3(0), 3);
  const ClosedMesh mesh = mesh_of(shape);
  for (int i = 0; i < 300; ++i) {
    const Vec3 p = draws.point(mesh.bounds());
    double least = kInfinity;
    for (const auto& t : shape.triangles)
      least = std::min(least, distance2_to_triangle(p, shape.positions[t[0]], shape.positions[t[1]], shape.positions[t[2]]));
    EXPECT_NEAR(mesh.depth(p), std::sqrt(least), 1e-12);
  }
}

TEST(ClosedMesh, StraightWaysMeetItWhereTheirPointsAreInIt) {
  Draws draws(3);
  const ClosedMesh mesh = mesh_of(ball_shape(12, 20, 1, Vec3(0), 4));
  int met = 0, missed = 0;
  for (int i = 0; i < 4000; ++i) {
    const Vec3 a = draws.point({Vec3(-1.6), Vec3(1.6)}), b = i % 2 ? draws.point({Vec3(-1.6), Vec3(1.6)}) : a + 0.3 * draws.direction();
    bool inside = false;
    double least = kInfinity;
    for (int s = 0; s <= 200; ++s) {
      const Vec3 p = glm::mix(a, b, s / 200.0);
      inside = inside || mesh.contains(p);
      least = std::min(least, mesh.depth(p));
    }
    const bool meets = mesh.meets(a, b);
    (meets ? met : missed) += 1;
    EXPECT_TRUE(meets || !inside);
    EXPECT_TRUE(inside || !meets || least < 0.01) << "samples miss short ways below the surface alone";
  }
  EXPECT_GT(met, 500);
  EXPECT_GT(missed, 500);
}

TEST(ClosedMesh, OfMostPlacesAGridKnowsTheSameAsTheTriangles) {
  Draws draws(4);
  const Shape fine = ball_shape(100, 100);   // 20 thousand triangles
  const ClosedMesh mesh = mesh_of(fine);
  EXPECT_EQ(mesh.triangle_count(), 19800u);
  for (int i = 0; i < 20000; ++i) {
    const Vec3 p = draws.point({Vec3(-1.1), Vec3(1.1)});
    const double length = glm::length(p);
    if (std::abs(length - 1) < 1e-3) continue;   // between the ball and its facets
    EXPECT_EQ(mesh.contains(p), length < 1);
  }
}

TEST(ClosedMesh, RefusesAnOpenCrown) {
  Shape open = ball_shape(5, 6);
  open.triangles.pop_back();
  EXPECT_THROW(mesh_of(open), InputError);
}

}  // namespace
}  // namespace cambium
