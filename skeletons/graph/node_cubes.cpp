#include "skeletons/graph/node_cubes.h"

#include "blobtree/input_error.h"
#include "blobtree/place_hash.h"
#include "skeletons/graph/node_chunks.h"

#include <algorithm>
#include <bit>
#include <cmath>
#include <numeric>
#include <string>
#include <utility>

namespace cambium {
namespace {

constexpr double kMostCubes = 2.5e8;          // a gigabyte for their numbers
constexpr std::size_t kSerialCubes = 64;     // not more: threads would cost more than they save
constexpr std::size_t kLargestPiece = 65536; // nodes

/// The bits of v with two zeros between each.
std::uint64_t spread_bits(std::uint64_t v) {
  v = (v | v << 32) & 0x1f00000000ffffull;
  v = (v | v << 16) & 0x1f0000ff0000ffull;
  v = (v | v << 8) & 0x100f00f00f00f00full;
  v = (v | v << 4) & 0x10c30c30c30c30c3ull;
  return (v | v << 2) & 0x1249249249249249ull;
}

std::uint64_t morton(const std::array<int, 3>& c) {
  return spread_bits(std::uint64_t(c[0])) | spread_bits(std::uint64_t(c[1])) << 1 | spread_bits(std::uint64_t(c[2])) << 2;
}

}  // namespace

std::span<Vec3> NodePool::take(std::size_t count) {
  const std::lock_guard lock(mutex_);
  if (left_ < count) {
    piece_size_ = std::min(2 * piece_size_, kLargestPiece);
    left_ = std::max(piece_size_, count);
    pieces_.push_back(std::make_unique_for_overwrite<Vec3[]>(left_));
    piece_end_ = pieces_.back().get() + left_;
  }
  const std::span<Vec3> taken(piece_end_ - left_, count);
  left_ -= count;
  return taken;
}

NodeCubes::NodeCubes(const GraphVolume& volume, const VolumeProbe& probe, const DartLattice& lattice, std::span<const Vec3> there,
                     const RunOptions& run)
    : volume_(volume), probe_(probe), lattice_(lattice), run_(run) {
  const Vec3 size = lattice.hi - lattice.lo;
  double cubes = 1;
  for (int k = 0; k < 3; ++k) cubes *= size_[std::size_t(k)] = static_cast<int>(std::min(size[k] / lattice.cube_side(), kMostCubes)) + 1;
  if (cubes > kMostCubes)
    throw InputError({}, "spacing = " + std::to_string(lattice.spacing), "a larger one, for a volume of that size");
  find_cubes();
  put_in(there);
}

void NodeCubes::find_cubes() {
  std::vector<std::pair<std::uint64_t, Cube>> found;
  for (int z = 0; z < size_[2] && !run_.cancelled(); ++z)
    for (int y = 0; y < size_[1]; ++y)
      for (int x = 0; x < size_[0]; ++x) {
        const Vec3 corner = lattice_.corner({x, y, z});
        if (probe_.may_hold({corner, corner + lattice_.cube_side()})) found.push_back({morton({x, y, z}), {x, y, z}});
      }
  std::sort(found.begin(), found.end());
  number_.assign(std::size_t(size_[0]) * std::size_t(size_[1]) * std::size_t(size_[2]), kNone);
  cubes_.reserve(found.size());
  for (const auto& [code, cube] : found) {
    number_[index(cube)] = static_cast<std::uint32_t>(cubes_.size());
    cubes_.push_back({.at = cube, .is_open = true});
  }
}

/// What is beyond the cubes counts to the nearest.
NodeCubes::Cube NodeCubes::cube_of(const Vec3& p) const {
  Cube cube;
  for (int k = 0; k < 3; ++k)
    cube[std::size_t(k)] = static_cast<int>(std::clamp(std::floor((p[k] - lattice_.lo[k]) / lattice_.cube_side()), 0.0, size_[std::size_t(k)] - 1.0));
  return cube;
}

std::uint32_t NodeCubes::number_of(const Cube& cube) {
  std::uint32_t& number = number_[index(cube)];
  if (number == kNone) {
    number = static_cast<std::uint32_t>(cubes_.size());
    cubes_.push_back({.at = cube, .is_open = false});
  }
  return number;
}

void NodeCubes::put_in(std::span<const Vec3> there) {
  std::vector<std::pair<std::uint32_t, std::uint32_t>> by_cube(there.size());   // (cube, node)
  for (std::uint32_t i = 0; i < there.size(); ++i) by_cube[i] = {number_of(cube_of(there[i])), i};
  std::sort(by_cube.begin(), by_cube.end());
  const std::span<Vec3> nodes = pool_.take(there.size());
  for (std::size_t begin = 0, end = 0; begin < by_cube.size(); begin = end) {
    const std::uint32_t cube = by_cube[begin].first;
    for (; end < by_cube.size() && by_cube[end].first == cube; ++end) nodes[end] = there[by_cube[end].second];
    cubes_[cube].there = nodes.subspan(begin, end - begin);
  }
}

std::size_t NodeCubes::grain() const { return cubes_.size() <= kSerialCubes ? kSerialCubes : 8; }

bool NodeCubes::find_groups() {
  for (const Vec3& p : probe_.inside()) {
    Filled& cube = cubes_[number_of(cube_of(p))];
    cube.groups |= group_of(lattice_, cube.at, p);
  }
  return in_node_chunks(cubes_.size(), grain(), run_, [&](std::size_t begin, std::size_t end) {
    for (std::size_t i = begin; i < end; ++i) {
      if (!cubes_[i].is_open) continue;
      const GroupBits found = groups_inside(volume_, lattice_, cubes_[i].at);
      cubes_[i].hits = std::popcount(found);
      cubes_[i].groups |= found;
    }
  });
}

/// Every second cube along each axis: none of them can see into another.
std::vector<std::uint32_t> NodeCubes::of_phase(std::size_t phase) const {
  std::vector<std::uint32_t> cubes;
  for (std::uint32_t i = 0; i < cubes_.size(); ++i) {
    const Cube& c = cubes_[i].at;
    if (cubes_[i].is_open && std::size_t((c[0] & 1) | (c[1] & 1) << 1 | (c[2] & 1) << 2) == phase) cubes.push_back(i);
  }
  return cubes;
}

/// Of the cube and those around it, x fastest; null where there are none.
std::array<const NodeCubes::Filled*, 27> NodeCubes::around(const Cube& c) const {
  std::array<const Filled*, 27> cubes{};
  for (int i = 0; i < 27; ++i) {
    const Cube at{c[0] + i % 3 - 1, c[1] + i / 3 % 3 - 1, c[2] + i / 9 - 1};
    bool is_in = true;
    for (std::size_t k = 0; k < 3; ++k) is_in = is_in && 0 <= at[k] && at[k] < size_[k];
    if (is_in && number_[index(at)] != kNone) cubes[std::size_t(i)] = &cubes_[number_[index(at)]];
  }
  return cubes;
}

bool NodeCubes::fill(std::uint64_t seed, int halvings) {
  if (run_.cancelled() || !find_groups()) return false;
  for (std::size_t phase = 0; phase < 8; ++phase) {
    const std::vector<std::uint32_t> cubes = of_phase(phase);
    const bool finished = in_node_chunks(cubes.size(), grain(), run_, [&](std::size_t begin, std::size_t end) {
      DartBlock block(volume_, lattice_, halvings);
      std::vector<Vec3> found;
      for (std::size_t i = begin; i < end && !run_.cancelled(); ++i) fill(cubes_[cubes[i]], block, found, seed);
    });
    if (!finished) return false;
  }
  return true;
}

/// The fewer looks at groups that hold some of the volume have hit it, the thinner it is, and the more darts may miss it.
DartTargets NodeCubes::targets(const std::array<const Filled*, 27>& cubes) const {
  std::array<GroupBits, 27> groups{};
  int held = 0, hits = 0;
  for (std::size_t i = 0; i < 27; ++i) {
    if (!cubes[i]) continue;
    groups[i] = cubes[i]->groups;
    held += std::popcount(groups[i]);
    hits += cubes[i]->hits;
  }
  const GroupBits all = grown(groups), likely = groups[13];
  return {likely, all & ~likely, std::clamp(2 * held / (hits + 1), 2, 64)};
}

void NodeCubes::fill(Filled& cube, DartBlock& block, std::vector<Vec3>& found, std::uint64_t seed) {
  const std::array<const Filled*, 27> cubes = around(cube.at);
  const DartTargets where = targets(cubes);
  if ((where.likely | where.possible) == 0) return;
  block.open(cube.at);
  for (const Filled* other : cubes)
    if (other) block.add(other->there), block.add(other->added);
  found.clear();
  block.fill(hash_of(seed, morton(cube.at)), where, found);
  const std::span<Vec3> added = pool_.take(found.size());
  std::copy(found.begin(), found.end(), added.begin());
  cube.added = added;
}

std::vector<Vec3> NodeCubes::added() const {
  std::vector<Vec3> nodes;
  nodes.reserve(std::accumulate(cubes_.begin(), cubes_.end(), std::size_t{0}, [](std::size_t n, const Filled& cube) { return n + cube.added.size(); }));
  for (const Filled& cube : cubes_) nodes.insert(nodes.end(), cube.added.begin(), cube.added.end());
  return nodes;
}

}  // namespace cambium
