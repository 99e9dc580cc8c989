#include "raytrace/foliage_texture.h"

#include <algorithm>
#include <cmath>
#include <cstdint>

namespace cambium {
namespace {

constexpr float kCut = 0.5f;

bool has_alpha(const Pixels& pixels) { return pixels.channels == 2 || pixels.channels == 4; }

std::vector<std::uint8_t> leaf_of(const Pixels& pixels) {
  std::vector<std::uint8_t> leaf;
  if (!has_alpha(pixels)) return leaf;
  bool cut = false;
  for (std::size_t i = pixels.channels - 1; i < pixels.data.size(); i += pixels.channels) {
    const float alpha = std::clamp(pixels.data[i], 0.0f, 1.0f);
    cut = cut || alpha < kCut;
    leaf.push_back(static_cast<std::uint8_t>(std::lround(255 * alpha)));
  }
  if (!cut) leaf.clear();
  return leaf;
}

/// Without alpha, and with the leaf's mean colour where there is no leaf: what is cut away may not tint the rim.
Pixels filled(const Pixels& pixels) {
  if (!has_alpha(pixels)) return pixels;
  const std::size_t colors = static_cast<std::size_t>(pixels.channels) - 1, texels = pixels.data.size() / (colors + 1);
  std::vector<double> mean(colors, 0.0);
  double weight = 0;
  for (std::size_t i = 0; i < texels; ++i) {
    const float* texel = &pixels.data[i * (colors + 1)];
    for (std::size_t c = 0; c < colors; ++c) mean[c] += double(texel[colors]) * texel[c];
    weight += texel[colors];
  }
  Pixels out{pixels.width, pixels.height, static_cast<int>(colors), {}, pixels.srgb};
  out.data.reserve(texels * colors);
  for (std::size_t i = 0; i < texels; ++i) {
    const float* texel = &pixels.data[i * (colors + 1)];
    for (std::size_t c = 0; c < colors; ++c)
      out.data.push_back(texel[colors] >= kCut || !(weight > 0) ? texel[c] : static_cast<float>(mean[c] / weight));
  }
  return out;
}

}  // namespace

FoliageTexture::FoliageTexture(const Pixels& pixels)
    : color_(filled(pixels)), width_(pixels.width), height_(pixels.height), leaf_(leaf_of(pixels)) {}

bool FoliageTexture::leaf_at(double u, double v) const {
  if (leaf_.empty()) return true;
  if (!std::isfinite(u) || !std::isfinite(v)) return false;
  const double x = (u - std::floor(u)) * width_ - 0.5, y = (1 - (v - std::floor(v))) * height_ - 0.5;
  const double fx = x - std::floor(x), fy = y - std::floor(y);
  const auto at = [&](int dx, int dy) {
    const int i = (static_cast<int>(std::floor(x)) + dx + width_) % width_, j = (static_cast<int>(std::floor(y)) + dy + height_) % height_;
    return double(leaf_[static_cast<std::size_t>(j) * width_ + i]);
  };
  return std::lerp(std::lerp(at(0, 0), at(1, 0), fx), std::lerp(at(0, 1), at(1, 1), fx), fy) >= 255 * kCut;
}

std::shared_ptr<const FoliageTexture> load_foliage_texture(const std::filesystem::path& path) {
  return std::make_shared<const FoliageTexture>(read_pixels(path));
}

}  // namespace cambium
