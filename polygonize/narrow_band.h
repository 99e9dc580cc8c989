// Signed distances at the voxels near the surface, leaf by leaf. Knows nothing of OpenVDB.
#pragma once

#include "blobtree/field.h"
#include "blobtree/run_options.h"

#include <array>
#include <bitset>
#include <cstdint>
#include <memory>
#include <optional>
#include <vector>

namespace cambium {

/// How far from the surface narrow_band measures, in voxels.
inline constexpr double kMostBandVoxels = 4;

/// 8 x 8 x 8 voxels; voxel (x, y, z) is number 64 x + 8 y + z.
struct BandLeaf {
  std::array<std::int32_t, 3> first{};    ///< index of voxel (0, 0, 0); world = voxel size times index
  std::array<float, 512> distances{};     ///< metres, negative inside; plus or minus the band's width where not active
  std::bitset<512> active;                ///< nearer than that
};

/// Every leaf with an active voxel, in a fixed order; half_width in voxels, at most kMostBandVoxels. A distance is that to the
/// nearest point of {f = kIso}: from the nearest of many points of the surface by closest-point steps (x onto the plane
/// f + grad f (x - q) = kIso), so it is right beside creases too. To a tenth of a voxel next to the surface, a quarter at
/// the band's rim beside edges; in crevices narrower than a voxel, as contacts close up to, up to half a voxel too long.
/// nullopt if cancelled. Errors: InputError for a voxel size too fine to index. Memory and cost: proportional to the leaves.
std::optional<std::vector<std::unique_ptr<BandLeaf>>> narrow_band(const Field& field, double voxel, double half_width,
                                                                  const RunOptions& run);

}  // namespace cambium
