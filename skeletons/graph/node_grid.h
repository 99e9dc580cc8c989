// Nodes by the cube of space that they are in: what is near a node is found in the cubes around its own.
#pragma once

#include "blobtree/geometry.h"

#include <array>
#include <cstdint>
#include <span>
#include <vector>

namespace cambium {

/// Immutable, used by threads at once. Memory: 4 bytes a node and 4 a cell; there are at most about four times as many cells as nodes.
class NodeGrid {
 public:
  using Cell = std::array<int, 3>;
  static constexpr double kFewest = 1.3;

  /// Cells of `side` metres, or of twice, four times ... as much until cells with nodes in them hold kFewest on average, and cells are
  /// not many more than four times the nodes.
  NodeGrid(std::span<const Vec3> positions, double side);

  double side() const { return side_; }
  /// The least distance between as many nodes, were they strewn by poisson_disc in the cells that nodes are in.
  double natural_spacing() const;

  Cell cell_of(const Vec3& p) const {
    Cell cell;
    for (int k = 0; k < 3; ++k) cell[k] = std::min(static_cast<int>((p[k] - lo_[k]) * per_metre_), size_[k] - 1);
    return cell;
  }
  /// Metres from p, in `cell`, to the slab of cells that is that many away along an axis.
  double distance_to(const Vec3& p, const Cell& cell, std::size_t axis, int away) const {
    if (away == 0) return 0;
    const double below = p[int(axis)] - (lo_[int(axis)] + side_ * cell[axis]);
    return away > 0 ? away * side_ - below : below - (away + 1) * side_;
  }
  /// Metres from p, in `cell`, to what is beyond the cells around it that are `rings` away; kInfinity if that is all of them.
  double clearance(const Vec3& p, const Cell& cell, int rings) const;

  /// Calls visit(node) for the nodes in the cells that are `ring` cells away, the cell itself in ring 0; in no particular order. Leaves
  /// out rows of cells along x where skips(dy, dz) is true; they are so many cells away from the cell's own row.
  template <class Skips, class Visit>
  void visit_ring(const Cell& cell, int ring, const Skips& skips, Visit&& visit) const {
    for (int z = std::max(cell[2] - ring, 0); z <= std::min(cell[2] + ring, size_[2] - 1); ++z)
      for (int y = std::max(cell[1] - ring, 0); y <= std::min(cell[1] + ring, size_[1] - 1); ++y) {
        if (skips(y - cell[1], z - cell[2])) continue;
        const bool whole_row = std::abs(z - cell[2]) == ring || std::abs(y - cell[1]) == ring;
        if (whole_row) {
          visit_row(cell[0] - ring, cell[0] + ring, y, z, visit);
        } else {
          visit_row(cell[0] - ring, cell[0] - ring, y, z, visit);
          visit_row(cell[0] + ring, cell[0] + ring, y, z, visit);
        }
      }
  }

 private:
  void choose_side(const Box& box, std::size_t nodes, double side);
  std::size_t index(const Cell& cell) const {
    return (std::size_t(cell[2]) * std::size_t(size_[1]) + std::size_t(cell[1])) * std::size_t(size_[0]) + std::size_t(cell[0]);
  }
  template <class Visit>
  void visit_row(int x0, int x1, int y, int z, Visit& visit) const {
    x0 = std::max(x0, 0), x1 = std::min(x1, size_[0] - 1);
    if (x0 > x1) return;
    const std::size_t row = index({0, y, z});
    for (std::uint32_t i = first_[row + std::size_t(x0)]; i < first_[row + std::size_t(x1) + 1]; ++i) visit(nodes_[i]);
  }

  Vec3 lo_{0.0};
  double side_ = 1, per_metre_ = 1;
  Cell size_{1, 1, 1};
  std::size_t filled_ = 0;             // cells with nodes in them
  std::vector<std::uint32_t> first_;   // of each cell, x fastest
  std::vector<std::uint32_t> nodes_;   // ascending in each cell
};

}  // namespace cambium
