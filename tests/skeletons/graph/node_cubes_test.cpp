#include "skeletons/graph/node_cubes.h"

#include "blobtree/input_error.h"
#include "tests/skeletons/graph/node_clouds.h"

#include <gtest/gtest.h>

namespace cambium {
namespace {

using namespace testing;

TEST(NodePool, HandsOutPlacesThatDoNotOverlap) {
  NodePool pool;
  std::vector<std::span<Vec3>> taken;
  for (const std::size_t count : {0u, 1u, 300u, 700u, 5u, 100000u, 3u, 70000u, 200u}) {
    taken.push_back(pool.take(count));
    ASSERT_EQ(taken.back().size(), count);
    for (Vec3& p : taken.back()) p = Vec3(double(taken.size()));
  }
  for (std::size_t i = 0; i < taken.size(); ++i)
    for (const Vec3& p : taken[i]) ASSERT_EQ(p, Vec3(double(i + 1)));
}

TEST(NodeCubes, AddNodesThatFollowEachOtherClosely) {
  const GraphVolume volume = ball(1);
  const VolumeProbe probe(volume, 4096);
  const DartLattice lattice(volume.bounds(), 0.04);
  const RunOptions run = threads(1);
  NodeCubes cubes(volume, probe, lattice, {}, run);
  ASSERT_TRUE(cubes.fill(1, 0));
  const std::vector<Vec3> nodes = cubes.added();
  ASSERT_GT(nodes.size(), 30000u);
  double way = 0;
  for (std::size_t i = 1; i < nodes.size(); ++i) way += glm::length(nodes[i] - nodes[i - 1]) / static_cast<double>(nodes.size() - 1);
  EXPECT_LT(way, 1.1 * lattice.cube_side());
}

TEST(NodeCubes, KeepClearOfWhatIsThereInsideAndOutsideTheBoundsAndDoNotAddIt) {
  const GraphVolume volume = ball(1);
  const VolumeProbe probe(volume, 4096);
  const DartLattice lattice(volume.bounds(), 0.1);
  std::vector<Vec3> all = random_places(500, 3);   // around the ball's surface and far from it
  for (Vec3& p : all) p = volume.bounds().lo - 0.5 + p * 3.0;
  const std::size_t there = all.size();
  const RunOptions run = threads(1);
  NodeCubes cubes(volume, probe, lattice, all, run);
  ASSERT_TRUE(cubes.fill(1, 1));
  const std::vector<Vec3> added = cubes.added();
  ASSERT_GT(added.size(), 1000u);
  all.insert(all.end(), added.begin(), added.end());
  EXPECT_GE(least_distance(all, 0.3, there), 0.1);
}

TEST(NodeCubes, TooManyForTheirBoundsAreRefused) {
  const GraphVolume volume = ball(1);
  const VolumeProbe probe(volume, 1024);
  const DartLattice lattice(volume.bounds(), 1e-5);
  EXPECT_THROW(NodeCubes(volume, probe, lattice, {}, {}), InputError);
}

}  // namespace
}  // namespace cambium
