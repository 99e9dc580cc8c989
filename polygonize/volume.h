// Field to OpenVDB grids.
#pragma once

#include "blobtree/field.h"
#include "blobtree/run_options.h"

#include <filesystem>
#include <optional>
#include <string_view>

namespace cambium {

enum class VolumeKind { kField, kSdf, kFog };

struct VolumeOptions {
  double voxel = 0.005;                  ///< metres
  VolumeKind kind = VolumeKind::kSdf;
  double half_width = 3;                 ///< narrow band, voxels each side (sdf, fog); beyond 4 by OpenVDB's sweeping
};

struct VolumeReport {
  std::size_t active_voxels = 0;
  double voxel = 0;
};

/// Writes one float grid named "field" (f itself, background 0), "surface" (level set, negative inside, metres; 0 within a voxel of
/// the surface and it of that, but where walls and gaps are thinner than voxels) or "density" (fog volume) to exactly `path`.
/// nullopt if cancelled (nothing is left). Errors: InputError for bad sizes, std::runtime_error naming the path when writing fails.
/// Memory: proportional to the leaves. OpenVDB's writing does not poll.
std::optional<VolumeReport> write_volume(const Field& field, const VolumeOptions& options, const std::filesystem::path& path,
                                         const RunOptions& run);

}  // namespace cambium
