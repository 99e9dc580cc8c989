// The AOVs as pictures for looking at.
#include "raytrace/cryptomatte.h"
#include "raytrace/film.h"
#include "raytrace/image_file.h"
#include "raytrace/tone.h"

#include <bit>
#include <limits>

namespace cambium {
namespace {

/// A colour that tells neighbouring ids apart.
Vec3 id_color(double id) {
  const double hue = 6.283185307 * std::fmod(0.381966 * id, 1.0);
  return 0.55 + 0.4 * Vec3(std::cos(hue), std::cos(hue - 2.0944), std::cos(hue + 2.0944));
}

struct Range {
  float low = std::numeric_limits<float>::infinity(), high = -std::numeric_limits<float>::infinity();
  void add(float value) {
    if (std::isfinite(value)) low = std::min(low, value), high = std::max(high, value);
  }
  double share(float value) const { return high > low ? double(value - low) / (high - low) : 0; }
};

Vec3 matte_color(const float* ranks) {
  Vec3 color(0.0);
  for (int rank = 0; rank < kMatteRanks; ++rank) {
    const auto bits = std::bit_cast<std::uint32_t>(ranks[2 * rank]);
    color += double(ranks[2 * rank + 1]) * id_color(double(bits & 0xffffu));
  }
  return color;
}

/// From one pixel's values to a colour in [0, 1].
Vec3 preview(Aov aov, const float* v, const std::vector<Range>& ranges) {
  switch (aov) {
    case Aov::kDepth:
      return std::isfinite(v[0]) ? Vec3(1 - 0.9 * ranges[0].share(v[0])) : Vec3(0.0);
    case Aov::kPosition:
      return {ranges[0].share(v[0]), ranges[1].share(v[1]), ranges[2].share(v[2])};
    case Aov::kNormal:
      return 0.5 + 0.5 * Vec3(v[0], v[1], v[2]);
    case Aov::kAlbedo:
      return {srgb_from_linear(v[0]), srgb_from_linear(v[1]), srgb_from_linear(v[2])};
    case Aov::kUv:
      return {v[0] - std::floor(v[0]), v[1] - std::floor(v[1]), 0};
    case Aov::kBranch:
    case Aov::kOrder:
      return v[0] < 0 ? Vec3(0.0) : id_color(v[0]);
    case Aov::kRidge:
    case Aov::kOcclusion:
      return Vec3(v[0]);
    case Aov::kSamples:
      return Vec3(ranges[0].high > 0 ? v[0] / ranges[0].high : 0);
    case Aov::kCryptomatte:
      return matte_color(v);
  }
  return Vec3(0.0);
}

}  // namespace

void write_aov(const Film& film, const std::filesystem::path& path, Aov aov) {
  const std::vector<float>& values = film.aov(aov);
  const std::size_t channels = info_of(aov).channels.size();
  std::vector<Range> ranges(channels);
  for (std::size_t i = 0; i < values.size(); ++i) ranges[i % channels].add(values[i]);
  Pixels pixels{film.width, film.height, 3, {}};
  pixels.data.reserve(3 * film.pixels());
  for (std::size_t i = 0; i < film.pixels(); ++i) {
    const Vec3 color = preview(aov, &values[channels * i], ranges);
    for (int c = 0; c < 3; ++c) pixels.data.push_back(static_cast<float>(color[c]));
  }
  write_pixels(pixels, {.channel_names = {"R", "G", "B"}, .sample_types = std::vector<SampleType>(3, SampleType::kUint8)}, path, ".png");
}

}  // namespace cambium
