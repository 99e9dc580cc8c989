#include "raytrace/bark_pattern.h"

#include "raytrace/hash.h"

#include <algorithm>
#include <cmath>
#include <numbers>

namespace cambium {
namespace {

double smooth(double lo, double hi, double x) {
  const double t = std::clamp((x - lo) / (hi - lo), 0.0, 1.0);
  return t * t * (3 - 2 * t);
}
double lerp(double a, double b, double t) { return a + (b - a) * t; }

std::uint64_t wrapped(double cell, std::uint32_t period) {
  const double p = static_cast<double>(period);
  return static_cast<std::uint64_t>(cell - p * std::floor(cell / p));
}
std::uint64_t row_bits(double cell) { return static_cast<std::uint64_t>(static_cast<std::int64_t>(cell)); }

/// How much of a detail of this size survives under a pixel.
double kept(double detail, double footprint) { return 1 - smooth(0.35, 1.2, footprint / detail); }

/// Distances to the nearest and second nearest of jittered cell points, and the nearest's own random number.
struct Cellular {
  double nearest = 9, second = 9, random = 0;
};
Cellular cellular(double x, double y, std::uint32_t period, std::uint64_t seed, double jitter) {
  Cellular out;
  const double cx = std::floor(x), cy = std::floor(y);
  for (int dy = -1; dy <= 1; ++dy) {
    for (int dx = -1; dx <= 1; ++dx) {
      const std::uint64_t bits = hash_of(seed, wrapped(cx + dx, period), row_bits(cy + dy));
      const double px = cx + dx + 0.5 + jitter * (unit_of(bits) - 0.5);
      const double py = cy + dy + 0.5 + jitter * (unit_of(mix_bits(bits + 1)) - 0.5);
      const double d = std::sqrt((x - px) * (x - px) + (y - py) * (y - py));
      if (d < out.nearest) {
        out.second = out.nearest;
        out.nearest = d;
        out.random = unit_of(mix_bits(bits + 2));
      } else if (d < out.second) {
        out.second = d;
      }
    }
  }
  return out;
}

/// Deep vertical fissures that braid: rows of long cells, wandering around the girth, broken by shorter cross cracks.
BarkTexel ridged(double scale, double u, double v, double unit, std::uint64_t seed, double footprint) {
  const auto plates = static_cast<std::uint32_t>(std::max(5.0, std::round(15 * scale)));
  const double width = 2 * std::numbers::pi * unit / plates, y = v / (width * 5.5);
  const double x0 = u * plates;
  const double wander = 1.5 * (bark_noise(x0, y * 1.3, plates, seed ^ 11) - 0.5) +
                        0.35 * (bark_noise(x0 * 2, y * 9, 2 * plates, seed ^ 12) - 0.5);
  const Cellular plate = cellular(x0 + wander, y + 0.12 * (bark_noise(x0 * 2, y * 6, 2 * plates, seed ^ 13) - 0.5), plates, seed, 0.75);
  const double body = smooth(0.03, 0.42, plate.second - plate.nearest);
  const double grain = bark_noise(x0 * 6, y * 26, 6 * plates, seed ^ 14);
  const double fine = bark_noise(x0 * 16, y * 70, 16 * plates, seed ^ 15);
  BarkTexel out;
  out.height = std::clamp(body * (0.80 + 0.20 * lerp(0.5, grain, kept(0.16 * width, footprint))), 0.0, 1.0);
  out.height = lerp(0.62, out.height, kept(0.9 * width, footprint));
  out.shade = (0.84 + 0.32 * lerp(0.5, plate.random, kept(width, footprint))) *
              (0.86 + 0.28 * lerp(0.5, fine, kept(0.06 * width, footprint)));
  return out;
}

/// Isodiametric plates that lift from their edges.
BarkTexel plated(double scale, double u, double v, double unit, std::uint64_t seed, double footprint) {
  const auto plates = static_cast<std::uint32_t>(std::max(4.0, std::round(9 * scale)));
  const double width = 2 * std::numbers::pi * unit / plates, x = u * plates, y = v / (width * 1.5);
  const double bend = 0.5 * (bark_noise(x * 2, y * 2, 2 * plates, seed ^ 21) - 0.5);
  const Cellular plate = cellular(x + bend, y + bend, plates, seed, 0.85);
  const double edge = smooth(0.02, 0.16, plate.second - plate.nearest);
  const double layer = bark_noise(x * 4, y * 12, 4 * plates, seed ^ 22);
  BarkTexel out;
  out.height = lerp(0.8, std::clamp(edge * (0.75 + 0.25 * layer), 0.0, 1.0), kept(0.5 * width, footprint));
  out.shade = (0.75 + 0.5 * lerp(0.5, plate.random, kept(width, footprint))) *
              (0.88 + 0.24 * lerp(0.5, layer, kept(0.2 * width, footprint)));
  return out;
}

/// Lens-shaped pores: sparse, wider than high on smooth young bark, long bands on birch.
double lenticels(double x, double y, std::uint32_t period, std::uint64_t seed, double share, double half_width, double half_height) {
  const double cx = std::floor(x), cy = std::floor(y);
  double mark = 0;
  // Pores of the neighbouring cells that are in reach.
  const auto least = [](double past, double reach) { return past < reach ? -1 : 0; };
  const auto most = [](double past, double reach) { return 1 - past < reach ? 1 : 0; };
  for (int dy = least(y - cy, half_height); dy <= most(y - cy, half_height); ++dy) {
    for (int dx = least(x - cx, half_width); dx <= most(x - cx, half_width); ++dx) {
      const std::uint64_t bits = hash_of(seed, wrapped(cx + dx, period), row_bits(cy + dy));
      if (unit_of(bits) > share) continue;
      const double size = 0.55 + 0.45 * unit_of(mix_bits(bits + 1));
      const double px = cx + dx + unit_of(mix_bits(bits + 2)), py = cy + dy + unit_of(mix_bits(bits + 3));
      const double along = (x - px) / (half_width * size), up = (y - py) / (half_height * size);
      const double d = std::sqrt(along * along + up * up);
      mark = std::max(mark, 1 - smooth(0.55, 1.0, d));
    }
  }
  return mark;
}

BarkTexel young(double scale, double u, double v, double unit, std::uint64_t seed, double footprint) {
  const auto around = static_cast<std::uint32_t>(std::max(3.0, std::round(7 * scale)));
  const double width = 2 * std::numbers::pi * unit / around, x = u * around, y = v / width;
  const double blotch = bark_noise(x, y * 0.6, around, seed ^ 31);
  const double grain = bark_noise(x * 5, y * 9, 5 * around, seed ^ 32);
  BarkTexel out;
  out.mark = lenticels(x, y, around, seed ^ 33, 0.5, 0.20, 0.10) * kept(0.2 * width, footprint);
  out.height = 0.93 + 0.07 * lerp(0.5, grain, kept(0.2 * width, footprint)) - 0.25 * out.mark;
  out.shade = (0.86 + 0.28 * lerp(0.5, blotch, kept(width, footprint))) * (0.94 + 0.12 * lerp(0.5, grain, kept(0.2 * width, footprint)));
  return out;
}

BarkTexel birch(double scale, double u, double v, double unit, std::uint64_t seed, double footprint) {
  const auto around = static_cast<std::uint32_t>(std::max(2.0, std::round(4 * scale)));
  const double width = 2 * std::numbers::pi * unit / around, x = u * around, y = v / (0.22 * width);
  const double peel = bark_noise(x * 2, y * 3.3, 2 * around, seed ^ 41);
  const double patch = bark_noise(x, y * 0.16, around, seed ^ 42);
  BarkTexel out;
  out.mark = std::max(lenticels(x, y, around, seed ^ 43, 0.45, 0.42, 0.10), 0.9 * smooth(0.74, 0.86, patch));
  out.mark *= kept(0.08 * width, footprint);
  out.height = lerp(0.9, std::clamp(0.8 + 0.2 * peel - 0.3 * out.mark, 0.0, 1.0), kept(0.15 * width, footprint));
  out.shade = 0.90 + 0.20 * lerp(0.5, peel, kept(0.15 * width, footprint));
  return out;
}

BarkTexel pattern_at(BarkStyle style, double scale, double u, double v, double unit, std::uint64_t seed, double footprint) {
  switch (style) {
    case BarkStyle::kRidged: return ridged(scale, u, v, unit, seed, footprint);
    case BarkStyle::kPlated: return plated(scale, u, v, unit, seed, footprint);
    case BarkStyle::kSmooth: return young(scale, u, v, unit, seed, footprint);
    case BarkStyle::kBirch: return birch(scale, u, v, unit, seed, footprint);
  }
  return {};
}

}  // namespace

double bark_noise(double x, double y, std::uint32_t period, std::uint64_t seed) {
  const double cx = std::floor(x), cy = std::floor(y);
  const std::uint64_t left = wrapped(cx, period), right = left + 1 < period ? left + 1 : 0;
  const std::uint64_t low = row_bits(cy), high = row_bits(cy + 1);
  const auto corner = [&](std::uint64_t column, std::uint64_t row) { return unit_of(hash_of(seed, column, row)); };
  const double fx = smooth(0, 1, x - cx), fy = smooth(0, 1, y - cy);
  return lerp(lerp(corner(left, low), corner(right, low), fx), lerp(corner(left, high), corner(right, high), fx), fy);
}

// A pattern's height in metres must follow the girth, but v / radius would shear the pattern wherever a branch tapers. So it is
// drawn for the two neighbouring powers of two of the radius, each with its own fixed metres per plate, and faded over.
BarkTexel bark_pattern(BarkStyle style, double scale, double u, double v, double radius, std::uint64_t seed, double footprint) {
  if (!(radius > 0) || !std::isfinite(u) || !std::isfinite(v)) return {};
  const double level = std::log2(std::clamp(radius, 1e-6, 1e6));
  const double whole = std::floor(level), weight = smooth(0.3, 0.7, level - whole);
  scale = std::clamp(scale, 0.05, 50.0);
  const auto at = [&](double k) {
    const auto level_seed = hash_of(seed, static_cast<std::uint64_t>(k + 1024));
    return pattern_at(style, scale, u, std::clamp(v, -1e9, 1e9), std::exp2(k + 0.5), level_seed, footprint);
  };
  if (weight <= 0) return at(whole);
  if (weight >= 1) return at(whole + 1);
  const BarkTexel a = at(whole), b = at(whole + 1);
  return {lerp(a.height, b.height, weight), lerp(a.shade, b.shade, weight), lerp(a.mark, b.mark, weight)};
}

double bark_depth(BarkStyle style) {
  switch (style) {
    case BarkStyle::kRidged: return 0.075;
    case BarkStyle::kPlated: return 0.05;
    case BarkStyle::kSmooth: return 0.012;
    case BarkStyle::kBirch: return 0.015;
  }
  return 0;
}

}  // namespace cambium
