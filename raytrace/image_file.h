// Image files in and out; OpenImageIO stays behind this.
#pragma once

#include <filesystem>
#include <string>
#include <vector>

namespace cambium {

/// Row-major from the top left.
struct Pixels {
  int width = 0, height = 0, channels = 0;
  std::vector<float> data;
  bool srgb = false;                 ///< the values are sRGB-encoded (8 and 16 bit files), not linear
};

/// Errors: InputError naming the file if it is missing, not an image, empty or larger than 2^28 values.
Pixels read_pixels(const std::filesystem::path& path);

/// Writes to exactly `path`, whose name may have any ending. format: ".png" (data in [0, 1], 8 bit, rounded) or ".exr" (float).
/// channel_names: one per channel. Errors: std::runtime_error naming the path; then no file is left.
void write_pixels(const Pixels& pixels, const std::vector<std::string>& channel_names, const std::filesystem::path& path,
                  const std::string& format);

}  // namespace cambium
