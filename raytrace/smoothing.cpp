#include "raytrace/smoothing.h"

#include "raytrace/tone.h"

#include <tbb/parallel_for.h>

#include <algorithm>
#include <cmath>
#include <cstddef>

namespace cambium {
namespace {

constexpr float kKernel[5] = {1 / 16.0f, 1 / 4.0f, 3 / 8.0f, 1 / 4.0f, 1 / 16.0f};
constexpr int kStrides[] = {1, 2, 4, 8};
// Of noise, beyond which a difference is real: for many samples, and what is added for one. With 3 for one sample a lone hidden ray
// stays as a speck; with 2.75 for sixteen a close-up's bark is further from the truth than if it were left alone, with 2 about as near.
constexpr float kSigmas = 1, kSigmasOfOne = 4;
constexpr float kAlbedoContrast = 0.15f;   // of neighbours, at which they count half: cracks in the bark see less of the sky
constexpr float kLeastNoise = 0.01f;      // of the light: what differs by less is smoothed whatever its noise seems to be
// After the first pass neighbours share what they are means of. On an even wall the passes' kernels together are as wide as
// 1, 5, 21 and 85 pixels of variance: each gains 4 to 5 times the samples, not the 13 of a pass over independent ones.
constexpr float kIndependent = 0.33f;

/// A pixel's light between passes.
struct Estimate {
  glm::vec3 light{0.0f};
  float samples = 0;                      ///< that a mean with this noise would have
};

float brightness(const glm::vec3& light) { return static_cast<float>(luminance(Vec3(light))); }

/// Of their surfaces' colour, [0, 1].
float contrast(const AmbientPixel& a, const AmbientPixel& b) {
  const float light = brightness(a.albedo) / a.covered, other = brightness(b.albedo) / b.covered;
  return std::abs(light - other) / std::max(light + other, 1e-6f);
}

/// Whether two pixels may lie on one surface, [0, 1]: each near the other's tangent plane, normals alike.
float likeness(const AmbientPixel& a, const AmbientPixel& b, float distance_pixels, float pixel_size) {
  const float cosine = glm::dot(a.normal, b.normal);
  if (cosine <= 0) return 0;
  const glm::vec3 apart = b.from_eye - a.from_eye;
  const float off_plane = std::max(std::abs(glm::dot(apart, a.normal)), std::abs(glm::dot(apart, b.normal)));
  const float near = 1 - off_plane / (pixel_size * (1 + 0.5f * distance_pixels));
  if (near <= 0) return 0;
  const float c2 = cosine * cosine, c4 = c2 * c2, c8 = c4 * c4;
  const float colour = contrast(a, b) / kAlbedoContrast;
  return c8 * c8 * near / (1 + colour * colour);
}

class AmbientImage {
 public:
  AmbientImage(const std::vector<AmbientPixel>& pixels, int width, int height, double pixel_angle)
      : pixels_(pixels), width_(width), height_(height), pixel_angle_(static_cast<float>(pixel_angle)) {}

  /// Variance of one sample's light, pooled over 5 x 5 pixels of one surface: a single pixel has too few samples to tell. What
  /// pixels differ among themselves may be real; it counts as one sample more, so that it decides only where each has but one.
  std::vector<float> sample_variance() const {
    std::vector<float> variance(pixels_.size());
    for_each_surface_pixel([&](std::size_t here, int x, int y) {
      float n = 0, sum = 0, squares = 0, within = 0, freedom = 0;
      const auto add = [&](const AmbientPixel& pixel, float weight) {
        n += weight * pixel.hits, sum += weight * pixel.light, squares += weight * pixel.light_squared;
        within += weight * std::max(0.0f, pixel.light_squared - pixel.light * pixel.light / pixel.hits);
        freedom += weight * (pixel.hits - 1);
      };
      add(pixels_[here], 1);
      for_each_neighbour(here, x, y, 1, [&](std::size_t there, float, float alike) { add(pixels_[there], alike); });
      const float together = std::max(0.0f, squares / n - (sum / n) * (sum / n));
      variance[here] = (within + together) / (freedom + 1);
    });
    return variance;
  }

  std::vector<Estimate> pass(const std::vector<Estimate>& from, const std::vector<float>& variance, int stride) const {
    std::vector<Estimate> to = from;
    for_each_surface_pixel([&](std::size_t here, int x, int y) {
      const Estimate& a = from[here];
      const float level = brightness(a.light), least = kLeastNoise * level;
      const float sigmas = kSigmas + kSigmasOfOne / std::sqrt(pixels_[here].hits);
      const float own = kKernel[2] * kKernel[2] * a.samples;
      glm::vec3 sum = own * a.light;
      float weight = own, squares = own * own / a.samples;
      for_each_neighbour(here, x, y, stride, [&](std::size_t there, float kernel, float alike) {
        const Estimate& b = from[there];
        const float difference = brightness(b.light) - level;
        const float noise = variance[here] * (1 / a.samples + 1 / b.samples) + least * least + 1e-12f;
        const float agree = 1 - difference * difference / (sigmas * sigmas * noise);
        if (agree <= 0) return;
        const float w = kernel * alike * agree * b.samples;
        sum += w * b.light;
        weight += w;
        squares += w * w / b.samples;
      });
      const float independent = stride == kStrides[0] ? 1 : kIndependent;
      to[here] = {sum / weight, std::max(a.samples, independent * weight * weight / squares)};
    });
    return to;
  }

 private:
  template <typename Visit>
  void for_each_surface_pixel(const Visit& visit) const {
    tbb::parallel_for(0, height_, [&](int y) {
      for (int x = 0; x < width_; ++x) {
        const std::size_t here = std::size_t(y) * width_ + x;
        if (pixels_[here].hits > 0) visit(here, x, y);
      }
    });
  }

  /// visit(place, kernel's weight, likeness) for the 24 around that are of the same surface.
  template <typename Visit>
  void for_each_neighbour(std::size_t here, int x, int y, int stride, const Visit& visit) const {
    const AmbientPixel& a = pixels_[here];
    const float pixel_size = glm::length(a.from_eye) * pixel_angle_;
    for (int dy = -2; dy <= 2; ++dy) {
      for (int dx = -2; dx <= 2; ++dx) {
        const int nx = x + dx * stride, ny = y + dy * stride;
        if ((dx == 0 && dy == 0) || nx < 0 || ny < 0 || nx >= width_ || ny >= height_) continue;
        const std::size_t there = std::size_t(ny) * width_ + nx;
        if (!(pixels_[there].hits > 0)) continue;
        const float distance = static_cast<float>(stride) * std::sqrt(static_cast<float>(dx * dx + dy * dy));
        const float alike = likeness(a, pixels_[there], distance, pixel_size);
        if (alike > 0) visit(there, kKernel[dx + 2] * kKernel[dy + 2], alike);
      }
    }
  }

  const std::vector<AmbientPixel>& pixels_;
  int width_, height_;
  float pixel_angle_;
};

}  // namespace

std::vector<glm::vec3> smooth_ambient(const std::vector<AmbientPixel>& pixels, int width, int height, double pixel_angle) {
  const AmbientImage image(pixels, width, height, pixel_angle);
  std::vector<Estimate> estimates(pixels.size());
  for (std::size_t i = 0; i < pixels.size(); ++i) {
    estimates[i] = {pixels[i].lit / glm::max(pixels[i].albedo, glm::vec3(1e-4f)), pixels[i].hits};
  }
  const std::vector<float> variance = image.sample_variance();
  for (const int stride : kStrides) estimates = image.pass(estimates, variance, stride);
  std::vector<glm::vec3> lit(pixels.size());
  for (std::size_t i = 0; i < pixels.size(); ++i) lit[i] = estimates[i].light * pixels[i].albedo;
  return lit;
}

}  // namespace cambium
