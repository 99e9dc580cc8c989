#include "polygonize/verify.h"

#include "tests/blobtree/random_blobtrees.h"
#include "tests/polygonize/cgal_check.h"
#include "tests/polygonize/simple_meshes.h"

#include <gtest/gtest.h>

#include <atomic>

namespace cambium {
namespace {

using Pairs = std::vector<std::array<std::uint32_t, 2>>;
using testing::ball_mesh;
using testing::ring_mesh;

const Box kUnit{Vec3(-1), Vec3(1)};

Pairs ours(const Mesh& mesh, int threads = 0) {
  RunOptions run;
  run.threads = threads;
  return *self_intersections(mesh, run);
}

// Two triangles that share their first `shared` corners.
Mesh two(const std::array<Vec3, 3>& s, const std::array<Vec3, 3>& t, std::size_t shared) {
  Mesh mesh;
  mesh.positions.assign(s.begin(), s.end());
  mesh.triangles.push_back({0, 1, 2});
  std::array<std::uint32_t, 3> second{};
  for (std::size_t k = 0; k < 3; ++k) {
    second[k] = static_cast<std::uint32_t>(k < shared ? k : mesh.positions.size());
    if (k >= shared) mesh.positions.push_back(t[k]);
  }
  if (shared == 2) std::swap(second[0], second[1]);   // wound alike
  mesh.triangles.push_back(second);
  return mesh;
}

TEST(SelfIntersection, KnownPairs) {
  const Vec3 o(0), x(1, 0, 0), y(0, 1, 0), z(0, 0, 1);
  const auto count = [](const Mesh& mesh) { return ours(mesh).size(); };
  // Nothing shared: apart, through each other, touching in a point, coplanar beside and inside each other.
  EXPECT_EQ(count(two({o, x, y}, {z, x + z, y + z}, 0)), 0u);
  EXPECT_EQ(count(two({o, x, y}, {0.2 * (x + y) - z, 0.2 * (x + y) + z, 3.0 * x + z}, 0)), 1u);
  EXPECT_EQ(count(two({o, x, y}, {0.25 * (x + y), z, x + z}, 0)), 1u);
  EXPECT_EQ(count(two({o, x, y}, {x, 2.0 * x, x + z}, 0)), 1u);
  EXPECT_EQ(count(two({o, x, y}, {x + y, 2.0 * x + y, 2.0 * y + x}, 0)), 0u);
  EXPECT_EQ(count(two({o, x, y}, {0.1 * (x + y), 0.3 * x + 0.1 * y, 0.1 * x + 0.3 * y}, 0)), 1u);
  // A corner: the other triangle off the plane, through the triangle, along its side, within its plane.
  EXPECT_EQ(count(two({o, x, y}, {o, -x + z, -y + z}, 1)), 0u);
  EXPECT_EQ(count(two({o, x, y}, {o, 0.3 * (x + y) + z, 0.3 * (x + y) - z}, 1)), 1u);
  EXPECT_EQ(count(two({o, x, y}, {o, 0.3 * x, z}, 1)), 1u);
  EXPECT_EQ(count(two({o, x, y}, {o, 3.0 * x, z}, 1)), 1u);
  EXPECT_EQ(count(two({o, x, y}, {o, -x, -y}, 1)), 0u);
  EXPECT_EQ(count(two({o, x, y}, {o, 2.0 * x + y, x + 2.0 * y}, 1)), 1u);
  // An edge: bent, flat, folded onto each other.
  EXPECT_EQ(count(two({o, x, y}, {o, x, z}, 2)), 0u);
  EXPECT_EQ(count(two({o, x, y}, {o, x, y + 1e-9 * z}, 2)), 0u);
  EXPECT_EQ(count(two({o, x, y}, {o, x, -y}, 2)), 0u);
  EXPECT_EQ(count(two({o, x, y}, {o, x, 0.3 * x + 0.1 * y}, 2)), 1u);
  // The same triangle twice.
  EXPECT_EQ(count(two({o, x, y}, {o, x, y}, 3)), 1u);
}

TEST(SelfIntersection, RoundMeshesHaveNone) {
  EXPECT_TRUE(ours(ball_mesh(5, 1)).empty());
  EXPECT_TRUE(ours(ring_mesh(200, 60, 1, 0.4)).empty());
}

TEST(SelfIntersection, ABallInABallMeetsNothingAndTwoThatOverlapMeetInARing) {
  EXPECT_TRUE(ours(testing::joined(ball_mesh(4, 1), ball_mesh(3, 0.5))).empty());
  const Mesh overlapping = testing::joined(ball_mesh(4, 1), ball_mesh(3, 0.5, Vec3(0.9, 0.13, 0.07)));
  const Pairs pairs = ours(overlapping);
  EXPECT_GT(pairs.size(), 20u);
  EXPECT_EQ(pairs, testing::cgal_self_intersections(overlapping));
}

TEST(SelfIntersection, SoupsOfTrianglesAgreeWithCgal) {
  std::size_t found = 0;
  for (std::uint64_t seed = 0; seed < 200; ++seed) {
    Draws draws(seed);
    Mesh soup;
    const double grid = seed % 3 == 0 ? 4 : seed % 3 == 1 ? 16 : 0;   // coarse grids touch, and lie in one plane, all the time
    for (std::uint32_t i = 0; i < 60; ++i) {
      const Vec3 at = draws.point(kUnit);
      const double size = grid > 0 ? draws.in(1 / grid, 0.8) : std::pow(10.0, draws.in(-2, -0.2));
      std::array<Vec3, 3> corner;
      do {
        for (Vec3& p : corner) {
          p = at + size * draws.point(kUnit);
          if (grid > 0) p = glm::round(p * grid) / grid;
        }
      } while (testing::cgal_collinear(corner[0], corner[1], corner[2]));
      soup.positions.insert(soup.positions.end(), corner.begin(), corner.end());
      soup.triangles.push_back({3 * i, 3 * i + 1, 3 * i + 2});
    }
    const Pairs pairs = ours(soup);
    found += pairs.size();
    ASSERT_EQ(pairs, testing::cgal_self_intersections(soup)) << "seed " << seed;
  }
  EXPECT_GT(found, 3000u);
}

TEST(SelfIntersection, CrumpledMeshesAgreeWithCgal) {
  std::size_t found = 0;
  for (std::uint64_t seed = 0; seed < 200; ++seed) {
    Draws draws(seed);
    Mesh mesh = seed % 2 ? ring_mesh(16, 10, 1, 0.5) : ball_mesh(3, 1);
    const double much = std::pow(10.0, draws.in(-2.5, -0.5));
    for (Vec3& p : mesh.positions) {
      p += much * draws.point(kUnit);
      if (seed % 4 >= 2) p = glm::round(p * 12.0) / 12.0;   // corners fall together, triangles lie in one plane or have no area
    }
    Mesh sound = mesh;   // CGAL asks for triangles with an area: take the others out
    std::erase_if(sound.triangles, [&](const auto& t) {
      return testing::cgal_collinear(mesh.positions[t[0]], mesh.positions[t[1]], mesh.positions[t[2]]);
    });
    const Pairs pairs = ours(sound);
    found += pairs.size();
    Pairs theirs;
    try {
      theirs = testing::cgal_self_intersections(sound);
    } catch (const std::invalid_argument&) {
      continue;   // what was left hangs together by a corner
    }
    ASSERT_EQ(pairs, theirs) << "seed " << seed;
  }
  EXPECT_GT(found, 3000u);
}

TEST(SelfIntersection, TinyTrianglesBesideHugeOnesAgreeWithCgal) {
  // A fine ball through the face of an octahedron a thousand times as large.
  const Mesh mesh = testing::joined(ball_mesh(0, 10), ball_mesh(4, 0.01, Vec3(10 / 3.0 + 0.002)));
  const Pairs pairs = ours(mesh);
  EXPECT_GT(pairs.size(), 10u);
  EXPECT_EQ(pairs, testing::cgal_self_intersections(mesh));
}

TEST(SelfIntersection, TheSameAtAnyThreadCount) {
  Draws draws(5);
  Mesh mesh = ring_mesh(100, 50, 1, 0.4);
  for (Vec3& p : mesh.positions) p += 0.03 * draws.point(kUnit);
  const Pairs one = ours(mesh, 1);
  EXPECT_FALSE(one.empty());
  EXPECT_TRUE(std::is_sorted(one.begin(), one.end()));
  EXPECT_EQ(one, ours(mesh, 2));
  EXPECT_EQ(one, ours(mesh, 4));
}

TEST(SelfIntersection, TrianglesWithoutAreaDoNoHarm) {
  Mesh mesh;
  mesh.positions = {{0, 0, 0}, {1, 0, 0}, {2, 0, 0}, {0, 1, 0}, {0.5, 0.2, -1}, {0.5, 0.2, 1}, {0.5, 0.2, 0}};
  mesh.triangles = {{0, 1, 3}, {4, 5, 6}};   // a triangle pierced by a line
  EXPECT_EQ(ours(mesh), (Pairs{{0, 1}}));
  mesh.triangles = {{0, 1, 3}, {4, 4, 4}};   // and a point off it
  EXPECT_EQ(ours(mesh), Pairs{});
  mesh.triangles = {{0, 1, 3}, {6, 6, 6}};   // and on it
  EXPECT_EQ(ours(mesh), (Pairs{{0, 1}}));
  mesh.triangles = {{0, 1, 2}, {4, 5, 6}};   // two lines apart
  EXPECT_EQ(ours(mesh), Pairs{});
  EXPECT_TRUE(ours(Mesh{}).empty());
}

TEST(SelfIntersection, Cancelled) {
  const std::atomic<bool> cancel{true};
  RunOptions run;
  run.cancel = &cancel;
  EXPECT_FALSE(self_intersections(ball_mesh(3, 1), run).has_value());
}

}  // namespace
}  // namespace cambium
