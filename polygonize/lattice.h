// The sample points of a whole job: multiples of the voxel edge, anchored at the world's origin so that the same point has the
// same coordinates to the last bit in every block.
#pragma once

#include "blobtree/geometry.h"
#include "polygonize/cell_blocks.h"

#include <cstdint>

namespace cambium {

struct Lattice {
  double voxel = 0;                       ///< metres
  std::array<std::int64_t, 3> first{};    ///< global index of corner 0 of block (0, 0, 0): a multiple of kBlockCells
  int levels = 0;                         ///< the root cube has 2^levels blocks along its edge

  /// World point of a corner counted from `first`.
  Vec3 point(std::uint64_t x, std::uint64_t y, std::uint64_t z) const {
    return {voxel * static_cast<double>(first[0] + static_cast<std::int64_t>(x)),
            voxel * static_cast<double>(first[1] + static_cast<std::int64_t>(y)),
            voxel * static_cast<double>(first[2] + static_cast<std::int64_t>(z))};
  }
  /// Box of 2^level blocks cubed whose lowest block is `place`.
  Box box(const CellPlace& place, int level) const {
    const std::uint64_t n = std::uint64_t{kBlockCells} << level;
    const std::uint64_t x = std::uint64_t{place[0]} * kBlockCells, y = std::uint64_t{place[1]} * kBlockCells,
                        z = std::uint64_t{place[2]} * kBlockCells;
    return {point(x, y, z), point(x + n, y + n, z + n)};
  }
};

/// Covers `bounds` with at least a block to spare on every side. Errors: InputError if that takes more cells along an axis than
/// kCoordinateBits can count.
Lattice make_lattice(const Box& bounds, double voxel);

/// Errors: InputError, naming `what`, unless value is finite and > 0.
void require_length(double value, const char* what);

}  // namespace cambium
