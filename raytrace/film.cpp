#include "raytrace/film.h"

#include "blobtree/input_error.h"
#include "raytrace/image_file.h"
#include "raytrace/tone.h"

#include <algorithm>
#include <cmath>
#include <limits>

namespace cambium {
namespace {

struct Aov {
  const std::vector<float>* data = nullptr;
  std::vector<std::string> channels;
};

Aov aov_of(const Film& film, const std::string& name) {
  Aov aov;
  if (name == "depth") aov = {&film.depth, {"depth.Z"}};
  else if (name == "normal") aov = {&film.normal, {"normal.X", "normal.Y", "normal.Z"}};
  else if (name == "albedo") aov = {&film.albedo, {"albedo.R", "albedo.G", "albedo.B"}};
  else if (name == "branch") aov = {&film.branch, {"branch.id"}};
  else throw InputError({}, "'" + name + "'", "depth, normal, albedo or branch");
  if (aov.data->size() != std::size_t(film.width) * film.height * aov.channels.size()) {
    throw InputError({}, "a film without '" + name + "'", "a film rendered with it");
  }
  return aov;
}

/// A colour that tells neighbouring branch ids apart.
Vec3 id_color(float id) {
  const double hue = 6.283185307 * std::fmod(0.381966 * id, 1.0);
  return 0.55 + 0.4 * Vec3(std::cos(hue), std::cos(hue - 2.0944), std::cos(hue + 2.0944));
}

void append(Pixels& pixels, const Vec3& color) {
  for (int c = 0; c < 3; ++c) pixels.data.push_back(static_cast<float>(color[c]));
}

}  // namespace

void write_image(const Film& film, const std::filesystem::path& path, const std::string& format, const std::set<std::string>& aovs) {
  if (format != ".png" && format != ".exr") throw InputError({path.string(), 0, 0}, "'" + format + "'", ".png or .exr");
  const std::size_t count = std::size_t(film.width) * film.height;
  for (const std::string& name : aovs) aov_of(film, name);
  Pixels pixels{film.width, film.height, 3, {}, false};
  if (format == ".png") {
    pixels.data.reserve(3 * count);
    for (std::size_t i = 0; i < count; ++i) {
      append(pixels, display_from_linear({film.color[4 * i], film.color[4 * i + 1], film.color[4 * i + 2]}));
    }
    write_pixels(pixels, {"R", "G", "B"}, path, format);
    return;
  }
  std::vector<std::string> names{"R", "G", "B", "A"};
  std::vector<Aov> extra;
  for (const std::string& name : aovs) {
    extra.push_back(aov_of(film, name));
    names.insert(names.end(), extra.back().channels.begin(), extra.back().channels.end());
  }
  pixels.channels = static_cast<int>(names.size());
  pixels.data.reserve(names.size() * count);
  for (std::size_t i = 0; i < count; ++i) {
    pixels.data.insert(pixels.data.end(), film.color.begin() + 4 * i, film.color.begin() + 4 * i + 4);
    for (const Aov& aov : extra) {
      const std::size_t n = aov.channels.size();
      pixels.data.insert(pixels.data.end(), aov.data->begin() + n * i, aov.data->begin() + n * i + n);
    }
  }
  write_pixels(pixels, names, path, format);
}

void write_aov(const Film& film, const std::filesystem::path& path, const std::string& name) {
  const Aov aov = aov_of(film, name);
  const std::size_t count = std::size_t(film.width) * film.height;
  float near = std::numeric_limits<float>::infinity(), far = 0;
  if (name == "depth") {
    for (float d : *aov.data) {
      if (std::isfinite(d)) near = std::min(near, d), far = std::max(far, d);
    }
  }
  Pixels pixels{film.width, film.height, 3, {}, false};
  pixels.data.reserve(3 * count);
  for (std::size_t i = 0; i < count; ++i) {
    const std::vector<float>& v = *aov.data;
    if (name == "depth") {
      append(pixels, std::isfinite(v[i]) ? Vec3(1 - 0.9 * (v[i] - near) / std::max(far - near, 1e-9f)) : Vec3(0));
    } else if (name == "branch") {
      append(pixels, v[i] < 0 ? Vec3(0) : id_color(v[i]));
    } else {
      const Vec3 value(v[3 * i], v[3 * i + 1], v[3 * i + 2]);
      append(pixels, name == "normal" ? 0.5 + 0.5 * value
                                      : Vec3(srgb_from_linear(value.x), srgb_from_linear(value.y), srgb_from_linear(value.z)));
    }
  }
  write_pixels(pixels, {"R", "G", "B"}, path, ".png");
}

}  // namespace cambium
