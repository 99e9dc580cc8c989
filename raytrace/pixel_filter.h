// The reconstruction filter, sampled: each pixel's samples lie where its filter weighs, and count alike.
#pragma once

#include <array>

namespace cambium {

/// Blackman-Harris window, separable. Filter importance sampling (Ernst, Stamminger and Greiner 2006): no sample is shared
/// between pixels, so that a crop needs no neighbours' samples. The window is positive, so that nothing rings.
class PixelFilter {
 public:
  /// radius in pixels; 0: all samples in the pixel's middle.
  explicit PixelFilter(double radius);
  /// From [0, 1)^2 to an offset from the pixel's middle, each within the radius. Keeps stratification: monotone in each.
  std::array<double, 2> offset(const std::array<double, 2>& sample) const { return {offset(sample[0]), offset(sample[1])}; }

 private:
  double offset(double sample) const;

  static constexpr int kSteps = 1024;
  std::array<double, kSteps + 1> quantiles_{};
};

}  // namespace cambium
