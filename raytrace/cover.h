// The surface as a set of disjoint boxes with pruned fields, small enough that a ray through one is solved quickly.
#pragma once

#include "blobtree/field.h"
#include "blobtree/run_options.h"

#include <cstddef>
#include <optional>
#include <vector>

namespace cambium {

/// Lengths are in smallest active surface radii of the cell itself, so a trunk gets large cells and a twig small ones.
struct TraceCoverOptions {
  double cell_radii = 1.6;          ///< a cell's longest edge where many primitives meet
  double sparse_radii = 8;          ///< the same where at most sparse_atoms are active: a straight thin twig needs few cells
  std::size_t sparse_atoms = 4;
  std::size_t max_cells = 4000000;  ///< subdivision stops here; cells then stay larger and rays slower, never wrong
};

/// Disjoint (touching) boxes that together hold the whole surface f = kIso, in a fixed order. Every box lies inside
/// field.bounds(). nullopt if cancelled. The same for any thread count. Cost: cells x active primitives x depth.
std::optional<std::vector<PrunedField>> cover_for_tracing(const Field& field, const TraceCoverOptions& options, const RunOptions& run);

/// Boxes that hold the surface more tightly than the cells' own, for framing: each cell is cut into equal parts, finer the fewer
/// cells there are, and parts without surface are left out. In the cells' order. Cost: at most about 200,000 intervals.
std::vector<Box> surface_boxes(const std::vector<PrunedField>& cells);

}  // namespace cambium
