#include "raytrace/frame.h"

#include "raytrace/tone.h"

#include <tbb/blocked_range.h>
#include <tbb/parallel_for.h>

#include <atomic>

namespace cambium {
namespace {

// About the light of sky and bounces, so that only edges, texture and the sun's shadow count.
constexpr double kEvenAmbient = 0.45;
constexpr std::size_t kChunk = 64;  // pixels that one thread takes at once: a quarter of a tile

}  // namespace

Frame::Frame(const PixelRect& whole, const PixelRect& area, const FrameOptions& options)
    : whole_(whole), area_(area), options_(options), sums_(area.size()), first_hits_(options.first_hits ? area.size() : 0) {}

double Frame::displayed(const CameraSample& sample) const {
  const Vec3 ambient = options_.even_ambient ? Vec3(kEvenAmbient) : sample.ambient;
  const double shown = luminance(display_from_linear(options_.exposure * (sample.direct + sample.albedo * ambient)));
  return shown + (1 - sample.alpha);  // what is transparent as white: bark is darker
}

bool Frame::take(const SampleSource& source, const std::vector<std::uint32_t>& pixels, int until, ProgressMeter& progress,
                 double progress_share, const RunOptions& run) {
  // Into copies, which replace the sums once all are there.
  std::vector<PixelSum> sums(pixels.size());
  std::vector<FirstHitSum> first_hits(first_hits_.empty() ? 0 : pixels.size());
  std::atomic<std::size_t> rays{0};
  tbb::parallel_for(tbb::blocked_range<std::size_t>(0, pixels.size(), kChunk), [&](const auto& chunk) {
    std::size_t chunk_rays = 0;
    for (std::size_t i = chunk.begin(); i < chunk.end(); ++i) {
      const int x = area_.x0 + static_cast<int>(pixels[i] % area_.width()), y = area_.y0 + static_cast<int>(pixels[i] / area_.width());
      PixelSum sum = sums_[pixels[i]];
      FirstHitSum first = first_hits_.empty() ? FirstHitSum{} : first_hits_[pixels[i]];
      for (int s = sum.samples; s < until; ++s) {
        if (run.cancelled()) return;
        const CameraSample sample = source.sample(x, y, static_cast<std::uint32_t>(s));
        sum.add(sample, displayed(sample));
        if (!first_hits.empty()) first.add(sample);
        chunk_rays += sample.rays;
      }
      sums[i] = sum;
      if (!first_hits.empty()) first_hits[i] = first;
    }
    rays += chunk_rays;
    progress.add(progress_share * double(chunk.size()) / double(pixels.size()));
  });
  if (run.cancelled()) return false;
  for (std::size_t i = 0; i < pixels.size(); ++i) {
    sums_[pixels[i]] = sums[i];
    if (!first_hits.empty()) first_hits_[pixels[i]] = first_hits[i];
  }
  rays_ += rays;
  return true;
}

}  // namespace cambium
