#include "blobtree/cell_grid.h"

#include "blobtree/input_error.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>

namespace cambium {
namespace {

std::uint64_t spread(std::uint64_t v) {  // bit k to bit 3 k
  v = (v | v << 32) & 0x1f00000000ffffu;
  v = (v | v << 16) & 0x1f0000ff0000ffu;
  v = (v | v << 8) & 0x100f00f00f00f00fu;
  v = (v | v << 4) & 0x10c30c30c30c30c3u;
  return (v | v << 2) & 0x1249249249249249u;
}

}  // namespace

CellGrid cell_grid(const Box& bounds, double cell) {
  if (!(cell > 0) || !std::isfinite(cell)) throw InputError({}, fmt::format("cells of {:g} m", cell), "a finite length above 0");
  CellGrid grid;
  grid.cell = cell;
  double needed = 1;
  for (int a = 0; a < 3; ++a) {
    const double low = std::floor(bounds.lo[a] / cell) - 1, high = std::floor(bounds.hi[a] / cell) + 2;
    const bool countable = std::max(std::abs(low), std::abs(high)) < 1e12;
    if (!(high - low <= static_cast<double>(1 << kMostLevels)) || !countable) {
      throw InputError({}, fmt::format("cells of {:g} m for a model {:g} m across", cell, bounds.hi[a] - bounds.lo[a]),
                       fmt::format("fewer than {} cells along an axis", 1 << kMostLevels));
    }
    grid.first[a] = static_cast<std::int64_t>(low);
    needed = std::max(needed, high - low);
  }
  while (static_cast<double>(std::uint64_t{1} << grid.levels) < needed) ++grid.levels;
  return grid;
}

std::optional<CellPlace> CellGrid::place_of(const Vec3& p) const {
  CellPlace place;
  for (int a = 0; a < 3; ++a) {
    double low = std::floor(p[a] / cell);
    if (p[a] < cell * low) --low;        // the quotient was rounded over a corner
    if (p[a] >= cell * (low + 1)) ++low;
    const double at = low - static_cast<double>(first[a]);
    if (!(at >= 0 && at < static_cast<double>(std::uint64_t{1} << levels))) return std::nullopt;
    place[a] = static_cast<std::uint32_t>(at);
  }
  return place;
}

std::uint64_t morton_key(const CellPlace& place) { return spread(place[0]) | spread(place[1]) << 1 | spread(place[2]) << 2; }

}  // namespace cambium
