// Samples of a field at the voxels of a volume, where it has support. Knows nothing of OpenVDB.
#pragma once

#include "blobtree/field.h"
#include "blobtree/run_options.h"
#include "polygonize/lattice.h"

#include <array>
#include <cstdint>
#include <memory>
#include <optional>
#include <vector>

namespace cambium {

/// 8 x 8 x 8 voxels; voxel (x, y, z) of the block is values[64 x + 8 y + z].
struct FieldBlock {
  std::array<std::int32_t, 3> first{};   ///< index of voxel (0, 0, 0); world = voxel size times index
  std::array<float, 512> values{};
};

/// The field in every block where it can be above 0, in a fixed order. nullopt if cancelled. Errors: InputError for a voxel size
/// too fine to index. Memory: proportional to the volume of the support.
std::optional<std::vector<std::unique_ptr<FieldBlock>>> sample_field(const Field& field, double voxel, const RunOptions& run);

/// A lattice whose voxels can be counted by OpenVDB. Errors: InputError for a voxel too fine, or too far from the origin, for that.
Lattice make_indexed_lattice(const Box& bounds, double voxel);

}  // namespace cambium
