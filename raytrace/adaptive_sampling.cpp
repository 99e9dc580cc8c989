#include "raytrace/adaptive_sampling.h"

#include <tbb/parallel_for.h>

#include <algorithm>
#include <cmath>

namespace cambium {
namespace {

constexpr int kTile = 16;
constexpr int kReach = 2;             // of a decision, pixels
constexpr int kSurfaceSamples = 8;    // where the surface may be: what is thinner than a pixel shows in one of them or nearby
constexpr float kOutline = 0.25f;     // how much hit beside missed counts, as displayed luminance

/// The largest difference that the samples around a pixel show: between neighbours, and within a neighbour. Where a pixel two
/// away has samples that disagree, this one may only have been lucky: the rim of a soft shadow.
float difference_around(const Frame& frame, int x, int y) {
  const PixelSum& here = frame.sum(x, y);
  const float shown = here.mean_shown(), share = here.hit_share();
  const PixelRect near = PixelRect{x, y, x + 1, y + 1}.grown(1);
  const PixelRect window = PixelRect{x, y, x + 1, y + 1}.grown(kReach).intersection(frame.whole());
  float most = 0;
  for (int ny = window.y0; ny < window.y1; ++ny) {
    for (int nx = window.x0; nx < window.x1; ++nx) {
      const PixelSum& there = frame.sum(nx, ny);
      most = std::max(most, there.spread());
      if (!near.contains(nx, ny)) continue;
      most = std::max({most, std::abs(there.mean_shown() - shown), kOutline * std::abs(there.hit_share() - share)});
    }
  }
  return most;
}

bool is_done(const Frame& frame, int x, int y, bool surface, const Sampling& sampling) {
  const PixelSum& here = frame.sum(x, y);
  const int samples = here.samples;
  if (samples >= sampling.max) return true;
  if (surface && samples < kSurfaceSamples) return false;
  if (here.error() > sampling.noise) return false;
  // What n samples have not met is expected to fill less than 1 / (n + 1) of the pixel (Laplace's rule of succession).
  return difference_around(frame, x, y) <= sampling.noise * (samples + 1);
}

/// All of `region` for which wanted(x, y), tile by tile so that rays taken together meet the same surface.
template <typename Wanted>
std::vector<std::uint32_t> pixels_where(const PixelRect& area, const PixelRect& region, const Wanted& wanted) {
  const int across = (region.width() + kTile - 1) / kTile, down = (region.height() + kTile - 1) / kTile;
  std::vector<std::vector<std::uint32_t>> rows(down);
  tbb::parallel_for(0, down, [&](int row) {
    for (int column = 0; column < across; ++column) {
      const int left = region.x0 + column * kTile, top = region.y0 + row * kTile;
      const PixelRect tile = PixelRect{left, top, left + kTile, top + kTile}.intersection(region);
      for (int y = tile.y0; y < tile.y1; ++y) {
        for (int x = tile.x0; x < tile.x1; ++x) {
          if (wanted(x, y)) rows[row].push_back(static_cast<std::uint32_t>(area.index(x, y)));
        }
      }
    }
  });
  std::vector<std::uint32_t> all;
  for (const auto& row : rows) all.insert(all.end(), row.begin(), row.end());
  return all;
}

/// What pass `pass` of `count` must bring up to date so that the last ones can decide on the crop.
PixelRect region_of_pass(const PixelRect& crop, const PixelRect& whole, std::size_t pass, std::size_t count) {
  return crop.grown(kReach * static_cast<int>(count - 1 - pass)).intersection(whole);
}

}  // namespace

std::vector<std::uint32_t> unfinished_pixels(const Frame& frame, const PixelRect& region, const PixelMask& surface,
                                             const Sampling& sampling) {
  return pixels_where(frame.area(), region, [&](int x, int y) { return !is_done(frame, x, y, surface.test(x, y), sampling); });
}

PixelRect sampled_area(const PixelRect& crop, const PixelRect& whole, const Sampling& sampling) {
  return region_of_pass(crop, whole, 0, passes(sampling).size());
}

int take_passes(Frame& frame, const SampleSource& source, const PixelRect& crop, const PixelMask& surface, const Sampling& sampling,
                const RunOptions& run, const std::function<void(int samples)>& pass_finished) {
  const std::vector<int> counts = passes(sampling);
  ProgressMeter progress(run, "render");
  int finished = 0;
  for (std::size_t pass = 0; pass < counts.size(); ++pass) {
    const PixelRect region = region_of_pass(crop, frame.whole(), pass, counts.size());
    const auto pixels = pass == 0 ? pixels_where(frame.area(), region, [](int, int) { return true; })
                                  : unfinished_pixels(frame, region, surface, sampling);
    if (!frame.take(source, pixels, counts[pass], progress, 1.0 / double(counts.size()), run)) return finished;
    finished = counts[pass];
    if (pass_finished) pass_finished(finished);
  }
  progress.finish();
  return finished;
}

}  // namespace cambium
