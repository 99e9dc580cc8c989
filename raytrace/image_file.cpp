#include "raytrace/image_file.h"

#include "blobtree/input_error.h"
#include "raytrace/image_codec.h"

#include <dlfcn.h>

#include <stdexcept>
#include <system_error>

namespace cambium {
namespace {

constexpr const char* kPlugIn = "libcambium_image_codec.so";

/// Null, with the reason, where it cannot be loaded or was built for another Cambium.
const ImageCodec* load_codec(const char* file, std::string& trouble) {
  void* const library = dlopen(file, RTLD_NOW | RTLD_LOCAL);
  const auto offered = library ? reinterpret_cast<decltype(&cambium_image_codec)>(dlsym(library, "cambium_image_codec")) : nullptr;
  if (!offered) {
    trouble += std::string(trouble.empty() ? "" : "; ") + dlerror();
    return nullptr;
  }
  const ImageCodec* const codec = offered();
  if (codec->size_of_pixels == sizeof(Pixels) && codec->size_of_layout == sizeof(ImageLayout)) return codec;
  trouble += std::string(trouble.empty() ? "" : "; ") + file + " is of another version";
  return nullptr;
}

/// The one on the program's search path, or beside which this was built.
const ImageCodec& codec() {
  static const ImageCodec* const loaded = [] {
    std::string trouble;
    for (const char* file : {kPlugIn, CAMBIUM_IMAGE_CODEC})
      if (const ImageCodec* const found = load_codec(file, trouble)) return found;
    throw std::runtime_error("images cannot be read or written: " + trouble);
  }();
  return *loaded;
}

}  // namespace

void require_image_files() { codec(); }

Pixels read_pixels(const std::filesystem::path& path) {
  const auto fail = [&](const std::string& found) -> InputError { return {{path.string(), 0, 0}, found, "an image file"}; };
  std::error_code error;
  if (!std::filesystem::exists(path, error)) throw fail("no such file");
  if (!std::filesystem::is_regular_file(path, error)) throw fail("something that is not a file");
  const ImageCodec& images = codec();
  try {
    return images.read(path);
  } catch (const std::runtime_error& trouble) {
    throw fail(trouble.what());
  }
}

void write_pixels(const Pixels& pixels, const ImageLayout& layout, const std::filesystem::path& path, const std::string& format) {
  codec().write(pixels, layout, path, format);
}

}  // namespace cambium
