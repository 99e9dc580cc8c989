#include "polygonize/lattice.h"

#include "blobtree/input_error.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>

namespace cambium {

Lattice make_lattice(const Box& bounds, double voxel) {
  Lattice lattice;
  lattice.voxel = voxel;
  const double block = voxel * kBlockCells;
  const double most = static_cast<double>(std::uint64_t{1} << (kCoordinateBits - kBlockBits));
  double needed = 1;
  for (int a = 0; a < 3; ++a) {
    const double low = std::floor(bounds.lo[a] / block) - 1, high = std::floor(bounds.hi[a] / block) + 2;
    // Far from the origin doubles must still tell neighbouring corners apart.
    const bool countable = std::max(std::abs(low), std::abs(high)) < 1e12;
    if (!(high - low <= most) || !countable) {
      throw InputError({}, fmt::format("a voxel of {:g} m for a model {:g} m across", voxel, bounds.hi[a] - bounds.lo[a]),
                       fmt::format("a voxel that divides it into fewer than {} cells", 1 << kCoordinateBits));
    }
    lattice.first[a] = static_cast<std::int64_t>(low) * kBlockCells;
    needed = std::max(needed, high - low);
  }
  while (static_cast<double>(std::uint64_t{1} << lattice.levels) < needed) ++lattice.levels;
  return lattice;
}

void require_length(double value, const char* what) {
  if (!(value > 0) || !std::isfinite(value)) {
    throw InputError({}, fmt::format("a {} of {:g} m", what, value), "a finite length above 0");
  }
}

}  // namespace cambium
