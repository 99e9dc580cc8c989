// Points of the surface, dense enough that every part of it has one near by, however thin it is.
#pragma once

#include "blobtree/field.h"
#include "blobtree/run_options.h"
#include "polygonize/lattice.h"

#include <cstdint>
#include <optional>
#include <vector>

namespace cambium {

/// On the surface to a twentieth of a voxel.
struct SurfacePoint {
  std::uint64_t block = 0;      ///< morton_key of the lattice's block that it is in
  glm::vec3 at{0.0f};           ///< from the block's low corner, in voxels
  glm::vec3 normal{0.0f};       ///< unit, outward
};

/// One or two to a square voxel, or where branches are thinner, to the square of their radius. Ascending by block.
/// nullopt if cancelled. The same at any thread count. Cost and memory: proportional to the points.
std::optional<std::vector<SurfacePoint>> surface_points(const Field& field, const Lattice& lattice, const RunOptions& run);

}  // namespace cambium
