// The sums of every pixel of a part of the picture, and taking more samples into them.
#pragma once

#include "blobtree/progress_meter.h"
#include "blobtree/run_options.h"
#include "raytrace/pixel_rect.h"
#include "raytrace/pixel_sum.h"

#include <cstdint>
#include <vector>

namespace cambium {

/// Where samples come from: a pure function of the pixel in the whole picture and the sample's index. Thread safe.
class SampleSource {
 public:
  virtual ~SampleSource() = default;
  virtual CameraSample sample(int x, int y, std::uint32_t index) const = 0;
};

struct FrameOptions {
  double exposure = 1;         ///< what the light is multiplied with before it is displayed
  bool even_ambient = true;    ///< judge pixels as if the ambient light were even: its noise will be smoothed
  bool first_hits = false;     ///< keep what AOVs need
};

class Frame {
 public:
  Frame(const PixelRect& whole, const PixelRect& area, const FrameOptions& options);

  const PixelRect& whole() const { return whole_; }
  const PixelRect& area() const { return area_; }   ///< the pixels that have sums
  const PixelSum& sum(int x, int y) const { return sums_[area_.index(x, y)]; }
  const FirstHitSum& first_hits(int x, int y) const { return first_hits_[area_.index(x, y)]; }
  std::size_t rays() const { return rays_; }

  /// Takes the samples up to index `until` - 1 that each of the pixels (places in the area's array) does not have yet. False if
  /// cancelled: then the frame is as it was before.
  bool take(const SampleSource& source, const std::vector<std::uint32_t>& pixels, int until, ProgressMeter& progress,
            double progress_share, const RunOptions& run);

 private:
  class Saved;
  std::size_t add_samples(const SampleSource& source, std::uint32_t pixel, int until, const RunOptions& run);
  double displayed(const CameraSample& sample) const;

  PixelRect whole_, area_;
  FrameOptions options_;
  std::vector<PixelSum> sums_;
  std::vector<FirstHitSum> first_hits_;
  std::size_t rays_ = 0;
  bool taken_ = false;   ///< a pass has been finished
};

}  // namespace cambium
