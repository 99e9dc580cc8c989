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

class Environment {
 public:
  /// The top row is straight up; the middle of the image lies in the direction of `rotation` (radians, from x towards y). Negative
  /// values count as 0. Memory: 16 bytes a pixel.
  explicit Environment(const Pixels& pixels, double rotation = 0, double strength = 1);

  /// Bilinear between pixels.
  Vec3 radiance(const Vec3& direction) const;
  LightSample sample(const std::array<double, 2>& sample) const;
  /// Of sample()'s directions, by solid angle: each pixel's, by the mean luminance within it. It may be 0 only where there is no
  /// light.
  double pdf(const Vec3& direction) const;
  /// Luminance averaged over all directions.
  double mean_luminance() const { return mean_luminance_; }
  /// Radiance averaged over the upper hemisphere by cosine: what a level white surface shows.
  const Vec3& on_level_ground() const { return on_level_ground_; }

 private:
  struct Place {
    double column, row;   ///< in pixels, continuous
  };
  Place place(const Vec3& direction) const;
  std::size_t pixel(const Place& place) const;
  const glm::vec3& texel(int column, int row) const;
  void build_distribution();

  int width_ = 0, height_ = 0;
  double rotation_ = 0;
  std::vector<glm::vec3> texels_;
  std::vector<float> density_;       ///< per pixel: pdf by solid angle
  std::vector<float> within_row_;    ///< per row: cumulated share up to and with each pixel
  std::vector<double> rows_;         ///< cumulated share up to and with each row
  double mean_luminance_ = 0;
  Vec3 on_level_ground_{0.0};
};

/// Errors: InputError naming the file if it is no image that is twice as wide as high.
std::shared_ptr<const Environment> load_environment(const std::filesystem::path& path, double rotation, double strength);

}  // namespace cambium
