// Connected pieces of a closed mesh, and the removal of cavities and crumbs too small for its cells to show.
#pragma once

#include "blobtree/run_options.h"
#include "polygonize/mesh.h"

#include <cstddef>
#include <optional>
#include <vector>

namespace cambium {

struct ComponentReport {
  std::size_t components = 0;      ///< that remain
  std::size_t closed_voids = 0;    ///< that were removed
  std::size_t crumbs = 0;          ///< likewise
  std::vector<Vec3> removed;       ///< the vertices of both
};

/// Removes every component that encloses a void (negative volume) whose mean thickness, twice its volume over its area, is below
/// `thickness` metres: where two branches meet in a crevice narrower than a cell, lone outside corners between them would
/// leave bubbles in the wood. And every one around wood of less area than a sphere of diameter `crumb` (metres): lone inside corners
/// between them. What remains keeps its order. nullopt, with the mesh left as it was, if cancelled. Cost: about linear in triangles.
std::optional<ComponentReport> drop_small_components(Mesh& mesh, double thickness, double crumb, const RunOptions& run);

}  // namespace cambium
