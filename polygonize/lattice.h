// The sample points of a whole job: multiples of the voxel edge, anchored at the world's origin so that the same point has the
// same coordinates to the last bit in every block.
#pragma once

#include "blobtree/cell_grid.h"

#include <cstdint>

namespace cambium {

inline constexpr int kBlockBits = 3;
inline constexpr int kBlockCells = 1 << kBlockBits;             ///< voxels along a block's edge
inline constexpr int kCoordinateBits = 21;                      ///< of a voxel, per axis

struct Lattice {
  double voxel = 0;      ///< metres
  CellGrid blocks;       ///< its level-0 cells are blocks of kBlockCells voxels along their edge

  /// Global index of corner 0 of block (0, 0, 0): a multiple of kBlockCells.
  std::int64_t first(int axis) const { return blocks.first[axis] * kBlockCells; }
  /// World point of a corner counted from `first`.
  Vec3 point(std::uint64_t x, std::uint64_t y, std::uint64_t z) const {
    return {voxel * static_cast<double>(first(0) + static_cast<std::int64_t>(x)),
            voxel * static_cast<double>(first(1) + static_cast<std::int64_t>(y)),
            voxel * static_cast<double>(first(2) + static_cast<std::int64_t>(z))};
  }
  /// Its corners are points of the lattice, to the last bit.
  Box box(const CellPlace& block) const { return blocks.box(block, 0); }
};

/// Covers `bounds` with at least a block to spare on every side. Errors: InputError if that takes more cells along an axis than
/// kCoordinateBits can count.
Lattice make_lattice(const Box& bounds, double voxel);

/// Errors: InputError, naming `what`, unless value is finite and > 0.
void require_length(double value, const char* what);

}  // namespace cambium
