// Cubes of one size in rows, anchored at the world's origin, and the octree over them: the places of a subdivision of space.
#pragma once

#include "blobtree/geometry.h"

#include <array>
#include <cstdint>
#include <optional>

namespace cambium {

inline constexpr int kMostLevels = 21;   ///< of an octree: three coordinates share 64 bits

/// Of a cube, counted in cells of level 0 from the grid's low corner.
using CellPlace = std::array<std::uint32_t, 3>;

struct CellGrid {
  double cell = 0;                        ///< metres, edge of a level-0 cell
  std::array<std::int64_t, 3> first{};    ///< the low corner of cell (0, 0, 0) is cell * first
  int levels = 0;                         ///< the root cube has 2^levels cells along its edge

  /// The low corner of a level-0 cell, metres.
  Vec3 corner(const CellPlace& place) const {
    Vec3 p;
    for (int a = 0; a < 3; ++a) p[a] = cell * static_cast<double>(first[a] + static_cast<std::int64_t>(place[a]));
    return p;
  }
  /// The cube of 2^level cells along its edge whose lowest cell is `place`. Neighbours share corners to the last bit.
  Box box(const CellPlace& place, int level) const {
    Box b;
    for (int a = 0; a < 3; ++a) {
      const std::int64_t low = first[a] + static_cast<std::int64_t>(place[a]);
      b.lo[a] = cell * static_cast<double>(low);
      b.hi[a] = cell * static_cast<double>(low + (std::int64_t{1} << level));
    }
    return b;
  }

  /// The level-0 cell that holds p, low faces included and high ones not; none outside the root cube, or if p is not finite.
  std::optional<CellPlace> place_of(const Vec3& p) const;
};

/// The smallest grid that covers `bounds` with at least a cell to spare on every side. Errors: InputError if that takes more
/// than 2^kMostLevels cells along an axis, or cells that doubles cannot tell apart so far from the origin.
CellGrid cell_grid(const Box& bounds, double cell);

/// Morton order: ascending keys visit the octree depth first.
std::uint64_t morton_key(const CellPlace& place);

}  // namespace cambium
