#include "skeletons/graph/dart_block.h"

#include "blobtree/place_hash.h"
#include "tests/skeletons/graph/node_clouds.h"

#include <gtest/gtest.h>

#include <array>
#include <bit>

namespace cambium {
namespace {

using namespace testing;

constexpr GroupBits kAllGroups = ~GroupBits{0};

Vec3 unit_place(std::uint64_t i) { return {unit_of(hash_of(3, i, 0)), unit_of(hash_of(3, i, 1)), unit_of(hash_of(3, i, 2))}; }

/// Whether group (x, y, z), counted from the middle cube's first, is set in the 27 cubes.
bool is_set(const std::array<GroupBits, 27>& cubes, int x, int y, int z) {
  const auto cube = static_cast<std::size_t>(((z + 4) / 4 * 3 + (y + 4) / 4) * 3 + (x + 4) / 4);
  return cubes[cube] >> (((z + 4) % 4 * 4 + (y + 4) % 4) * 4 + (x + 4) % 4) & 1;
}

TEST(GroupBits, GrowByOneGroupAlsoAcrossCubes) {
  for (std::uint64_t round = 0; round < 50; ++round) {
    std::array<GroupBits, 27> cubes;
    for (std::size_t i = 0; i < 27; ++i) cubes[i] = hash_of(1, round, i) & hash_of(2, round, i) & hash_of(3, round, i);
    const GroupBits found = grown(cubes);
    for (int i = 0; i < 64; ++i) {
      const int x = i % 4, y = i / 4 % 4, z = i / 16;
      const bool expected = is_set(cubes, x, y, z) || is_set(cubes, x - 1, y, z) || is_set(cubes, x + 1, y, z) || is_set(cubes, x, y - 1, z) ||
                            is_set(cubes, x, y + 1, z) || is_set(cubes, x, y, z - 1) || is_set(cubes, x, y, z + 1);
      ASSERT_EQ(found >> i & 1, GroupBits{expected}) << i;
    }
  }
}

TEST(GroupBits, OfAPlaceIsTheGroupThatHoldsIt) {
  const DartLattice lattice({{-1, -2, -3}, {20, 20, 20}}, 0.7);
  const std::array<int, 3> cube{2, 1, 3};
  for (int i = 0; i < 64; ++i) {
    const Vec3 middle = lattice.corner(cube) + lattice.group_side() * (Vec3(i % 4, i / 4 % 4, i / 16) + 0.5);
    EXPECT_EQ(group_of(lattice, cube, middle), GroupBits{1} << i);
  }
  EXPECT_EQ(group_of(lattice, cube, lattice.corner(cube) - 1e-9), GroupBits{1});
}

TEST(GroupBits, InsideAVolumeAreAllAndOutsideNone) {
  const GraphVolume volume = ball(4);
  const DartLattice lattice(volume.bounds(), 0.1);
  std::array<int, 3> middle;
  for (int k = 0; k < 3; ++k) middle[std::size_t(k)] = static_cast<int>((volume.bounds().center() - lattice.lo)[k] / lattice.cube_side());
  EXPECT_EQ(groups_inside(volume, lattice, middle), kAllGroups);
  EXPECT_EQ(groups_inside(volume, lattice, {0, 0, 0}), GroupBits{0});
}

TEST(DartBlock, KeepsItsDistanceFromWhatIsThereAndStaysInTheCube) {
  const GraphVolume volume = ball(4);
  const DartLattice lattice(volume.bounds(), 0.5);
  DartBlock block(volume, lattice, 1);
  const std::array<int, 3> cube{1, 2, 1};
  const Box box{lattice.corner(cube), lattice.corner(cube) + lattice.cube_side()};
  std::vector<Vec3> there;
  for (std::uint64_t i = 0; i < 40; ++i) there.push_back(box.lo - 1.0 + (box.size() + 2.0) * unit_place(i));
  std::vector<Vec3> found;
  block.open(cube);
  block.add(there);
  block.fill(9, {.likely = kAllGroups}, found);
  ASSERT_GT(found.size(), 20u);
  for (const Vec3& p : found) EXPECT_TRUE(box.contains(p) && volume.contains(p));
  there.insert(there.end(), found.begin(), found.end());
  EXPECT_GE(least_distance(there, 1.5, 40), 0.5);
}

TEST(DartBlock, LeavesNoPlaceFartherFromANodeThanTheSizeOfItsPartsAllows) {
  const GraphVolume volume = ball(9);
  const DartLattice lattice(volume.bounds(), 0.5);
  const std::array<int, 3> cube{3, 3, 3};
  for (int halvings = 0; halvings <= 3; ++halvings) {
    DartBlock block(volume, lattice, halvings);
    std::vector<Vec3> found;
    block.open(cube);
    block.fill(4, {.likely = kAllGroups}, found);
    for (std::uint64_t i = 0; i < 3000; ++i) {
      const Vec3 p = lattice.corner(cube) + lattice.cube_side() * unit_place(i);
      double nearest = kInfinity;
      for (const Vec3& node : found) nearest = std::min(nearest, glm::length(p - node));
      ASSERT_LE(nearest, 0.5 * (1 + 1.0 / (1 << halvings)));
    }
  }
}

TEST(DartBlock, ThrowsOnlyAtTheGroupsThatAreSet) {
  const GraphVolume volume = ball(9);
  const DartLattice lattice(volume.bounds(), 0.5);
  const std::array<int, 3> cube{3, 3, 3};
  DartBlock block(volume, lattice, 1);
  const GroupBits some = 0x8000'0000'1000'0011;
  std::vector<Vec3> found;
  block.open(cube);
  block.fill(4, {.likely = some & 0xff, .possible = some & ~GroupBits{0xff}}, found);
  ASSERT_GE(found.size(), 4u);
  for (const Vec3& p : found) EXPECT_TRUE(group_of(lattice, cube, p) & some);
}

TEST(DartBlock, DrawsFromItsSeedAlone) {
  const GraphVolume volume = ball(9);
  const DartLattice lattice(volume.bounds(), 0.5);
  DartBlock one(volume, lattice, 1), used(volume, lattice, 1);
  std::vector<Vec3> first, second, other;
  used.open({4, 3, 3});
  used.fill(8, {.likely = kAllGroups}, other);
  one.open({3, 3, 3});
  one.fill(4, {.likely = kAllGroups}, first);
  used.open({3, 3, 3});
  used.fill(4, {.likely = kAllGroups}, second);
  EXPECT_EQ(first, second);
  EXPECT_NE(first, other);
}

}  // namespace
}  // namespace cambium
