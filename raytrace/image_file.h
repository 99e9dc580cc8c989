// Image files in and out; OpenImageIO stays behind this.
#pragma once

#include "raytrace/pixel_rect.h"

#include <filesystem>
#include <string>
#include <utility>
#include <vector>

namespace cambium {

/// Loads what reads and writes images, the plug-in libcambium_image_codec.so, unless it is there already: the functions below do it
/// too, but perhaps after minutes of work. Errors, also theirs: std::runtime_error if it cannot be found.
void require_image_files();

/// Row-major from the top left.
struct Pixels {
  int width = 0, height = 0, channels = 0;
  std::vector<float> data;
  bool srgb = false;                 ///< the values are sRGB-encoded (8 and 16 bit files), not linear
};

/// Colours are straight: not multiplied with an alpha channel, unless the format knows them no other way (EXR).
/// Errors: InputError naming the file if it is missing, not an image, empty or larger than 2^28 values.
Pixels read_pixels(const std::filesystem::path& path);

enum class SampleType { kUint8, kUint16, kHalf, kFloat };

/// How pixels lie in a file.
struct ImageLayout {
  std::vector<std::string> channel_names;   ///< one per channel
  std::vector<SampleType> sample_types;     ///< likewise; all alike in a PNG: kUint8 or kUint16
  PixelRect window{};                       ///< of an EXR: where the pixels lie in the whole picture; empty: they are the whole
  int full_width = 0, full_height = 0;      ///< of the whole picture
  std::vector<std::pair<std::string, std::string>> metadata{};  ///< of an EXR: names and texts
};

/// Writes to exactly `path`, whose name may have any ending. format: ".png" or ".jpg" (data in [0, 1], rounded; sRGB; of a JPEG
/// three channels of 8 bits) or ".exr" (linear).
/// Errors: std::runtime_error naming the path; then no file is left.
void write_pixels(const Pixels& pixels, const ImageLayout& layout, const std::filesystem::path& path, const std::string& format);

}  // namespace cambium
