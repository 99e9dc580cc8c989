#include "raytrace/image_codec.h"

#include <OpenImageIO/imageio.h>

#include <algorithm>
#include <cmath>
#include <cstdint>
#include <limits>
#include <stdexcept>
#include <system_error>

namespace cambium {
namespace {

std::string first_line(std::string text) {
  text.erase(std::min(text.find('\n'), text.size()));
  return text.empty() ? "an unreadable file" : text;
}

OIIO::TypeDesc type_of(SampleType type) {
  switch (type) {
    case SampleType::kUint8:
      return OIIO::TypeDesc::UINT8;
    case SampleType::kUint16:
      return OIIO::TypeDesc::UINT16;
    case SampleType::kHalf:
      return OIIO::TypeDesc::HALF;
    case SampleType::kFloat:
      return OIIO::TypeDesc::FLOAT;
  }
  return OIIO::TypeDesc::FLOAT;
}

OIIO::ImageSpec display_spec(const Pixels& pixels, const ImageLayout& layout) {
  OIIO::ImageSpec spec(pixels.width, pixels.height, pixels.channels, type_of(layout.sample_types.front()));
  spec.channelnames = layout.channel_names;
  spec.attribute("oiio:ColorSpace", "sRGB");
  spec.attribute("oiio:UnassociatedAlpha", 1);  // the values are straight already
  spec.attribute("Compression", "jpeg:92");     // of a JPEG; a PNG knows no such name
  return spec;
}

OIIO::ImageSpec exr_spec(const Pixels& pixels, const ImageLayout& layout) {
  OIIO::ImageSpec spec(pixels.width, pixels.height, pixels.channels, OIIO::TypeDesc::FLOAT);
  spec.channelnames = layout.channel_names;
  for (const SampleType type : layout.sample_types) spec.channelformats.push_back(type_of(type));
  if (!layout.window.empty()) {
    spec.x = layout.window.x0;
    spec.y = layout.window.y0;
    spec.full_width = layout.full_width;
    spec.full_height = layout.full_height;
  }
  spec.attribute("compression", "zip");
  spec.attribute("DateTime", "2000:01:01 00:00:00");  // else the clock's: the same picture is the same file
  spec.attribute("oiio:ColorSpace", "Linear");
  for (const auto& [name, text] : layout.metadata) spec.attribute(name, text);
  return spec;
}

template <typename Integer>
std::vector<Integer> encoded(const Pixels& pixels) {
  constexpr float kMost = std::numeric_limits<Integer>::max();
  std::vector<Integer> values(pixels.data.size());
  std::transform(pixels.data.begin(), pixels.data.end(), values.begin(),
                 [](float v) { return static_cast<Integer>(std::lround(kMost * (v > 0 ? std::min(v, 1.0f) : 0.0f))); });
  return values;
}

Pixels read(const std::filesystem::path& path) {
  const auto fail = [](const std::string& found) { return std::runtime_error(found); };
  OIIO::ImageSpec wanted;
  wanted.attribute("oiio:UnassociatedAlpha", 1);
  const auto input = OIIO::ImageInput::open(path.string(), &wanted);
  if (!input) {
    OIIO::geterror();
    throw fail("a file that no image reader knows");
  }
  const OIIO::ImageSpec& spec = input->spec();
  if (spec.width < 1 || spec.height < 1 || spec.nchannels < 1) throw fail("an image without pixels");
  const double values = double(spec.width) * spec.height * spec.nchannels;
  if (values > 0x1p28) throw fail("an image of " + std::to_string(spec.width) + "x" + std::to_string(spec.height) + " pixels");
  Pixels pixels{spec.width, spec.height, std::min(spec.nchannels, 4), {}, spec.format.basetype != OIIO::TypeDesc::FLOAT &&
                                                                           spec.format.basetype != OIIO::TypeDesc::HALF};
  pixels.data.resize(std::size_t(pixels.width) * pixels.height * pixels.channels);
  if (!input->read_image(0, 0, 0, pixels.channels, OIIO::TypeDesc::FLOAT, pixels.data.data())) throw fail(first_line(input->geterror()));
  for (float& value : pixels.data) {
    if (!std::isfinite(value)) value = 0;
  }
  return pixels;
}

void write(const Pixels& pixels, const ImageLayout& layout, const std::filesystem::path& path, const std::string& format) {
  const bool exr = format == ".exr";
  // By format name, not by file name: the caller writes beside under a temporary name and renames.
  const auto output = OIIO::ImageOutput::create(exr ? "openexr" : format == ".jpg" ? "jpeg" : "png");
  if (!output) throw std::runtime_error("cannot write " + path.string() + ": OpenImageIO has no " + format + " writer");
  const OIIO::ImageSpec spec = exr ? exr_spec(pixels, layout) : display_spec(pixels, layout);
  if (!output->open(path.string(), spec)) throw std::runtime_error("cannot write " + path.string() + ": " + first_line(output->geterror()));
  const bool written = exr ? output->write_image(OIIO::TypeDesc::FLOAT, pixels.data.data())
                       : spec.format == OIIO::TypeDesc::UINT8
                           ? output->write_image(OIIO::TypeDesc::UINT8, encoded<std::uint8_t>(pixels).data())
                           : output->write_image(OIIO::TypeDesc::UINT16, encoded<std::uint16_t>(pixels).data());
  std::string trouble = written ? "" : first_line(output->geterror());
  if (!output->close() && trouble.empty()) trouble = first_line(output->geterror());
  if (trouble.empty()) return;
  std::error_code ignored;
  std::filesystem::remove(path, ignored);
  throw std::runtime_error("cannot write " + path.string() + ": " + trouble);
}

}  // namespace
}  // namespace cambium

extern "C" __attribute__((visibility("default"))) const cambium::ImageCodec* cambium_image_codec() {
  static const cambium::ImageCodec codec{sizeof(cambium::Pixels), sizeof(cambium::ImageLayout), &cambium::read, &cambium::write};
  return &codec;
}
