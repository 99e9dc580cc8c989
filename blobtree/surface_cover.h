// The surface as a set of cells, each with its pruned field, kept compactly: cells with the same primitives share one tape.
#pragma once

#include "blobtree/cell_search.h"

#include <array>
#include <cstddef>
#include <cstdint>
#include <memory>
#include <optional>
#include <vector>

namespace cambium {

struct CoverOptions {
  /// Edge of every cell, metres. Unset: cells follow the branches, by the lengths below.
  std::optional<double> cell;
  /// In smallest active surface radii of the cell itself, so a trunk gets large cells and a twig small ones: its longest
  /// edge where many primitives meet, and where at most sparse_atoms are active: a straight thin twig needs few cells.
  double cell_radii = 1.6;
  double sparse_radii = 8;
  std::size_t sparse_atoms = 4;
  /// Where a chain is active, not warped, beside something else, also no longer than this: then more cells hold one chain alone.
  double shared_radii = kInfinity;
  /// And nowhere more than sqrt(sagitta * smallest active radius), metres. Infinite: no such limit.
  double sagitta = kInfinity;
  /// Cells that follow the branches have this edge times a power of two; unset: one that divides the field's bounds.
  std::optional<double> unit;
  /// Where the lengths above would give more, they are raised for all cells: rays get slower, never wrong. With `cell` set, or
  /// where the coarsest cells are still more: an error.
  std::size_t max_cells = 60'000'000;
};

/// Immutable, shared by threads. Keeps its Field's compiled tree alive.
class SurfaceCover {
 public:
  SurfaceCover() = default;
  std::size_t size() const { return cells_.size(); }
  bool empty() const { return cells_.empty(); }
  /// The part of the cell where its primitives have support. Disjoint (touching) boxes; together they hold the whole surface
  /// f = kIso.
  Box box(std::size_t cell) const;
  /// The cell's place in the octree, whole: box(cell) is the part of it that counts. Neighbours share corners to the last bit.
  Box cube(std::size_t cell) const;
  /// The cell whose cube holds p, low faces included and high ones not; none where no cell of the cover does, and then f is not
  /// kIso. p may still be outside box(cell): there no primitive of the cell has support, and the whole field is 0.
  /// Cost: a binary search.
  std::optional<std::size_t> find(const Vec3& p) const;
  /// Of a level-0 cell of the grid. Places beyond the root cube have none.
  std::optional<std::size_t> find_place(const CellPlace& place) const;
  /// Exact inside box(cell). Valid while the cover lives. Cheap; no allocation.
  PrunedField field(std::size_t cell) const;
  /// The cube that the cell is of its grid, and a field exact in all of it.
  PrunedField cube_field(std::size_t cell) const;
  const CellGrid& grid() const { return grid_; }
  const CellPlace& place(std::size_t cell) const { return cells_[cell].place; }
  int level(std::size_t cell) const { return cells_[cell].level; }
  /// Of everything it holds, the Field not counted.
  std::size_t memory_bytes() const;
  std::size_t tape_count() const { return tape_count_; }

 private:
  friend class CoverRun;
  friend std::optional<SurfaceCover> cover_surface(const Field&, const CoverOptions&, const RunOptions&);
  struct Cell {
    const Tape* tape = nullptr;
    CellPlace place{};
    std::uint8_t level = 0;
    std::array<std::uint8_t, 6> occupied{};   ///< lo and hi of the box within the cube, in 255ths, rounded outwards
  };
  class TapeStore;
  std::shared_ptr<const CompiledTree> tree_;
  CellGrid grid_;
  std::vector<Cell> cells_;
  std::vector<std::shared_ptr<const TapeStore>> stores_;
  std::size_t tape_count_ = 0;
};

/// Cells in Morton order. nullopt if cancelled. The same at any thread count. Errors: InputError for a cell size or a
/// sagitta that is not a length, cells too fine for the field's bounds, or more than max_cells. Cost and memory: proportional to the cells.
std::optional<SurfaceCover> cover_surface(const Field& field, const CoverOptions& options, const RunOptions& run);

}  // namespace cambium
