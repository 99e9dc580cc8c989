// The sparse grid of cells that hold the surface, and the mesh connectivity that their corner signs imply. Pure integers: it
// knows neither field nor coordinates, so any sign grid at all may be put through it.
#pragma once

#include "blobtree/cell_grid.h"
#include "polygonize/cell_cycles.h"

#include <array>
#include <bit>
#include <cstdint>
#include <vector>

namespace cambium {

inline constexpr int kBlockBits = 3;
inline constexpr int kBlockCells = 1 << kBlockBits;             ///< cells along a block's edge
inline constexpr int kCoordinateBits = 21;                      ///< of a cell, per axis

/// 8 x 8 x 8 cells. Cell (x, y, z) is bit x + 8 y of occupied[z]; masks are in that order.
struct CellBlock {
  CellPlace place{};                              ///< in blocks
  std::array<std::uint64_t, 8> occupied{};
  std::array<std::uint16_t, 8> before{};          ///< cells in the layers below
  std::vector<std::uint8_t> masks;

  /// Sets occupied; cells must come in order.
  void append(int x, int y, int z, std::uint8_t mask) {
    occupied[z] |= std::uint64_t{1} << (x + 8 * y);
    masks.push_back(mask);
    for (int above = z + 1; above < 8; ++above) ++before[above];
  }
  /// Position in masks, or -1 if the surface misses that cell.
  int find(int x, int y, int z) const {
    const std::uint64_t bit = std::uint64_t{1} << (x + 8 * y);
    if (!(occupied[z] & bit)) return -1;
    return before[z] + std::popcount(occupied[z] & (bit - 1));
  }
  /// Calls visit(index, x, y, z) for each cell in order.
  template <class Visit>
  void for_each(Visit&& visit) const {
    int index = 0;
    for (int z = 0; z < 8; ++z)
      for (std::uint64_t bits = occupied[z]; bits; bits &= bits - 1) {
        const int at = std::countr_zero(bits);
        visit(index++, at & 7, at >> 3, z);
      }
  }
};

/// Four vertices around one crossed grid edge, counter-clockwise seen from outside.
using Quad = std::array<std::uint32_t, 4>;

/// Vertex numbers and quads. Every vertex has one fan of quads and every mesh edge two quads, whatever the signs are.
/// Errors: std::logic_error if a crossed edge lacks one of its four cells (the caller lost a cell).
/// Thread safe after construction.
class CellConnectivity {
 public:
  /// blocks: ascending by morton_key, kept alive by the caller. threads as in the current arena.
  explicit CellConnectivity(const std::vector<const CellBlock*>& blocks);

  std::uint32_t vertex_count() const { return vertex_count_; }
  std::size_t cell_count() const { return cell_count_; }
  std::size_t flipped_faces() const { return flipped_faces_; }
  /// Face of a cell whose rule is flipped, or kNoFace.
  int flipped_face(std::size_t block, std::size_t cell) const { return blocks_[block].flipped_face[cell]; }
  /// Number of the vertex of the cell's cycle 0; its other cycles follow.
  std::uint32_t first_vertex(std::size_t block, std::size_t cell) const { return blocks_[block].first_vertex[cell]; }
  std::size_t quad_count(std::size_t block) const;
  /// Quads of the crossed edges that start in this block (a cell owns the three edges at its corner 0). Clears `out`.
  void quads(std::size_t block, std::vector<Quad>& out) const;

 private:
  struct Numbering {
    std::vector<std::uint8_t> flipped_face;
    std::vector<std::uint32_t> first_vertex;
  };
  class Neighbourhood;

  const std::vector<const CellBlock*>& cells_;
  std::vector<std::uint64_t> keys_;
  std::vector<Numbering> blocks_;
  std::uint32_t vertex_count_ = 0;
  std::size_t cell_count_ = 0;
  std::size_t flipped_faces_ = 0;
};

}  // namespace cambium
