#include "polygonize/cell_blocks.h"

#include "tests/polygonize/mesh_checks.h"

#include <gtest/gtest.h>

#include <functional>
#include <memory>
#include <random>
#include <stdexcept>

namespace cambium {
namespace {

using Inside = std::function<bool(int, int, int)>;

// Blocks of a grid of size^3 corners, outside beyond it; two cells of margin keep the places positive.
std::vector<CellBlock> blocks_of(int size, const Inside& inside) {
  const int blocks = (size + 3) / kBlockCells + 1;
  const auto sign = [&](int x, int y, int z) {
    x -= 2, y -= 2, z -= 2;
    return x >= 0 && y >= 0 && z >= 0 && x < size && y < size && z < size && inside(x, y, z);
  };
  std::vector<CellBlock> result;
  for (int bz = 0; bz < blocks; ++bz)
    for (int by = 0; by < blocks; ++by)
      for (int bx = 0; bx < blocks; ++bx) {
        CellBlock block;
        block.place = {std::uint32_t(bx), std::uint32_t(by), std::uint32_t(bz)};
        for (int z = 0; z < 8; ++z)
          for (int y = 0; y < 8; ++y)
            for (int x = 0; x < 8; ++x) {
              int mask = 0;
              for (int c = 0; c < 8; ++c)
                mask |= sign(8 * bx + x + (c & 1), 8 * by + y + (c >> 1 & 1), 8 * bz + z + (c >> 2)) << c;
              if (mask != 0 && mask != 255) block.append(x, y, z, std::uint8_t(mask));
            }
        if (!block.masks.empty()) result.push_back(std::move(block));
      }
  std::sort(result.begin(), result.end(),
            [](const CellBlock& a, const CellBlock& b) { return morton_key(a.place) < morton_key(b.place); });
  return result;
}

struct Contour {
  testing::MeshChecks checks;
  std::size_t flips = 0, cells = 0;
};

Contour contour(int size, const Inside& inside) {
  const std::vector<CellBlock> blocks = blocks_of(size, inside);
  std::vector<const CellBlock*> pointers;
  for (const CellBlock& block : blocks) pointers.push_back(&block);
  const CellConnectivity connectivity(pointers);
  Mesh mesh;
  std::vector<Quad> quads;
  std::uint32_t turn = 0;
  for (std::size_t b = 0; b < blocks.size(); ++b) {
    connectivity.quads(b, quads);
    EXPECT_EQ(quads.size(), connectivity.quad_count(b));
    for (const Quad& q : quads) {
      if (turn++ % 2) {   // both diagonals must do
        mesh.triangles.push_back({q[0], q[1], q[2]});
        mesh.triangles.push_back({q[0], q[2], q[3]});
      } else {
        mesh.triangles.push_back({q[1], q[2], q[3]});
        mesh.triangles.push_back({q[1], q[3], q[0]});
      }
    }
  }
  return {testing::check_mesh(mesh, false, connectivity.vertex_count()), connectivity.flipped_faces(),
          connectivity.cell_count()};
}

TEST(CellBlocks, FindReturnsThePositionOfEveryCell) {
  CellBlock block;
  int expected = 0;
  for (int z = 0; z < 8; ++z)
    for (int y = 0; y < 8; ++y)
      for (int x = 0; x < 8; ++x)
        if ((x * 7 + y * 5 + z * 3) % 4 == 0) block.append(x, y, z, 1);
  block.for_each([&](int index, int x, int y, int z) {
    EXPECT_EQ((x * 7 + y * 5 + z * 3) % 4, 0);
    EXPECT_EQ(index, expected++);
    EXPECT_EQ(block.find(x, y, z), index);
  });
  EXPECT_EQ(std::size_t(expected), block.masks.size());
  EXPECT_EQ(block.find(1, 0, 0), -1);
}

TEST(CellBlocks, OneInsideCornerGivesAClosedSurfaceAroundIt) {
  const Contour one = contour(1, [](int, int, int) { return true; });
  EXPECT_TRUE(one.checks.closed_manifold()) << one.checks;
  EXPECT_EQ(one.cells, 8u);
  EXPECT_EQ(one.checks.euler, 2);
}

TEST(CellBlocks, ABallHasEulerNumberTwoAndARingZero) {
  const Contour ball = contour(20, [](int x, int y, int z) {
    return (x - 10) * (x - 10) + (y - 10) * (y - 10) + (z - 10) * (z - 10) < 64;
  });
  EXPECT_TRUE(ball.checks.closed_manifold()) << ball.checks;
  EXPECT_EQ(ball.checks.euler, 2);
  const Contour ring = contour(24, [](int x, int y, int z) {
    const double d = std::hypot(x - 12.0, y - 12.0) - 7;
    return std::hypot(d, z - 12.0) < 3;
  });
  EXPECT_TRUE(ring.checks.closed_manifold()) << ring.checks;
  EXPECT_EQ(ring.checks.euler, 0);
}

TEST(CellBlocks, RandomNoiseOfAnyDensityIsAlwaysManifold) {
  std::size_t flips = 0;
  for (int seed = 0; seed < 60; ++seed) {
    std::mt19937 random(seed);
    const double density = 0.05 + 0.9 * (seed % 10) / 9.0;
    std::vector<bool> signs(12 * 12 * 12);
    for (std::size_t i = 0; i < signs.size(); ++i) signs[i] = std::uniform_real_distribution<>()(random) < density;
    const Contour noise = contour(12, [&](int x, int y, int z) { return signs[x + 12 * (y + 12 * z)]; });
    EXPECT_TRUE(noise.checks.closed_manifold()) << "seed " << seed << ": " << noise.checks;
    EXPECT_EQ(noise.checks.degenerate_triangles, 0u);
    flips += noise.flips;
  }
  EXPECT_GT(flips, 100u) << "the noise never met the case that the flip rule is for";
}

TEST(CellBlocks, AMissingCellIsAnInternalErrorAndNotAHole) {
  std::vector<CellBlock> blocks = blocks_of(10, [](int x, int y, int z) { return x > 2 && y > 2 && z > 2; });
  ASSERT_GT(blocks.size(), 1u);
  blocks.erase(blocks.begin() + 1);
  std::vector<const CellBlock*> pointers;
  for (const CellBlock& block : blocks) pointers.push_back(&block);
  EXPECT_THROW(
      {
        const CellConnectivity connectivity(pointers);
        std::vector<Quad> quads;
        for (std::size_t b = 0; b < pointers.size(); ++b) connectivity.quads(b, quads);
      },
      std::logic_error);
}

}  // namespace
}  // namespace cambium
