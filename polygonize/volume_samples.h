// Samples of a field at the voxels of a volume, only where it has support or a surface. Knows nothing of OpenVDB.
#pragma once

#include "blobtree/field.h"
#include "blobtree/run_options.h"

#include <array>
#include <cstdint>
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
std::optional<std::vector<FieldBlock>> sample_field(const Field& field, double voxel, const RunOptions& run);

struct NearVoxel {
  std::array<std::int32_t, 3> index{};
  float distance = 0;                    ///< metres, negative inside: (c - f) / |grad f|, at most two voxels
};

/// Every corner of every cell that holds the surface; some more than once. nullopt if cancelled. Errors: as above. Memory:
/// proportional to the surface.
std::optional<std::vector<NearVoxel>> sample_near_surface(const Field& field, double voxel, const RunOptions& run);

}  // namespace cambium
