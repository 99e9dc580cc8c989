// Throws darts into a cube of space until hardly any more stick (after White, Cline and Egbert 2007, and Ebeida et al. 2012).
#pragma once

#include "skeletons/graph/graph_volume.h"

#include <array>
#include <cstdint>
#include <span>
#include <vector>

namespace cambium {

/// How cubes divide space for nodes not nearer to each other than `spacing`. A cube is 8 x 8 x 8 cells, a cell so small that two nodes
/// do not fit in, so that nodes nearer than `spacing` are at most two cells apart.
struct DartLattice {
  static constexpr int kCells = 8;     ///< of a cube along each side
  static constexpr int kGroups = 4;    ///< of 2 x 2 x 2 cells, likewise
  static constexpr int kReach = 2;     ///< cells

  DartLattice(const Box& bounds, double spacing);

  double cube_side() const { return kCells * cell; }
  double group_side() const { return cube_side() / kGroups; }
  Vec3 corner(const std::array<int, 3>& cube) const { return lo + cube_side() * Vec3(cube[0], cube[1], cube[2]); }

  Vec3 lo, hi;
  double spacing, cell;
};

/// Which groups of cells of a cube hold some of the volume, a bit for each, x fastest.
using GroupBits = std::uint64_t;
static_assert(DartLattice::kGroups * DartLattice::kGroups * DartLattice::kGroups == 64);

/// Looks at one place in each group.
GroupBits groups_inside(const GraphVolume& volume, const DartLattice& lattice, const std::array<int, 3>& cube);

/// The group that p, in the cube or at its surface, is in.
GroupBits group_of(const DartLattice& lattice, const std::array<int, 3>& cube, const Vec3& p);

/// The groups of a cube that are set or have a face in common with one that is; from those of the 27 cubes around it, x fastest.
GroupBits grown(const std::array<GroupBits, 27>& around);

/// What of a cube darts are thrown at.
struct DartTargets {
  GroupBits likely = 0;                ///< groups that hold some of the volume
  GroupBits possible = 0;              ///< that may: a dart fewer is thrown at each of their cells
  int misses = 2;                      ///< >= 2; so many darts are thrown at a cell where all fall beside the volume
};

/// One cube's nodes and those beside it, by cell. Made once for each thread, and used for one cube after the other.
class DartBlock {
 public:
  DartBlock(const GraphVolume& volume, const DartLattice& lattice, int halvings);

  /// Begins with another cube.
  void open(const std::array<int, 3>& cube);
  /// Nodes that are there already, in the cube or near it; others are ignored.
  void add(std::span<const Vec3> nodes);
  /// Appends the nodes that fit in besides. Draws from the stream `seed` alone.
  void fill(std::uint64_t seed, const DartTargets& targets, std::vector<Vec3>& nodes);

 private:
  static constexpr int kSide = DartLattice::kCells + 2 * DartLattice::kReach;
  static constexpr std::uint16_t kEnd = 0xffff;

  /// Part of a cell that may have room. Coordinates count from the cube's own first cell, in sizes of the part.
  struct Place {
    std::int16_t x = 0, y = 0, z = 0;
    std::uint16_t darts = 0, outside = 0;
    std::uint16_t blocker = kEnd;      // in near_, what the last dart was too near to; likely the next one is too
  };

  void find_places(const DartTargets& targets);
  void throw_at_all(int level, int darts, int misses, std::vector<Vec3>& nodes);
  bool throw_at(Place& place, int level, std::vector<Vec3>& nodes);
  void halve_all(int level);
  bool covers(std::uint16_t node, const Vec3& middle, double half_side) const;
  bool too_near(const Vec3& p, std::uint16_t node) const;
  bool has_node(int x, int y, int z) const;
  void put(int x, int y, int z, const Vec3& p);
  template <class Test>
  std::uint16_t first_near(int x, int y, int z, const Test& test) const;
  std::uint64_t draw();

  const GraphVolume& volume_;
  const DartLattice& lattice_;
  int halvings_;
  Vec3 corner_{0.0};
  std::uint64_t seed_ = 0, drawn_ = 0;
  std::array<std::uint16_t, kSide * kSide> rows_{};      // a bit for each cell along x that has nodes
  std::array<std::uint16_t, kSide * kSide * kSide> head_; // of a cell with nodes, the last of them
  std::vector<Vec3> near_;
  std::vector<std::uint16_t> before_;                    // of near_, the one before it in its cell
  std::vector<Place> places_, halves_;
  std::vector<std::uint16_t> over_middle_;               // scratch of halve_all: nodes whose balls hold a place's middle
};

}  // namespace cambium
