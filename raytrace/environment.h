// All that is around, as an image by longitude and latitude, sampled by how bright it is.
#pragma once

#include "blobtree/geometry.h"
#include "raytrace/image_file.h"

#include <array>
#include <filesystem>
#include <memory>
#include <vector>

namespace cambium {

/// A light's direction drawn for one point.
struct LightSample {
  Vec3 direction{0.0};          ///< unit, from the point
  double distance = kInfinity;  ///< metres to the light
  Vec3 radiance{0.0};
  double pdf = 0;               ///< by solid angle; 0: the light does not shine there
};

/// Directions drawn by a number for each pixel: even within one, by that number between them.
class PixelDistribution {
 public:
  PixelDistribution() = default;
  /// numbers: one per pixel, row-major, not negative; as by solid angle.
  PixelDistribution(int width, int height, std::vector<float> numbers);

  bool empty() const { return numbers_.empty(); }   ///< all numbers are 0
  /// Integral of the numbers over all directions.
  double total() const { return total_; }
  double pdf(std::size_t pixel) const { return numbers_[pixel] / total_; }
  /// Column and row, continuous. Within a pixel even by solid angle. Not of an empty one.
  std::array<double, 2> sample(const std::array<double, 2>& sample) const;

 private:
  int width_ = 0, height_ = 0;
  std::vector<float> numbers_;
  std::vector<float> within_row_;    ///< cumulated share of the row, up to and with each pixel
  std::vector<double> rows_;         ///< cumulated share, up to and with each row
  double total_ = 0;
};

/// What is much brighter than the image's mean (its sun, small lamps) is told apart as spots: they make sharp shadows, and only
/// light samples look for them. All the rest is even enough for rays to find.
class Environment {
 public:
  /// The top row is straight up; the middle of the image lies in the direction of `rotation` (radians, from x towards y). Negative
  /// values count as 0. Memory: 28 bytes a pixel.
  explicit Environment(const Pixels& pixels, double rotation = 0, double strength = 1);

  /// Bilinear between pixels: as it is seen, and without the spots.
  Vec3 radiance(const Vec3& direction) const;
  Vec3 even_radiance(const Vec3& direction) const;
  /// Of all that is no spot. even_pdf() by solid angle: each pixel's by the mean luminance within it, so 0 only where it is dark.
  LightSample sample_even(const std::array<double, 2>& sample) const;
  double even_pdf(const Vec3& direction) const;
  /// Spots are even within a pixel, so that the samples' light over their pdf is the same for all.
  bool has_spots() const { return !spots_.empty(); }
  LightSample sample_spots(const std::array<double, 2>& sample) const;

  /// Radiance averaged over the upper hemisphere by cosine: what a level white surface shows of all, and of the spots.
  const Vec3& on_level_ground() const { return on_level_ground_; }
  const Vec3& spots_on_level_ground() const { return spots_on_level_ground_; }

 private:
  struct Place {
    double column, row;   ///< in pixels, continuous
  };
  Place place(const Vec3& direction) const;
  Vec3 direction(const std::array<double, 2>& place) const;
  std::size_t pixel(const Place& place) const;
  glm::vec3 texel(int column, int row) const;
  glm::vec3 without_spot(const glm::vec3& color) const;
  glm::vec3 even_texel(int column, int row) const;
  glm::vec3 spot(std::size_t pixel) const;
  using Texel = glm::vec3 (Environment::*)(int column, int row) const;
  glm::vec3 bilinear(const Place& place, Texel part) const;
  glm::vec3 pixel_mean(int column, int row, Texel part) const;
  void find_spots();

  int width_ = 0, height_ = 0;
  double rotation_ = 0;
  std::vector<glm::vec3> texels_;
  float spot_luminance_ = 0;         ///< what is above is a spot's
  PixelDistribution even_, spots_;
  Vec3 on_level_ground_{0.0}, spots_on_level_ground_{0.0};
};

/// Errors: InputError naming the file if it is no image that is twice as wide as high.
std::shared_ptr<const Environment> load_environment(const std::filesystem::path& path, double rotation, double strength);

}  // namespace cambium
