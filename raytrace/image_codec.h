// OpenImageIO as a plug-in, libcambium_image_codec.so: some 240 libraries come with it, and linking them takes a program longer than
// most of what it is started for. Private to raytrace/.
#pragma once

#include "raytrace/image_file.h"

#include <cstddef>

namespace cambium {

/// What the plug-in offers, by its only symbol.
struct ImageCodec {
  std::size_t size_of_pixels, size_of_layout;   ///< of whom it was built for
  /// Of a file that exists. Errors: std::runtime_error that says what was found instead of an image.
  Pixels (*read)(const std::filesystem::path& path);
  /// As write_pixels().
  void (*write)(const Pixels& pixels, const ImageLayout& layout, const std::filesystem::path& path, const std::string& format);
};

}  // namespace cambium

extern "C" const cambium::ImageCodec* cambium_image_codec();
