#include "raytrace/image_file.h"

#include "blobtree/input_error.h"

#include <OpenImageIO/imageio.h>

#include <algorithm>
#include <cmath>
#include <cstdint>
#include <stdexcept>
#include <system_error>

namespace cambium {
namespace {

std::string first_line(std::string text) {
  text.erase(std::min(text.find('\n'), text.size()));
  return text.empty() ? "an unreadable file" : text;
}

}  // namespace

Pixels read_pixels(const std::filesystem::path& path) {
  const auto fail = [&](const std::string& found) -> InputError { return {{path.string(), 0, 0}, found, "an image file"}; };
  std::error_code error;
  if (!std::filesystem::exists(path, error)) throw fail("no such file");
  if (!std::filesystem::is_regular_file(path, error)) throw fail("something that is not a file");
  const auto input = OIIO::ImageInput::open(path.string());
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

void write_pixels(const Pixels& pixels, const std::vector<std::string>& channel_names, const std::filesystem::path& path,
                  const std::string& format) {
  const auto discard = [&](const std::string& why) {
    std::error_code ignored;
    std::filesystem::remove(path, ignored);
    throw std::runtime_error("cannot write " + path.string() + ": " + why);
  };
  // By format name, not by file name: the caller writes beside under a temporary name and renames.
  const auto output = OIIO::ImageOutput::create(format == ".png" ? "png" : "openexr");
  if (!output) throw std::runtime_error("cannot write " + path.string() + ": OpenImageIO has no " + format + " writer");
  const bool bytes = format == ".png";
  OIIO::ImageSpec spec(pixels.width, pixels.height, pixels.channels, bytes ? OIIO::TypeDesc::UINT8 : OIIO::TypeDesc::FLOAT);
  spec.channelnames = channel_names;
  if (bytes) {
    spec.attribute("oiio:ColorSpace", "sRGB");
  } else {
    spec.attribute("compression", "zip");
    spec.attribute("DateTime", "2000:01:01 00:00:00");  // else the clock's: the same picture is the same file
    spec.attribute("oiio:ColorSpace", "Linear");
  }
  if (!output->open(path.string(), spec)) throw std::runtime_error("cannot write " + path.string() + ": " + first_line(output->geterror()));
  bool written = false;
  if (bytes) {
    std::vector<std::uint8_t> encoded(pixels.data.size());
    std::transform(pixels.data.begin(), pixels.data.end(), encoded.begin(), [](float v) {
      return static_cast<std::uint8_t>(std::lround(255 * (v > 0 ? std::min(v, 1.0f) : 0.0f)));
    });
    written = output->write_image(OIIO::TypeDesc::UINT8, encoded.data());
  } else {
    written = output->write_image(OIIO::TypeDesc::FLOAT, pixels.data.data());
  }
  const std::string trouble = written ? "" : first_line(output->geterror());
  const bool closed = output->close();
  if (!written) discard(trouble);
  if (!closed) discard(first_line(output->geterror()));
}

}  // namespace cambium
