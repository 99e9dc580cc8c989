#include "polygonize/texture_scale.h"

#include <algorithm>
#include <cmath>
#include <numbers>
#include <utility>

namespace cambium {

int wraps_of_step(int step) { return step == 0 ? 1 : step % 2 ? 2 << (step / 2) : 3 << (step / 2 - 1); }

int step_of_wraps(double repeats) {
  int step = 0;
  while (step < 40) {
    const double here = wraps_of_step(step), next = wraps_of_step(step + 1);
    if (repeats * repeats <= here * next) break;   // below the geometric mean
    ++step;
  }
  return step;
}

void RadiusAreas::add(double radius, double area) {
  if (!(radius > 0) || !(area > 0)) return;
  const double bin = std::floor((std::log2(radius) - kLeast) * kPerOctave);
  areas_[static_cast<std::size_t>(std::clamp(bin, 0.0, static_cast<double>(kBins - 1)))] += area;
}

void RadiusAreas::add(const RadiusAreas& other) {
  for (std::size_t i = 0; i < kBins; ++i) areas_[i] += other.areas_[i];
}

double RadiusAreas::best_repeat() const {
  // What is left over is for where branches meet and for tips, where a texture cannot but stretch.
  constexpr double kWithin = 0.19, kShare = 0.985;
  struct Share {
    double girth = 0, area = 0;
  };
  std::vector<Share> shares;
  double total = 0;
  for (std::size_t i = 0; i < kBins; ++i) {
    if (!(areas_[i] > 0)) continue;
    const double radius = std::exp2(kLeast + (static_cast<double>(i) + 0.5) / kPerOctave);
    shares.push_back({2 * std::numbers::pi * radius, areas_[i]});
    total += areas_[i];
  }
  if (shares.empty()) return 0;
  std::vector<std::pair<double, double>> densities;
  // From once round the thickest down to once round the thinnest, where every branch is served.
  for (double repeat = shares.back().girth; repeat > shares.front().girth; repeat *= 0.98) {
    densities.clear();
    for (const Share& share : shares) {
      const double repeats = share.girth / repeat;
      densities.emplace_back(std::sqrt(wraps_of_step(step_of_wraps(repeats)) / repeats), share.area);
    }
    std::sort(densities.begin(), densities.end());
    double median = 0, seen = 0, within = 0;
    for (const auto& [density, area] : densities)
      if ((seen += area) >= 0.5 * total) {
        median = density;
        break;
      }
    for (const auto& [density, area] : densities)
      if (std::abs(density / median - 1) <= kWithin) within += area;
    if (within >= kShare * total) return repeat;
  }
  return shares.front().girth;
}

}  // namespace cambium
