#include "polygonize/lattice.h"

#include "blobtree/input_error.h"

#include <gtest/gtest.h>

namespace cambium {
namespace {

TEST(Lattice, CoversTheBoundsWithABlockToSpare) {
  const Box bounds{Vec3(-3.3, 1.7, 100.2), Vec3(4.1, 2.0, 131)};
  for (const double voxel : {0.013, 0.4, 7.0}) {
    const Lattice lattice = make_lattice(bounds, voxel);
    const Box root = lattice.blocks.box({0, 0, 0}, lattice.blocks.levels);
    for (int a = 0; a < 3; ++a) {
      EXPECT_LE(root.lo[a], bounds.lo[a] - kBlockCells * voxel * 0.999);
      EXPECT_GE(root.hi[a], bounds.hi[a] + kBlockCells * voxel * 0.999);
      EXPECT_EQ(lattice.first(a) % kBlockCells, 0);
    }
  }
}

TEST(Lattice, PointsAreMultiplesOfTheVoxelWhateverTheBounds) {
  const Lattice one = make_lattice({Vec3(-1), Vec3(1)}, 0.1), two = make_lattice({Vec3(-7), Vec3(3)}, 0.1);
  const auto in_two = [&](int a, std::uint64_t i) { return static_cast<std::uint64_t>(one.first(a) - two.first(a)) + i; };
  for (std::uint64_t i = 0; i < 40; ++i) {
    EXPECT_EQ(one.point(i, 2 * i, 5), two.point(in_two(0, i), in_two(1, 2 * i), in_two(2, 5)));
  }
}

TEST(Lattice, CornersOfBlocksArePoints) {
  for (const double voxel : {0.1, 0.013, 1.0 / 3, 7e-4}) {
    const Lattice lattice = make_lattice({Vec3(-1.7, 0.3, 12), Vec3(2, 1, 13)}, voxel);
    for (std::uint32_t i = 0; i < 20; ++i) {
      const Box box = lattice.box({i, 2 * i, 3});
      EXPECT_EQ(box.lo, lattice.point(8 * i, 16 * i, 24));
      EXPECT_EQ(box.hi, lattice.point(8 * i + 8, 16 * i + 8, 32));
    }
  }
}

TEST(Lattice, AVoxelTooFineToIndexIsAnInputError) {
  EXPECT_THROW(make_lattice({Vec3(0), Vec3(100)}, 1e-5), InputError);
  EXPECT_THROW(make_lattice({Vec3(1e9), Vec3(1e9 + 1)}, 1e-6), InputError);
  EXPECT_NO_THROW(make_lattice({Vec3(0), Vec3(100)}, 1e-4));
  EXPECT_THROW(require_length(0, "voxel"), InputError);
  EXPECT_THROW(require_length(kInfinity, "voxel"), InputError);
  EXPECT_NO_THROW(require_length(1e-3, "voxel"));
}

}  // namespace
}  // namespace cambium
