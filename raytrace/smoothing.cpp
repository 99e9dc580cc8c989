#include "raytrace/smoothing.h"

#include <tbb/parallel_for.h>

#include <algorithm>
#include <cmath>
#include <cstddef>

namespace cambium {
namespace {

constexpr float kKernel[5] = {1 / 16.0f, 1 / 4.0f, 3 / 8.0f, 1 / 4.0f, 1 / 16.0f};

/// How alike two pixels' surfaces are, [0, 1].
float likeness(const PixelMean& a, const PixelMean& b, float distance_pixels, float pixel_angle) {
  if (!std::isfinite(b.depth) || b.coverage < 0.5f) return 0;
  const float cosine = glm::dot(a.normal, b.normal);
  if (cosine <= 0) return 0;
  const float c2 = cosine * cosine, c4 = c2 * c2, c8 = c4 * c4;
  // Depth may differ by what a slope of about 75 degrees gives over that distance.
  const float expected = a.depth * pixel_angle * (1 + 4 * distance_pixels);
  const float depth = std::abs(a.depth - b.depth) / expected;
  return c8 * c8 * std::max(0.0f, 1 - depth) * b.coverage;
}

}  // namespace

std::vector<glm::vec3> smooth_ambient(const std::vector<PixelMean>& pixels, int width, int height, double pixel_angle,
                                      const RunOptions& run) {
  std::vector<glm::vec3> light(pixels.size()), next(pixels.size());
  for (std::size_t i = 0; i < pixels.size(); ++i) light[i] = pixels[i].lit / glm::max(pixels[i].albedo, glm::vec3(1e-4f));
  for (int stride : {1, 2, 4}) {
    tbb::parallel_for(0, height, [&](int y) {
      if (run.cancelled()) return;
      for (int x = 0; x < width; ++x) {
        const std::size_t here = std::size_t(y) * width + x;
        const PixelMean& a = pixels[here];
        if (!std::isfinite(a.depth)) {
          next[here] = light[here];
          continue;
        }
        glm::vec3 sum = light[here] * (9 / 64.0f);
        float weight = 9 / 64.0f;
        for (int dy = -2; dy <= 2; ++dy) {
          for (int dx = -2; dx <= 2; ++dx) {
            const int nx = x + dx * stride, ny = y + dy * stride;
            if ((dx == 0 && dy == 0) || nx < 0 || ny < 0 || nx >= width || ny >= height) continue;
            const std::size_t there = std::size_t(ny) * width + nx;
            const float distance = static_cast<float>(stride) * std::sqrt(static_cast<float>(dx * dx + dy * dy));
            const float w = kKernel[dx + 2] * kKernel[dy + 2] *
                            likeness(a, pixels[there], distance, static_cast<float>(pixel_angle));
            sum += w * light[there];
            weight += w;
          }
        }
        next[here] = sum / weight;
      }
    });
    if (run.cancelled()) return {};
    std::swap(light, next);
  }
  for (std::size_t i = 0; i < pixels.size(); ++i) light[i] *= pixels[i].albedo;
  return light;
}

}  // namespace cambium
