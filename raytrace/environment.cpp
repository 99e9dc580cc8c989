#include "raytrace/environment.h"

#include "blobtree/input_error.h"
#include "raytrace/tone.h"

#include <algorithm>
#include <cmath>
#include <numbers>
#include <string>

namespace cambium {
namespace {

constexpr double kPi = std::numbers::pi;

glm::vec3 linear_color(const Pixels& pixels, std::size_t i, double strength) {
  Vec3 color(0.0);
  for (int c = 0; c < 3; ++c) {
    const float value = pixels.data[i * pixels.channels + (pixels.channels < 3 ? 0 : c)];
    color[c] = pixels.srgb ? linear_from_srgb(std::clamp(double(value), 0.0, 1.0)) : std::max(0.0, double(value));
  }
  return glm::vec3(strength * color);
}

}  // namespace

Environment::Environment(const Pixels& pixels, double rotation, double strength)
    : width_(pixels.width), height_(pixels.height), rotation_(rotation), texels_(std::size_t(width_) * height_) {
  for (std::size_t i = 0; i < texels_.size(); ++i) texels_[i] = linear_color(pixels, i, strength);
  build_distribution();
}

const glm::vec3& Environment::texel(int column, int row) const {
  const int c = column < 0 ? column + width_ : column >= width_ ? column - width_ : column;
  return texels_[std::size_t(std::clamp(row, 0, height_ - 1)) * width_ + c];
}

Environment::Place Environment::place(const Vec3& direction) const {
  // Seen from within, a growing azimuth goes to the left.
  const double turns = (std::atan2(direction.y, direction.x) - rotation_) / (2 * kPi);
  const double u = 0.5 - turns, v = std::acos(std::clamp(direction.z, -1.0, 1.0)) / kPi;
  return {(u - std::floor(u)) * width_, v * height_};
}

std::size_t Environment::pixel(const Place& place) const {
  const auto column = std::min(static_cast<int>(place.column), width_ - 1), row = std::min(static_cast<int>(place.row), height_ - 1);
  return std::size_t(row) * width_ + column;
}

Vec3 Environment::radiance(const Vec3& direction) const {
  const Place at = place(direction);
  const double x = at.column - 0.5, y = at.row - 0.5;
  const int column = static_cast<int>(std::floor(x)), row = static_cast<int>(std::floor(y));
  const float s = static_cast<float>(x - column), t = static_cast<float>(y - row);
  return glm::mix(glm::mix(texel(column, row), texel(column + 1, row), s),
                  glm::mix(texel(column, row + 1), texel(column + 1, row + 1), s), t);
}

void Environment::build_distribution() {
  density_.resize(texels_.size());
  within_row_.resize(texels_.size());
  rows_.resize(height_);
  double total = 0;
  for (int row = 0; row < height_; ++row) {
    const double top = std::cos(kPi * row / height_), bottom = std::cos(kPi * (row + 1) / height_);
    const double solid_angle = 2 * kPi / width_ * (top - bottom);
    // Of the mean over the hemisphere by cosine, the share of one pixel.
    const double up = std::max(0.0, top), low = std::max(0.0, bottom), level_share = (up * up - low * low) / width_;
    double in_row = 0;
    for (int column = 0; column < width_; ++column) {
      // The mean of the bilinear interpolation over the pixel: an eighth of each neighbour in both directions.
      glm::vec3 mean(0.0f);
      constexpr float kShare[3] = {0.125f, 0.75f, 0.125f};
      for (int dy = -1; dy <= 1; ++dy) {
        for (int dx = -1; dx <= 1; ++dx) mean += kShare[dx + 1] * kShare[dy + 1] * texel(column + dx, row + dy);
      }
      const std::size_t i = std::size_t(row) * width_ + column;
      density_[i] = static_cast<float>(luminance(Vec3(mean)));
      on_level_ground_ += level_share * Vec3(mean);
      in_row += density_[i];
      within_row_[i] = static_cast<float>(in_row);
    }
    if (in_row > 0) {
      for (int column = 0; column < width_; ++column) within_row_[std::size_t(row) * width_ + column] /= static_cast<float>(in_row);
    }
    total += in_row * solid_angle;
    rows_[row] = total;
  }
  mean_luminance_ = total / (4 * kPi);
  if (!(total > 0)) return;
  for (double& share : rows_) share /= total;
  for (float& density : density_) density /= static_cast<float>(total);
}

LightSample Environment::sample(const std::array<double, 2>& sample) const {
  LightSample out;
  if (!(mean_luminance_ > 0)) return out;
  const auto row = static_cast<int>(std::min<std::ptrdiff_t>(std::upper_bound(rows_.begin(), rows_.end(), sample[1]) - rows_.begin(),
                                                             height_ - 1));
  const double row_begin = row > 0 ? rows_[row - 1] : 0, down = (sample[1] - row_begin) / (rows_[row] - row_begin);
  const auto begin = within_row_.begin() + std::ptrdiff_t(row) * width_, end = begin + width_;
  const auto column = static_cast<int>(std::min<std::ptrdiff_t>(
      std::upper_bound(begin, end, static_cast<float>(sample[0])) - begin, width_ - 1));
  const double pixel_begin = column > 0 ? begin[column - 1] : 0, pixel_end = begin[column];
  const double across = pixel_end > pixel_begin ? std::clamp((sample[0] - pixel_begin) / (pixel_end - pixel_begin), 0.0, 1.0) : 0.5;
  // Within a pixel all directions are alike: even in azimuth and in the cosine of the zenith distance.
  const double up = glm::mix(std::cos(kPi * row / height_), std::cos(kPi * (row + 1) / height_), std::clamp(down, 0.0, 1.0));
  const double azimuth = rotation_ + 2 * kPi * (0.5 - (column + across) / width_), flat = std::sqrt(std::max(0.0, 1 - up * up));
  out.direction = {flat * std::cos(azimuth), flat * std::sin(azimuth), up};
  out.radiance = radiance(out.direction);
  out.pdf = pdf(out.direction);
  return out;
}

double Environment::pdf(const Vec3& direction) const { return density_[pixel(place(direction))]; }

std::shared_ptr<const Environment> load_environment(const std::filesystem::path& path, double rotation, double strength) {
  const Pixels pixels = read_pixels(path);
  if (pixels.width != 2 * pixels.height) {
    throw InputError({path.string(), 0, 0}, "an image of " + std::to_string(pixels.width) + "x" + std::to_string(pixels.height) + " pixels",
                     "all directions by longitude and latitude, twice as wide as high");
  }
  return std::make_shared<const Environment>(pixels, rotation, strength);
}

}  // namespace cambium
