#include "raytrace/film.h"

#include "blobtree/input_error.h"
#include "raytrace/cryptomatte.h"
#include "raytrace/image_file.h"
#include "raytrace/tone.h"

namespace cambium {
namespace {

Vec3 straight(const float* rgba) {
  return rgba[3] > 0 ? Vec3(rgba[0], rgba[1], rgba[2]) / double(rgba[3]) : Vec3(0.0);
}

Pixels displayed(const Film& film) {
  Pixels pixels{film.width, film.height, film.transparent ? 4 : 3, {}};
  pixels.data.reserve(film.pixels() * pixels.channels);
  for (std::size_t i = 0; i < film.pixels(); ++i) {
    const float* rgba = &film.color[4 * i];
    const Vec3 shown = display_from_linear(film.transparent ? straight(rgba) : Vec3(rgba[0], rgba[1], rgba[2]));
    for (int c = 0; c < 3; ++c) pixels.data.push_back(static_cast<float>(shown[c]));
    if (film.transparent) pixels.data.push_back(rgba[3]);
  }
  return pixels;
}

struct Layer {
  const std::vector<float>& values;
  std::size_t channels;
};

Pixels interleaved(const Film& film, const std::vector<Layer>& layers) {
  Pixels pixels{film.width, film.height, 0, {}};
  for (const Layer& layer : layers) pixels.channels += static_cast<int>(layer.channels);
  pixels.data.reserve(film.pixels() * pixels.channels);
  for (std::size_t i = 0; i < film.pixels(); ++i) {
    for (const Layer& layer : layers) {
      const float* first = layer.values.data() + layer.channels * i;
      pixels.data.insert(pixels.data.end(), first, first + layer.channels);
    }
  }
  return pixels;
}

void write_exr(const Film& film, const std::filesystem::path& path) {
  std::vector<Layer> layers{{film.color, 4}};
  ImageLayout layout{.channel_names = {"R", "G", "B", "A"}, .sample_types = std::vector<SampleType>(4, SampleType::kHalf)};
  for (const auto& [aov, values] : film.aovs) {
    const AovInfo& info = info_of(aov);
    layers.push_back({values, info.channels.size()});
    layout.channel_names.insert(layout.channel_names.end(), info.channels.begin(), info.channels.end());
    layout.sample_types.insert(layout.sample_types.end(), info.channels.size(), info.full_float ? SampleType::kFloat : SampleType::kHalf);
    if (aov == Aov::kCryptomatte) layout.metadata = matte_metadata(kMatteLayer, film.branches);
  }
  layout.window = {film.x, film.y, film.x + film.width, film.y + film.height};
  layout.full_width = film.full_width;
  layout.full_height = film.full_height;
  write_pixels(interleaved(film, layers), layout, path, ".exr");
}

}  // namespace

const std::vector<float>& Film::aov(Aov aov) const {
  const auto found = aovs.find(aov);
  if (found != aovs.end() && found->second.size() == pixels() * info_of(aov).channels.size()) return found->second;
  throw InputError({}, "a film without '" + std::string(info_of(aov).name) + "'", "a film rendered with it");
}

void write_image(const Film& film, const std::filesystem::path& path, const ImageFormat& format) {
  if (format.extension == ".exr") return write_exr(film, path);
  if (format.extension != ".png" && format.extension != ".jpg") {
    throw InputError({path.string(), 0, 0}, "'" + format.extension + "'", ".png, .jpg or .exr");
  }
  if (format.extension == ".jpg" && film.transparent) throw InputError({path.string(), 0, 0}, "a transparent picture", ".png or .exr");
  const Pixels pixels = displayed(film);
  ImageLayout layout{.channel_names = {"R", "G", "B", "A"},
                     .sample_types = std::vector<SampleType>(pixels.channels, format.bits == 16 ? SampleType::kUint16 : SampleType::kUint8)};
  layout.channel_names.resize(pixels.channels);
  write_pixels(pixels, layout, path, format.extension);
}

}  // namespace cambium
