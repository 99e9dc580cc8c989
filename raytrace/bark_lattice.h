// Columns around a branch and rows along it, over which one bark pattern is drawn. Private to raytrace/.
#pragma once

#include "raytrace/bark_noise.h"
#include "raytrace/bark_number.h"

#include <cstdint>

namespace cambium {

/// A place in the lattice, with what it takes to draw there. Layers are told apart by a number that joins the seed.
template <BarkNumber N>
struct BarkLattice {
  N x, y;                      ///< in columns and rows
  double width = 1;            ///< metres per column
  double elongation = 1;       ///< metres per row over metres per column
  std::uint32_t columns = 1;   ///< once around
  std::uint32_t seed = 0;
  double footprint = 0;        ///< metres

  /// How much of a detail of this size, in columns, is left under a pixel: 1 all, 0 nothing but its mean.
  double kept(double size) const { return 1 - smooth(0.25, 1.0, footprint / (size * width)); }

  /// Noise of `across` periods per column and `along` per row.
  N noise(std::uint32_t across, double along, std::uint32_t layer) const {
    return cambium::noise(double(across) * x, along * y, across * columns, seed + layer);
  }

  /// The same of a detail of this size, as far as it is left: 0 is its mean.
  N fine_noise(double size, std::uint32_t across, double along, std::uint32_t layer) const {
    const double share = kept(size);
    return share > 0 ? share * noise(across, along, layer) : N(0.0);
  }

  struct Cell {
    N border;           ///< distance to it, in columns of the finer lattice
    double random = 0;
  };
  /// Cells at a place in a lattice that is finer by `across` and `along`.
  Cell cells(const N& px, const N& py, double jitter, std::uint32_t layer, std::uint32_t across = 1, double along = 1) const {
    const CellAt at = cell_at(value_of(px), value_of(py), across * columns, seed + 101 * (layer + 1), jitter,
                              elongation * across / along);
    return {composed(at.border.f, at.border.by_x, at.border.by_y, px, py), at.random};
  }

  /// A detail of this size and mean as far as it is left.
  N faded(const N& detail, double size, double mean) const { return mean + kept(size) * (detail - mean); }

  /// The same of small cells: once a pixel covers them, they are all far from any border and alike.
  Cell fine_cells(double size, const N& px, const N& py, double jitter, std::uint32_t layer, std::uint32_t across, double along) const {
    return kept(size) > 0 ? cells(px, py, jitter, layer, across, along) : Cell{N(1.0), 0.5};
  }

  /// Lens-shaped pores, at most one per cell of a lattice finer by `across`, with half axes in cells: 1 inside, 0 outside. `size`:
  /// of the smallest detail, in columns.
  N pores(const N& px, const N& py, double share, double half_width, double half_height, double size, std::uint32_t layer,
          std::uint32_t across = 1) const {
    // The area of a pore, of the mean of its random sizes and of its soft edge, times how many cells have one.
    const double mean = 1.49 * share * half_width * half_height;
    if (!(kept(size) > 0)) return N(mean);
    const std::int64_t cx = cell_of(value_of(px)), cy = cell_of(value_of(py));
    const auto least = [](double past, double reach) { return past < reach ? -1 : 0; };
    const auto most = [](double past, double reach) { return 1 - past < reach ? 1 : 0; };
    const double fx = value_of(px) - double(cx), fy = value_of(py) - double(cy);
    N mark(0.0);
    for (int dy = least(fy, half_height); dy <= most(fy, half_height); ++dy) {
      for (int dx = least(fx, half_width); dx <= most(fx, half_width); ++dx) {
        CellRandom random(wrapped_column(cx + dx, across * columns), cy + dy, seed + 211 * (layer + 1));
        if (random.next() > share) continue;
        const double scale = 0.45 + 0.55 * random.next();
        const double mx = double(cx + dx) + random.next(), my = double(cy + dy) + random.next();
        const N ex = (px - mx) * (1 / (half_width * scale)), ey = (py - my) * (1 / (half_height * (0.6 + 0.4 * scale)));
        mark = larger(mark, smooth(1.0, 0.45, ex * ex + ey * ey));
      }
    }
    return faded(mark, size, mean);
  }

  /// One number per layer of scales.
  double random(double which) const { return CellRandom(static_cast<std::uint32_t>(static_cast<std::int64_t>(which)), 0, seed + 307).next(); }
};

}  // namespace cambium
