// The image and its auxiliary outputs, and writing them.
#pragma once

#include <filesystem>
#include <set>
#include <string>
#include <vector>

namespace cambium {

/// Row-major from the top left, linear light; each AOV is empty or width*height*channels floats.
struct Film {
  int width = 0, height = 0;
  std::vector<float> color;    ///< RGBA, 4 channels
  std::vector<float> depth;    ///< metres along the ray, infinity on a miss; 1 channel
  std::vector<float> normal;   ///< world, 3 channels
  std::vector<float> albedo;   ///< 3 channels
  std::vector<float> branch;   ///< branch id, -1 on a miss; 1 channel
};

/// format is ".png" (8 bit sRGB, tone mapped) or ".exr" (linear float, with the named AOVs "depth", "normal", "albedo", "branch"
/// as extra channels). For PNG each AOV is written beside as `<stem>.<aov>.png` by calling write_aov.
/// Errors: InputError for an unknown format or AOV, std::runtime_error naming the path if writing fails.
void write_image(const Film& film, const std::filesystem::path& path, const std::string& format,
                 const std::set<std::string>& aovs);
/// One AOV as an 8 bit PNG for looking at: depth normalised to its range, normals as 0.5 + 0.5 n.
void write_aov(const Film& film, const std::filesystem::path& path, const std::string& aov);

}  // namespace cambium
