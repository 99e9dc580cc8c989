// Noise and cells that close around the girth: x has an integer period, y is free. Pure functions of place and seed.
#pragma once

#include "raytrace/bark_number.h"

#include <cstdint>

namespace cambium {

/// A value at (x, y) and its derivatives in them.
struct NoiseAt {
  double f = 0, by_x = 0, by_y = 0;
};

/// Gradient noise (Perlin 2002): mean 0, mostly in [-0.7, 0.7], never beyond [-1, 1], twice differentiable.
NoiseAt noise_at(double x, double y, std::uint32_t period, std::uint32_t seed);

/// The network of borders between jittered cells (Worley 1996), columns shifted against each other so that no rows show.
struct CellAt {
  NoiseAt border;       ///< distance to the nearest border, in units of x also where it runs across
  double random = 0;    ///< of the cell, [0, 1)
};
/// jitter in [0, 1]: 0 is a grid. elongation: length of a unit of y over one of x.
CellAt cell_at(double x, double y, std::uint32_t period, std::uint32_t seed, double jitter, double elongation);

template <BarkNumber N>
N noise(const N& x, const N& y, std::uint32_t period, std::uint32_t seed) {
  const NoiseAt at = noise_at(value_of(x), value_of(y), period, seed);
  return composed(at.f, at.by_x, at.by_y, x, y);
}

/// Value noise in [0, 1].
double bark_noise(double x, double y, std::uint32_t period, std::uint64_t seed);

/// Uniform numbers of one cell of the lattice: each call another.
class CellRandom {
 public:
  CellRandom(std::uint32_t column, std::int64_t row, std::uint32_t seed);
  double next();   ///< [0, 1)

 private:
  std::uint32_t bits_;
};
/// The column of a cell, once around is `period`.
std::uint32_t wrapped_column(std::int64_t cell, std::uint32_t period);
/// Rounded down, for |x| < 2^62.
inline std::int64_t cell_of(double x) {
  const auto i = static_cast<std::int64_t>(x);
  return i - (x < static_cast<double>(i));
}

}  // namespace cambium
