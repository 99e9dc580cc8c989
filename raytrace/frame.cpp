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

/// Pixels as they were before a pass. Of a first pass there is nothing to keep: they were empty.
class Frame::Saved {
 public:
  Saved(const Frame& frame, const std::vector<std::uint32_t>& pixels) : pixels_(pixels) {
    if (!frame.taken_) return;
    for (const std::uint32_t pixel : pixels) {
      sums_.push_back(frame.sums_[pixel]);
      if (frame.options_.first_hits) first_hits_.push_back(frame.first_hits_[pixel]);
    }
  }

  void restore(Frame& frame) const {
    for (std::size_t i = 0; i < pixels_.size(); ++i) {
      frame.sums_[pixels_[i]] = frame.taken_ ? sums_[i] : PixelSum{};
      if (frame.options_.first_hits) frame.first_hits_[pixels_[i]] = frame.taken_ ? first_hits_[i] : FirstHitSum{};
    }
  }

 private:
  const std::vector<std::uint32_t>& pixels_;
  std::vector<PixelSum> sums_;
  std::vector<FirstHitSum> first_hits_;
};

std::size_t Frame::add_samples(const SampleSource& source, std::uint32_t pixel, int until, const RunOptions& run) {
  const int x = area_.x0 + static_cast<int>(pixel % area_.width()), y = area_.y0 + static_cast<int>(pixel / area_.width());
  std::size_t rays = 0;
  for (int s = sums_[pixel].samples; s < until && !run.cancelled(); ++s) {
    const CameraSample sample = source.sample(x, y, static_cast<std::uint32_t>(s));
    sums_[pixel].add(sample, displayed(sample));
    if (options_.first_hits) first_hits_[pixel].add(sample);
    rays += sample.rays;
  }
  return rays;
}

bool Frame::take(const SampleSource& source, const std::vector<std::uint32_t>& pixels, int until, ProgressMeter& progress,
                 double progress_share, const RunOptions& run) {
  const Saved before(*this, pixels);
  std::atomic<std::size_t> rays{0};
  tbb::parallel_for(tbb::blocked_range<std::size_t>(0, pixels.size(), kChunk), [&](const auto& chunk) {
    std::size_t chunk_rays = 0;
    for (std::size_t i = chunk.begin(); i < chunk.end() && !run.cancelled(); ++i) chunk_rays += add_samples(source, pixels[i], until, run);
    rays += chunk_rays;
    progress.add(progress_share * double(chunk.size()) / double(pixels.size()));
  });
  if (run.cancelled()) {
    before.restore(*this);
    return false;
  }
  rays_ += rays;
  taken_ = true;
  return true;
}

}  // namespace cambium
