// Which lines a mesh is open along.
#include "polygonize/mesh_border.h"

#include <gtest/gtest.h>

#include <numeric>

namespace cambium {
namespace {

// A tube of four rings of three vertices: 3 i + k is corner k of ring i.
Mesh open_tube() {
  Mesh mesh;
  for (std::uint32_t i = 0; i < 4; ++i)
    for (std::uint32_t k = 0; k < 3; ++k) mesh.positions.emplace_back(k == 0, k == 1, i);
  for (std::uint32_t i = 0; i < 3; ++i)
    for (std::uint32_t k = 0; k < 3; ++k) {
      const std::uint32_t a = 3 * i + k, b = 3 * i + (k + 1) % 3;
      mesh.triangles.push_back({a, b, b + 3});
      mesh.triangles.push_back({a, b + 3, a + 3});
    }
  return mesh;
}

TEST(MeshBorder, ATubeIsOpenAtBothEndsInTheDirectionOfItsTriangles) {
  const Mesh mesh = open_tube();
  const MeshBorder border = find_border(mesh, std::vector<std::uint8_t>(12, 1));
  ASSERT_EQ(border.loops.size(), 2u);
  EXPECT_EQ(border.loops[0], (std::vector<std::uint32_t>{0, 1, 2}));
  EXPECT_EQ(border.loops[1], (std::vector<std::uint32_t>{9, 11, 10}));
}

TEST(MeshBorder, TrianglesNearAnEndAreThoseOfTwoRingsAroundIt) {
  const MeshBorder border = find_border(open_tube(), std::vector<std::uint8_t>(12, 1));
  std::vector<std::uint32_t> first(12), last(12);   // six in a ring; those in the middle are near both ends
  std::iota(first.begin(), first.end(), 0u);
  std::iota(last.begin(), last.end(), 6u);
  EXPECT_EQ(border.triangles, (std::vector<std::vector<std::uint32_t>>{first, last}));
}

TEST(MeshBorder, OnlyVerticesThatMayBeOpenAreLookedAt) {
  const Mesh mesh = open_tube();
  std::vector<std::uint8_t> may_be_open(12, 1);
  std::fill_n(may_be_open.begin(), 3, std::uint8_t{0});
  const MeshBorder border = find_border(mesh, may_be_open);
  ASSERT_EQ(border.loops.size(), 1u);
  EXPECT_EQ(border.loops[0].front(), 9u);
}

TEST(MeshBorder, AClosedMeshHasNone) {
  Mesh mesh = open_tube();
  mesh.triangles.push_back({2, 1, 0});
  mesh.triangles.push_back({9, 10, 11});
  EXPECT_TRUE(find_border(mesh, std::vector<std::uint8_t>(12, 1)).loops.empty());
}

}  // namespace
}  // namespace cambium
