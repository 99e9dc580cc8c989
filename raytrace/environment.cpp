#include "raytrace/environment.h"

#include "blobtree/input_error.h"
#include "raytrace/directions.h"
#include "raytrace/tone.h"

#include <algorithm>
#include <cmath>
#include <functional>
#include <numbers>
#include <numeric>
#include <string>
#include <utility>

namespace cambium {
namespace {

constexpr double kPi = std::numbers::pi;
constexpr double kSpotContrast = 30;   // times the mean luminance: above what clouds and windows have, below any sun

float brightness(const glm::vec3& linear) { return static_cast<float>(luminance(Vec3(linear))); }

double pixel_solid_angle(int row, int width, int height) {
  return 2 * kPi / width * (std::cos(kPi * row / height) - std::cos(kPi * (row + 1) / height));
}

glm::vec3 linear_color(const Pixels& pixels, std::size_t i, double strength) {
  Vec3 color(0.0);
  for (int c = 0; c < 3; ++c) {
    const float value = pixels.data[i * pixels.channels + (pixels.channels < 3 ? 0 : c)];
    color[c] = pixels.srgb ? linear_from_srgb(std::clamp(double(value), 0.0, 1.0)) : std::max(0.0, double(value));
  }
  return glm::vec3(strength * color);
}

}  // namespace

PixelDistribution::PixelDistribution(int width, int height, std::vector<float> numbers)
    : width_(width), height_(height), numbers_(std::move(numbers)), within_row_(numbers_), rows_(height) {
  for (int row = 0; row < height_; ++row) {
    const auto begin = within_row_.begin() + std::ptrdiff_t(row) * width_, end = begin + width_;
    std::inclusive_scan(begin, end, begin, std::plus<>(), 0.0);
    const float in_row = *(end - 1);
    if (in_row > 0) std::transform(begin, end, begin, [in_row](float sum) { return sum / in_row; });
    rows_[row] = total_ += in_row * pixel_solid_angle(row, width_, height_);
  }
  if (!(total_ > 0)) {
    *this = PixelDistribution();
    return;
  }
  for (double& sum : rows_) sum /= total_;
}

std::array<double, 2> PixelDistribution::sample(const std::array<double, 2>& sample) const {
  const auto row = std::min<std::ptrdiff_t>(std::upper_bound(rows_.begin(), rows_.end(), sample[1]) - rows_.begin(), height_ - 1);
  const double above = row > 0 ? rows_[row - 1] : 0, down = rows_[row] > above ? (sample[1] - above) / (rows_[row] - above) : 0.5;
  const auto begin = within_row_.begin() + row * width_;
  const auto column = std::min<std::ptrdiff_t>(
      std::upper_bound(begin, begin + width_, static_cast<float>(sample[0])) - begin, width_ - 1);
  const double before = column > 0 ? begin[column - 1] : 0, until = begin[column];
  const double across = until > before ? std::clamp((sample[0] - before) / (until - before), 0.0, 1.0) : 0.5;
  // Down a pixel, even in the cosine of the zenith distance.
  const double top = std::cos(kPi * double(row) / height_), bottom = std::cos(kPi * double(row + 1) / height_);
  const double up = std::clamp(glm::mix(top, bottom, std::clamp(down, 0.0, 1.0)), -1.0, 1.0);
  return {double(column) + across, std::acos(up) / kPi * height_};
}

Environment::Environment(const Pixels& pixels, double rotation, double strength)
    : width_(pixels.width), height_(pixels.height), rotation_(rotation), texels_(std::size_t(width_) * height_) {
  for (std::size_t i = 0; i < texels_.size(); ++i) texels_[i] = linear_color(pixels, i, strength);
  find_spots();
}

glm::vec3 Environment::texel(int column, int row) const {
  const int c = column < 0 ? column + width_ : column >= width_ ? column - width_ : column;
  return texels_[std::size_t(std::clamp(row, 0, height_ - 1)) * width_ + c];
}

glm::vec3 Environment::without_spot(const glm::vec3& color) const {
  const float bright = brightness(color);
  return bright > spot_luminance_ ? color * (spot_luminance_ / bright) : color;
}

glm::vec3 Environment::even_texel(int column, int row) const { return without_spot(texel(column, row)); }

glm::vec3 Environment::spot(std::size_t pixel) const { return texels_[pixel] - without_spot(texels_[pixel]); }

Environment::Place Environment::place(const Vec3& direction) const {
  // Seen from within, a growing azimuth goes to the left.
  const double turns = (std::atan2(direction.y, direction.x) - rotation_) / (2 * kPi);
  const double u = 0.5 - turns, v = std::acos(std::clamp(direction.z, -1.0, 1.0)) / kPi;
  return {(u - std::floor(u)) * width_, v * height_};
}

Vec3 Environment::direction(const std::array<double, 2>& place) const {
  return direction_of(rotation_ + 2 * kPi * (0.5 - place[0] / width_), kPi * (0.5 - place[1] / height_));
}

std::size_t Environment::pixel(const Place& place) const {
  const int column = std::min(static_cast<int>(place.column), width_ - 1), row = std::min(static_cast<int>(place.row), height_ - 1);
  return std::size_t(row) * width_ + column;
}

glm::vec3 Environment::bilinear(const Place& at, Texel part) const {
  const double x = at.column - 0.5, y = at.row - 0.5;
  const int column = static_cast<int>(std::floor(x)), row = static_cast<int>(std::floor(y));
  const float s = static_cast<float>(x - column), t = static_cast<float>(y - row);
  const auto between = [&](int at_row) { return glm::mix((this->*part)(column, at_row), (this->*part)(column + 1, at_row), s); };
  return glm::mix(between(row), between(row + 1), t);
}

/// Of the bilinear interpolation over one pixel: an eighth of each neighbour in both directions.
glm::vec3 Environment::pixel_mean(int column, int row, Texel part) const {
  constexpr float kShare[3] = {0.125f, 0.75f, 0.125f};
  glm::vec3 mean(0.0f);
  for (int dy = -1; dy <= 1; ++dy) {
    for (int dx = -1; dx <= 1; ++dx) mean += kShare[dx + 1] * kShare[dy + 1] * (this->*part)(column + dx, row + dy);
  }
  return mean;
}

void Environment::find_spots() {
  double light = 0;
  for (std::size_t i = 0; i < texels_.size(); ++i) {
    light += brightness(texels_[i]) * pixel_solid_angle(static_cast<int>(i / width_), width_, height_);
  }
  spot_luminance_ = static_cast<float>(kSpotContrast * light / (4 * kPi));
  std::vector<float> even(texels_.size()), spots(texels_.size());
  for (int row = 0; row < height_; ++row) {
    const double top = std::max(0.0, std::cos(kPi * row / height_)), bottom = std::max(0.0, std::cos(kPi * (row + 1) / height_));
    const double level_share = (top * top - bottom * bottom) / width_;   // of the hemisphere by cosine
    for (int column = 0; column < width_; ++column) {
      const std::size_t i = std::size_t(row) * width_ + column;
      const glm::vec3 rest = pixel_mean(column, row, &Environment::even_texel);
      on_level_ground_ += level_share * Vec3(rest + spot(i));
      spots_on_level_ground_ += level_share * Vec3(spot(i));
      even[i] = brightness(rest);
      spots[i] = brightness(spot(i));
    }
  }
  even_ = PixelDistribution(width_, height_, std::move(even));
  spots_ = PixelDistribution(width_, height_, std::move(spots));
}

Vec3 Environment::radiance(const Vec3& direction) const { return bilinear(place(direction), &Environment::texel); }

Vec3 Environment::even_radiance(const Vec3& direction) const { return bilinear(place(direction), &Environment::even_texel); }

double Environment::even_pdf(const Vec3& direction) const { return even_.empty() ? 0 : even_.pdf(pixel(place(direction))); }

LightSample Environment::sample_even(const std::array<double, 2>& sample) const {
  if (even_.empty()) return {};
  const Vec3 towards = direction(even_.sample(sample));
  return {towards, kInfinity, even_radiance(towards), even_pdf(towards)};
}

LightSample Environment::sample_spots(const std::array<double, 2>& sample) const {
  if (spots_.empty()) return {};
  const Vec3 towards = direction(spots_.sample(sample));
  const std::size_t found = pixel(place(towards));
  return {towards, kInfinity, Vec3(spot(found)), spots_.pdf(found)};
}

std::shared_ptr<const Environment> load_environment(const std::filesystem::path& path, double rotation, double strength) {
  const Pixels pixels = read_pixels(path);
  if (pixels.width != 2 * pixels.height) {
    throw InputError({path.string(), 0, 0}, "an image of " + std::to_string(pixels.width) + "x" + std::to_string(pixels.height) + " pixels",
                     "all directions by longitude and latitude, twice as wide as high");
  }
  return std::make_shared<const Environment>(pixels, rotation, strength);
}

}  // namespace cambium
