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

float brightness(const glm::vec3& light) { return static_cast<float>(luminance(Vec3(light))); }

/// One number for each pixel: compilers take four or more pixels of a row at once through them.
using Plane = std::vector<float>;

/// A vector for each pixel.
struct VectorPlanes {
  Plane x, y, z;
  explicit VectorPlanes(std::size_t size) : x(size), y(size), z(size) {}
  void set(std::size_t i, const glm::vec3& v) { x[i] = v.x, y[i] = v.y, z[i] = v.z; }
  glm::vec3 at(std::size_t i) const { return {x[i], y[i], z[i]}; }
  float dot(std::size_t i, std::size_t k) const { return x[i] * x[k] + y[i] * y[k] + z[i] * z[k]; }
};

/// What tells whether two pixels lie on one surface.
struct Surfaces {
  VectorPlanes normal, from_eye;
  Plane shade;        ///< brightness of the surface's colour
  Plane pixel_size;   ///< metres that a pixel spans there; 0 where there is no surface

  Surfaces(const std::vector<AmbientPixel>& pixels, float pixel_angle)
      : normal(pixels.size()), from_eye(pixels.size()), shade(pixels.size()), pixel_size(pixels.size()) {
    tbb::parallel_for(std::size_t{0}, pixels.size(), [&](std::size_t i) {
      const AmbientPixel& pixel = pixels[i];
      if (!(pixel.hits > 0)) return;
      normal.set(i, pixel.normal);
      from_eye.set(i, pixel.from_eye);
      shade[i] = brightness(pixel.albedo) / pixel.covered;
      pixel_size[i] = glm::length(pixel.from_eye) * pixel_angle;
    });
  }

  /// Whether two pixels so far apart may lie on one surface, [0, 1]: each near the other's tangent plane, normals and colours alike.
  float likeness(std::size_t a, std::size_t b, float distance_pixels) const {
    const float cosine = normal.dot(a, b), c2 = cosine * cosine, c4 = c2 * c2, c8 = c4 * c4;
    const float x = from_eye.x[b] - from_eye.x[a], y = from_eye.y[b] - from_eye.y[a], z = from_eye.z[b] - from_eye.z[a];
    const float off_a = std::abs(x * normal.x[a] + y * normal.y[a] + z * normal.z[a]);
    const float off_b = std::abs(x * normal.x[b] + y * normal.y[b] + z * normal.z[b]);
    const float near = 1 - std::max(off_a, off_b) / (pixel_size[a] * (1 + 0.5f * distance_pixels));
    const float contrast = std::abs(shade[a] - shade[b]) / std::max(shade[a] + shade[b], 1e-6f), colour = contrast / kAlbedoContrast;
    const float alike = c8 * c8 * near / (1 + colour * colour);
    // Where there is no surface the normal is 0, and with it the cosine.
    return (cosine > 0) & (near > 0) ? alike : 0;
  }
};

/// The pixels' light between passes.
struct Estimates {
  VectorPlanes light;
  Plane level;     ///< its brightness
  Plane samples;   ///< that a mean with this noise would have; 1 where there is no surface

  explicit Estimates(std::size_t size) : light(size), level(size), samples(size, 1) {}
  void set(std::size_t i, const glm::vec3& of, float with_samples) {
    light.set(i, of);
    level[i] = brightness(of);
    samples[i] = with_samples;
  }
};

class AmbientImage {
 public:
  AmbientImage(const std::vector<AmbientPixel>& pixels, int width, int height, double pixel_angle)
      : pixels_(pixels), surfaces_(pixels, static_cast<float>(pixel_angle)), width_(width), height_(height) {}

  Estimates first_estimates() const {
    Estimates estimates(pixels_.size());
    tbb::parallel_for(std::size_t{0}, pixels_.size(), [&](std::size_t i) {
      const AmbientPixel& pixel = pixels_[i];
      if (pixel.hits > 0) estimates.set(i, pixel.lit / glm::max(pixel.albedo, glm::vec3(1e-4f)), pixel.hits);
    });
    return estimates;
  }

  /// Variance of one sample's light, pooled over 5 x 5 pixels of one surface: a single pixel has too few samples to tell. What
  /// pixels differ among themselves may be real; it counts as one sample more, so that it decides only where each has but one.
  Plane sample_variance() const {
    const std::size_t size = pixels_.size();
    Plane hits(size), light(size), squared(size), spread(size), variance(size);
    tbb::parallel_for(std::size_t{0}, size, [&](std::size_t i) {
      const AmbientPixel& pixel = pixels_[i];
      if (!(pixel.hits > 0)) return;
      hits[i] = pixel.hits, light[i] = pixel.light, squared[i] = pixel.light_squared;
      spread[i] = std::max(0.0f, pixel.light_squared - pixel.light * pixel.light / pixel.hits);
    });
    tbb::parallel_for(0, height_, [&](int y) {
      const std::size_t row = std::size_t(y) * width_;
      const auto row_of = [&](const Plane& plane) { return Plane(plane.begin() + row, plane.begin() + row + width_); };
      Plane n = row_of(hits), sum = row_of(light), squares = row_of(squared), within = row_of(spread), freedom(width_);
      for (int x = 0; x < width_; ++x) freedom[x] = hits[row + x] - 1;
      for_each_neighbour_of_row(y, 1, [&](int x, std::size_t, std::size_t there, float, float alike) {
        n[x] += alike * hits[there];
        sum[x] += alike * light[there];
        squares[x] += alike * squared[there];
        within[x] += alike * spread[there];
        freedom[x] += alike * (hits[there] - 1);
      });
      for (int x = 0; x < width_; ++x) {
        if (!(hits[row + x] > 0)) continue;
        const float together = std::max(0.0f, squares[x] / n[x] - (sum[x] / n[x]) * (sum[x] / n[x]));
        variance[row + x] = (within[x] + together) / (freedom[x] + 1);
      }
    });
    return variance;
  }

  Estimates pass(const Estimates& from, const Plane& variance, int stride) const {
    Estimates to(pixels_.size());
    tbb::parallel_for(0, height_, [&](int y) {
      const std::size_t row = std::size_t(y) * width_;
      VectorPlanes sum(width_);
      Plane weight(width_), squares(width_), least_square(width_), sigmas_square(width_);
      for (int x = 0; x < width_; ++x) {
        const std::size_t here = row + x;
        const float own = kKernel[2] * kKernel[2] * from.samples[here], least = kLeastNoise * from.level[here];
        sum.set(x, own * from.light.at(here));
        weight[x] = own;
        squares[x] = own * own / from.samples[here];
        least_square[x] = least * least;
        const float sigmas = kSigmas + kSigmasOfOne / std::sqrt(std::max(1.0f, pixels_[here].hits));
        sigmas_square[x] = sigmas * sigmas;
      }
      for_each_neighbour_of_row(y, stride, [&](int x, std::size_t here, std::size_t there, float kernel, float alike) {
        const float difference = from.level[there] - from.level[here], samples = from.samples[there];
        const float noise = variance[here] * (1 / from.samples[here] + 1 / samples) + least_square[x] + 1e-12f;
        const float agree = 1 - difference * difference / (sigmas_square[x] * noise);
        const float w = kernel * alike * (agree > 0 ? agree : 0) * samples;
        sum.x[x] += w * from.light.x[there];
        sum.y[x] += w * from.light.y[there];
        sum.z[x] += w * from.light.z[there];
        weight[x] += w;
        squares[x] += w * w / samples;
      });
      const float independent = stride == kStrides[0] ? 1 : kIndependent;
      for (int x = 0; x < width_; ++x) {
        if (!(pixels_[row + x].hits > 0)) continue;
        to.set(row + x, sum.at(x) / weight[x], std::max(from.samples[row + x], independent * weight[x] * weight[x] / squares[x]));
      }
    });
    return to;
  }

 private:
  /// visit(x, here, there, kernel's weight, likeness) for the 24 around each pixel of a row; likeness 0 where they are not of
  /// one surface. One of the 24 for all pixels before the next: loops without a branch.
  template <typename Visit>
  void for_each_neighbour_of_row(int y, int stride, const Visit& visit) const {
    const std::size_t row = std::size_t(y) * width_;
    for (int dy = -2; dy <= 2; ++dy) {
      const int ny = y + dy * stride;
      if (ny < 0 || ny >= height_) continue;
      for (int dx = -2; dx <= 2; ++dx) {
        if (dx == 0 && dy == 0) continue;
        const float kernel = kKernel[dx + 2] * kKernel[dy + 2];
        const float distance = static_cast<float>(stride) * std::sqrt(static_cast<float>(dx * dx + dy * dy));
        const std::size_t other_row = std::size_t(ny) * width_ + dx * stride;
        const int begin = std::max(0, -dx * stride), end = std::min(width_, width_ - dx * stride);
#pragma GCC ivdep   // what a visit writes for one x, none reads for another
        for (int x = begin; x < end; ++x) {
          const std::size_t here = row + x, there = other_row + x;
          visit(x, here, there, kernel, surfaces_.likeness(here, there, distance));
        }
      }
    }
  }

  const std::vector<AmbientPixel>& pixels_;
  Surfaces surfaces_;
  int width_, height_;
};

}  // namespace

std::vector<glm::vec3> smooth_ambient(const std::vector<AmbientPixel>& pixels, int width, int height, double pixel_angle) {
  const AmbientImage image(pixels, width, height, pixel_angle);
  const Plane variance = image.sample_variance();
  Estimates estimates = image.first_estimates();
  for (const int stride : kStrides) estimates = image.pass(estimates, variance, stride);
  std::vector<glm::vec3> lit(pixels.size());
  for (std::size_t i = 0; i < pixels.size(); ++i) lit[i] = estimates.light.at(i) * pixels[i].albedo;
  return lit;
}

}  // namespace cambium
