// The finished picture with its auxiliary images, and writing them.
#pragma once

#include "raytrace/aov.h"
#include "raytrace/pixel_rect.h"

#include <cstdint>
#include <filesystem>
#include <map>
#include <set>
#include <string>
#include <vector>

namespace cambium {

/// A picture or a part of one. Row-major from the top left, linear light.
struct Film {
  int width = 0, height = 0;                     ///< of this part
  int x = 0, y = 0;                              ///< its place in the whole picture
  int full_width = 0, full_height = 0;           ///< of the whole
  std::vector<float> color;                      ///< RGBA, premultiplied; 4 channels
  bool transparent = false;                      ///< some of alpha is below 1, or may be
  std::map<Aov, std::vector<float>> aovs;        ///< those asked for: width * height * info_of(aov).channels values, see below
  std::set<std::int32_t> branches;               ///< in the cryptomatte

  std::size_t pixels() const { return std::size_t(width) * height; }
  /// Errors: InputError if the film was made without it.
  const std::vector<float>& aov(Aov aov) const;
};

// What the AOVs hold. Of the nearest hit in each pixel, so that they belong together: depth (metres along the ray, infinity where
// nothing was hit), position (world, metres), uv (bark coordinates), branch and order (-1 on ground and sky). Means over
// the samples that hit: normal (world, unit again), albedo, ridge, occlusion. Of all samples: samples (their number) and
// cryptomatte (matte_ranks).

struct ImageFormat {
  std::string extension = ".png";                ///< or ".jpg" or ".exr"
  int bits = 8;                                  ///< of a PNG's channel: 8 or 16
};

/// PNG: tone mapped, sRGB, with straight alpha if the film is transparent; JPEG likewise, without. EXR: linear; colour premultiplied, 16 bit float; every
/// AOV of the film in a layer of its own (AovInfo), with Cryptomatte's metadata; a part of a picture keeps its place in the whole
/// (data window). Errors: InputError for an unknown format or a transparent JPEG, std::runtime_error naming the path if writing fails.
void write_image(const Film& film, const std::filesystem::path& path, const ImageFormat& format);
/// One AOV as an 8 bit PNG for looking at: depth, position and samples over their range, normals as 0.5 + 0.5 n, uv modulo 1.
void write_aov(const Film& film, const std::filesystem::path& path, Aov aov);

}  // namespace cambium
