#include "raytrace/texture_image.h"

#include "raytrace/tone.h"

#include <algorithm>
#include <cmath>
#include <utility>

namespace cambium {
namespace {

/// Nothing steeper can be told from a normal of 8 bits.
constexpr float kLeastZ = 0.1f;

glm::vec3 slopes(const glm::vec3& texel, float up) {
  const glm::vec3 n = 2.0f * texel - 1.0f;
  const float z = std::max(n.z, kLeastZ);
  return {-n.x / z, -up * n.y / z, 0.0f};
}

glm::vec3 decoded(const float* texel, const Pixels& pixels, TextureUse use) {
  glm::vec3 value = pixels.channels >= 3 ? glm::vec3(texel[0], texel[1], texel[2]) : glm::vec3(texel[0]);
  switch (use) {
    case TextureUse::kNormalOpenGl: return slopes(value, 1);
    case TextureUse::kNormalDirectX: return slopes(value, -1);
    case TextureUse::kRoughness: return glm::vec3(value.y);
    case TextureUse::kColor: break;
  }
  if (pixels.srgb) {
    for (int c = 0; c < 3; ++c) value[c] = static_cast<float>(linear_from_srgb(value[c]));
  }
  return value;
}

int wrap(int i, int n) { return i < 0 ? i + n : i >= n ? i - n : i; }

}  // namespace

TextureImage::TextureImage(const Pixels& pixels, TextureUse use) : aspect_(double(pixels.width) / pixels.height) {
  Level base{pixels.width, pixels.height, {}};
  base.texels.reserve(std::size_t(base.width) * base.height);
  for (std::size_t i = 0; i < std::size_t(base.width) * base.height; ++i)
    base.texels.push_back(decoded(&pixels.data[i * pixels.channels], pixels, use));
  levels_.push_back(std::move(base));
  while (levels_.back().width > 1 || levels_.back().height > 1) {
    const Level& fine = levels_.back();
    Level coarse{std::max(1, fine.width / 2), std::max(1, fine.height / 2), {}};
    for (int y = 0; y < coarse.height; ++y) {
      for (int x = 0; x < coarse.width; ++x) {
        // Every fine texel goes into one coarse one, also where a size is odd.
        const int x0 = x * fine.width / coarse.width, x1 = (x + 1) * fine.width / coarse.width;
        const int y0 = y * fine.height / coarse.height, y1 = (y + 1) * fine.height / coarse.height;
        glm::vec3 sum(0.0f);
        for (int j = y0; j < y1; ++j) {
          for (int i = x0; i < x1; ++i) sum += fine.texels[std::size_t(j) * fine.width + i];
        }
        coarse.texels.push_back(sum / float((x1 - x0) * (y1 - y0)));
      }
    }
    levels_.push_back(std::move(coarse));
  }
}

Vec3 TextureImage::bilinear(const Level& level, double s, double t) const {
  const double x = (s - std::floor(s)) * level.width - 0.5, y = (1 - (t - std::floor(t))) * level.height - 0.5;
  const double fx = x - std::floor(x), fy = y - std::floor(y);
  const int x0 = wrap(int(std::floor(x)), level.width), y0 = wrap(int(std::floor(y)), level.height);
  const int x1 = wrap(x0 + 1, level.width), y1 = wrap(y0 + 1, level.height);
  const auto at = [&](int i, int j) { return Vec3(level.texels[std::size_t(j) * level.width + i]); };
  return glm::mix(glm::mix(at(x0, y0), at(x1, y0), fx), glm::mix(at(x0, y1), at(x1, y1), fx), fy);
}

Vec3 TextureImage::lookup(double s, double t, double footprint) const {
  if (!std::isfinite(s) || !std::isfinite(t)) return Vec3(0.0);
  const double last = static_cast<double>(levels_.size() - 1);
  const double level = std::clamp(std::log2(std::max(1e-9, footprint * levels_[0].height)), 0.0, last);
  const auto fine = static_cast<std::size_t>(level);
  const Vec3 color = bilinear(levels_[fine], s, t);
  if (fine + 1 >= levels_.size()) return color;
  return glm::mix(color, bilinear(levels_[fine + 1], s, t), level - double(fine));
}

}  // namespace cambium
