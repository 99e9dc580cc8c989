#include "polygonize/lattice.h"

#include "blobtree/input_error.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>

namespace cambium {

Lattice make_lattice(const Box& bounds, double voxel) {
  const double block = voxel * kBlockCells;   // exact, so blocks begin at multiples of the voxel
  const double most = static_cast<double>(std::uint64_t{1} << (kCoordinateBits - kBlockBits));
  for (int a = 0; a < 3; ++a) {
    const double across = bounds.hi[a] - bounds.lo[a];
    // Far from the origin doubles must still tell neighbouring corners apart.
    const bool countable = std::max(std::abs(bounds.lo[a]), std::abs(bounds.hi[a])) / block + 2 < 1e12;
    if (!(across / block + 4 <= most) || !countable) {
      throw InputError({}, fmt::format("a voxel of {:g} m for a model {:g} m across", voxel, across),
                       fmt::format("a voxel that divides it into fewer than {} cells", 1 << kCoordinateBits));
    }
  }
  return {voxel, cell_grid(bounds, block)};
}

void require_length(double value, const char* what) {
  if (!(value > 0) || !std::isfinite(value)) {
    throw InputError({}, fmt::format("a {} of {:g} m", what, value), "a finite length above 0");
  }
}

}  // namespace cambium
