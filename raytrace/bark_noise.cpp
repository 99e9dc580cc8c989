#include "raytrace/bark_noise.h"

#include "blobtree/place_hash.h"

#include <array>
#include <limits>

namespace cambium {
namespace {

/// Mixes well enough for pictures at a fraction of the cost of 64 bits (constants: Wellons, "Prospecting for hash functions").
std::uint32_t mixed_bits(std::uint32_t x) {
  x ^= x >> 16;
  x *= 0x7feb352du;
  x ^= x >> 15;
  x *= 0x846ca68bu;
  x ^= x >> 16;
  return x;
}
std::uint32_t lattice_bits(std::uint32_t column, std::int64_t row, std::uint32_t seed) {
  return mixed_bits((column + 1) * 0x9e3779b1u ^ static_cast<std::uint32_t>(row) * 0x85ebca77u ^ seed * 0xc2b2ae3du);
}

double signed_unit(std::uint32_t low_16_bits) { return (low_16_bits & 0xffffu) * (2.0 / 65535) - 1; }

}  // namespace

std::uint32_t wrapped_column(std::int64_t cell, std::uint32_t period) {
  if (static_cast<std::uint64_t>(cell) < period) return static_cast<std::uint32_t>(cell);   // mostly: a division takes as long as a corner's noise
  const std::int64_t column = cell % static_cast<std::int64_t>(period);
  return static_cast<std::uint32_t>(column < 0 ? column + period : column);
}

CellRandom::CellRandom(std::uint32_t column, std::int64_t row, std::uint32_t seed) : bits_(lattice_bits(column, row, seed)) {}

double CellRandom::next() {
  const double number = bits_ * 0x1p-32;
  bits_ = mixed_bits(bits_ + 0x9e3779b9u);
  return number;
}

NoiseAt noise_at(double x, double y, std::uint32_t period, std::uint32_t seed) {
  const std::int64_t cx = cell_of(x), cy = cell_of(y);
  const double fx = x - static_cast<double>(cx), fy = y - static_cast<double>(cy);
  const std::uint32_t left = wrapped_column(cx, period), right = left + 1 < period ? left + 1 : 0;
  struct Corner {
    double f, gx, gy;
  };
  const auto corner = [&](std::uint32_t column, std::int64_t row, double dx, double dy) -> Corner {
    const std::uint32_t bits = lattice_bits(column, row, seed);
    const double gx = signed_unit(bits), gy = signed_unit(bits >> 16);
    return {gx * dx + gy * dy, gx, gy};
  };
  const Corner a = corner(left, cy, fx, fy), b = corner(right, cy, fx - 1, fy);
  const Corner c = corner(left, cy + 1, fx, fy - 1), d = corner(right, cy + 1, fx - 1, fy - 1);
  const double sx = fx * fx * fx * (fx * (6 * fx - 15) + 10), sy = fy * fy * fy * (fy * (6 * fy - 15) + 10);
  const double tx = 30 * fx * fx * (fx * (fx - 2) + 1), ty = 30 * fy * fy * (fy * (fy - 2) + 1);
  const double cross = a.f - b.f - c.f + d.f;
  const double across_x = (b.f - a.f) + sy * cross, across_y = (c.f - a.f) + sx * cross;
  const auto weighted = [&](double pa, double pb, double pc, double pd) {
    return (1 - sy) * ((1 - sx) * pa + sx * pb) + sy * ((1 - sx) * pc + sx * pd);
  };
  return {weighted(a.f, b.f, c.f, d.f), weighted(a.gx, b.gx, c.gx, d.gx) + tx * across_x,
          weighted(a.gy, b.gy, c.gy, d.gy) + ty * across_y};
}

CellAt cell_at(double x, double y, std::uint32_t period, std::uint32_t seed, double jitter, double elongation) {
  struct Point {
    double dx, dy, d2;
    std::uint32_t bits;
  };
  std::array<Point, 9> points;
  const std::int64_t cx = cell_of(x);
  const double fx = x - static_cast<double>(cx);
  std::size_t nearest = 0, n = 0;
  for (int i = -1; i <= 1; ++i) {
    const std::uint32_t column = wrapped_column(cx + i, period);
    const double shifted = y + lattice_bits(column, 0, seed ^ 0x51ed270bu) * 0x1p-32;
    const std::int64_t cy = cell_of(shifted);
    const double fy = shifted - static_cast<double>(cy);
    for (int j = -1; j <= 1; ++j, ++n) {
      const std::uint32_t bits = lattice_bits(column, cy + j, seed);
      const double dx = fx - (i + 0.5 + 0.5 * jitter * signed_unit(bits));
      const double dy = fy - (j + 0.5 + 0.5 * jitter * signed_unit(bits >> 16));
      points[n] = {dx, dy, dx * dx + dy * dy, bits};
      if (points[n].d2 < points[nearest].d2) nearest = n;
    }
  }
  // A border is the bisector of the cell's point and another.
  const Point& own = points[nearest];
  const double shrink = 1 / (elongation * elongation);
  CellAt out{{std::numeric_limits<double>::infinity(), 0, 0}, mixed_bits(own.bits + 1) * 0x1p-32};
  for (std::size_t i = 0; i < 9; ++i) {
    if (i == nearest) continue;
    const double ex = own.dx - points[i].dx, ey = own.dy - points[i].dy;   // from the cell's point to the other
    const double steepness = 2 * std::sqrt(ex * ex + shrink * ey * ey), apart = points[i].d2 - own.d2;
    if (apart < out.border.f * steepness) out.border = {apart / steepness, -2 * ex / steepness, -2 * ey / steepness};
  }
  return out;
}

double bark_noise(double x, double y, std::uint32_t period, std::uint64_t seed) {
  const std::int64_t cx = cell_of(x), cy = cell_of(y);
  const std::uint32_t left = wrapped_column(cx, period), right = left + 1 < period ? left + 1 : 0;
  const auto corner = [&](std::uint32_t column, std::int64_t row) {
    return unit_of(hash_of(seed, column, static_cast<std::uint64_t>(row)));
  };
  const double fx = smooth(0, 1, x - static_cast<double>(cx)), fy = smooth(0, 1, y - static_cast<double>(cy));
  return mixed(mixed(corner(left, cy), corner(right, cy), fx), mixed(corner(left, cy + 1), corner(right, cy + 1), fx), fy);
}

}  // namespace cambium
