#include "skeletons/graph/mesh_closing.h"

#include "blobtree/input_error.h"
#include "tests/skeletons/graph/closed_shapes.h"

#include <gtest/gtest.h>

namespace cambium {
namespace {

using testing::ball_shape;
using testing::box_shape;
using testing::Shape;

double volume_of(const Shape& shape) {
  double sum = 0;
  for (const auto& [a, b, c] : closed_triangles(shape.positions, shape.triangles)) sum += glm::dot(a, glm::cross(b, c)) / 6;
  return sum;
}

void expect_refused(const Shape& shape, const std::string& found) {
  try {
    closed_triangles(shape.positions, shape.triangles);
    FAIL() << found;
  } catch (const InputError& error) {
    EXPECT_NE(error.found().find(found), std::string::npos) << error.what();
    EXPECT_NE(error.found().find("mesh"), std::string::npos) << error.what();
    EXPECT_EQ(error.location().file, "");
  }
}

TEST(MeshClosing, TakesAClosedMeshAsItIs) {
  EXPECT_NEAR(volume_of(box_shape({0, 0, 0}, {1, 2, 3})), 6, 1e-12);
  Shape inside_out = box_shape({0, 0, 0}, {1, 2, 3});
  inside_out.turn_inside_out();
  EXPECT_NEAR(volume_of(inside_out), -6, 1e-12);
}

TEST(MeshClosing, VerticesAtOnePlaceAreOneAndTrianglesBetweenThemAreNone) {
  Shape apart;
  const Shape box = box_shape({0, 0, 0}, {1, 1, 1});
  for (const auto& t : box.triangles) {
    const auto first = static_cast<std::uint32_t>(apart.positions.size());
    for (const std::uint32_t v : t) apart.positions.push_back(box.positions[v]);
    apart.triangles.push_back({first, first + 1, first + 2});
  }
  apart.triangles.push_back({0, 0, 1});
  EXPECT_NEAR(volume_of(apart), 1, 1e-12);
  EXPECT_EQ(closed_triangles(apart.positions, apart.triangles).size(), 12u);
}

TEST(MeshClosing, TurnsTrianglesThatDisagreeOutwardsPartByPart) {
  for (int way = 0; way < 50; ++way) {
    Shape shape = ball_shape(5, 7);
    shape.add(box_shape({3, 0, 0}, {4, 1, 1}));
    const double wanted = volume_of(shape);
    for (std::size_t t = 0; t < shape.triangles.size(); ++t)
      if ((t * 7 + 3) % 11 < static_cast<std::size_t>(way % 10 + 1)) std::swap(shape.triangles[t][0], shape.triangles[t][1]);
    EXPECT_NEAR(volume_of(shape), wanted, 1e-12);
  }
}

TEST(MeshClosing, PartsThatTouchAlongAnEdgeAreClosed) {
  Shape shape = box_shape({0, 0, 0}, {1, 1, 1});
  shape.add(box_shape({1, 1, 0}, {2, 2, 1}));
  EXPECT_NEAR(volume_of(shape), 2, 1e-12);
}

TEST(MeshClosing, RefusesOpenMeshesWithTheirEdgesAndTheFirstOnesPlace) {
  Shape lid = box_shape({0, 0, 0}, {1, 1, 1});
  lid.triangles.erase(lid.triangles.begin() + 2, lid.triangles.begin() + 4);
  expect_refused(lid, "an open mesh: 4 edges have one triangle, the first from (0.000000, 0.000000, 1.000000) to (1.000000, 0.000000, 1.000000)");
  lid.triangles.pop_back();
  expect_refused(lid, "an open mesh: ");
  Shape one;
  one.positions = {{0, 0, 0}, {1, 0, 0}, {0, 1, 0}};
  one.triangles = {{0, 1, 2}};
  expect_refused(one, "an open mesh: 3 edges have one triangle");
}

TEST(MeshClosing, RefusesWallsSheetsAndMeshesWithOneSide) {
  Shape wall = box_shape({0, 0, 0}, {1, 1, 1});
  wall.triangles.push_back({0, 1, 7});
  wall.triangles.push_back({0, 7, 6});
  expect_refused(wall, "a mesh with walls in it: 4 edges have more than two triangles, the first from (0.000000, 0.000000, 0.000000)");
  Shape doubled;                                 // both sides of a leaf
  doubled.positions = {{0, 0, 0}, {1, 0, 0}, {0, 1, 0}, {1, 1, 1}};
  doubled.triangles = {{0, 1, 2}, {1, 3, 2}, {2, 1, 0}, {2, 3, 1}};
  expect_refused(doubled, "without volume");
  Shape flat;
  flat.positions = {{0, 0, 0}, {1, 0, 0}, {0, 1, 0}, {0.2, 0.2, 0}};
  flat.triangles = {{0, 1, 3}, {1, 2, 3}, {2, 0, 3}, {0, 2, 1}};
  expect_refused(flat, "without volume");
  Shape three;                                   // three fins on one edge, each closed to the next
  three.positions = {{0, 0, 0}, {0, 0, 1}, {1, 0, 0}, {-1, 1, 0}, {-1, -1, 0}};
  three.triangles = {{0, 1, 2}, {0, 1, 3}, {0, 1, 4}, {2, 3, 1}, {3, 4, 1}, {4, 2, 1}, {2, 0, 3}, {3, 0, 4}, {4, 0, 2}};
  expect_refused(three, "a mesh with walls in it: ");
  Shape klein;                                   // a tube of squares whose ends are joined the wrong way round
  constexpr std::uint32_t kAround = 6, kAlong = 6;
  for (std::uint32_t i = 0; i < kAlong * kAround; ++i) klein.positions.emplace_back(i, i * i % 17, i * i * i % 23);
  for (std::uint32_t i = 0; i < kAlong; ++i)
    for (std::uint32_t j = 0; j < kAround; ++j) {
      const auto at = [&](std::uint32_t k, std::uint32_t l) { return k < kAlong ? k * kAround + l % kAround : (kAround - l % kAround) % kAround; };
      klein.triangles.push_back({at(i, j), at(i + 1, j), at(i + 1, j + 1)});
      klein.triangles.push_back({at(i, j), at(i + 1, j + 1), at(i, j + 1)});
    }
  expect_refused(klein, "one side only");
}

TEST(MeshClosing, RefusesWhatIsNoMesh) {
  expect_refused({}, "a mesh without triangles");
  Shape box = box_shape({0, 0, 0}, {1, 1, 1});
  box.triangles[4][1] = 8;
  expect_refused(box, "triangle 5 has vertex 9");
  box = box_shape({0, 0, 0}, {1, 1, 1});
  box.positions[3].y = NAN;
  expect_refused(box, "vertex 4 is not finite");
  Shape point;
  point.positions = {{1, 1, 1}, {1, 1, 1}, {1, 1, 1}};
  point.triangles = {{0, 1, 2}};
  expect_refused(point, "without volume");
}

}  // namespace
}  // namespace cambium
