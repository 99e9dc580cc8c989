#include "raytrace/develop.h"

#include "raytrace/cryptomatte.h"
#include "raytrace/smoothing.h"

#include <tbb/parallel_for.h>

#include <algorithm>
#include <array>

namespace cambium {
namespace {

glm::vec3 unit_or_zero(const glm::vec3& v) {
  const float length = glm::length(v);
  return length > 0 ? v / length : glm::vec3(0.0f);
}

/// Mean over the samples that hit.
float hit_mean(float sum, const PixelSum& pixel) { return pixel.hits ? sum / pixel.hits : 0; }

AmbientPixel ambient_pixel(const PixelSum& sum, const Ray& middle) {
  AmbientPixel pixel;
  pixel.albedo = sum.albedo / float(sum.samples);
  pixel.lit = sum.lit / float(sum.samples);
  pixel.normal = unit_or_zero(sum.normal);
  pixel.from_eye = hit_mean(sum.depth, sum) * glm::vec3(middle.direction);
  pixel.light = sum.ambient;
  pixel.light_squared = sum.ambient_squared;
  pixel.hits = sum.hits;
  pixel.covered = sum.hit_share();
  return pixel;
}

/// The ambient part of each pixel's light over the crop.
std::vector<glm::vec3> ambient_light(const Frame& frame, const PixelRect& crop, const DevelopOptions& options) {
  const PixelRect area = developed_area(crop, frame.whole(), options.smooth);
  std::vector<AmbientPixel> pixels(area.size());
  tbb::parallel_for(area.y0, area.y1, [&](int y) {
    for (int x = area.x0; x < area.x1; ++x) pixels[area.index(x, y)] = ambient_pixel(frame.sum(x, y), options.view.ray(x + 0.5, y + 0.5));
  });
  std::vector<glm::vec3> light;
  if (options.smooth) light = smooth_ambient(pixels, area.width(), area.height(), options.view.pixel_angle());
  std::vector<glm::vec3> cut(crop.size());
  tbb::parallel_for(crop.y0, crop.y1, [&](int y) {
    for (int x = crop.x0; x < crop.x1; ++x) {
      const std::size_t i = area.index(x, y);
      cut[crop.index(x, y)] = options.smooth ? light[i] : pixels[i].lit;
    }
  });
  return cut;
}

void append(std::vector<float>& values, const glm::vec3& v) { values.insert(values.end(), {v.x, v.y, v.z}); }

void append_aov(std::vector<float>& values, Aov aov, const Frame& frame, int x, int y) {
  const PixelSum& sum = frame.sum(x, y);
  switch (aov) {
    case Aov::kNormal:
      return append(values, unit_or_zero(sum.normal));
    case Aov::kAlbedo:
      return append(values, sum.hits ? sum.albedo / float(sum.hits) : glm::vec3(0.0f));
    case Aov::kSamples:
      return values.push_back(sum.samples);
    default:
      break;
  }
  const FirstHitSum& first = frame.first_hits(x, y);
  switch (aov) {
    case Aov::kDepth:
      return values.push_back(first.depth);
    case Aov::kPosition:
      return append(values, first.position);
    case Aov::kUv:
      values.insert(values.end(), {first.uv.x, first.uv.y});
      return;
    case Aov::kBranch:
      return values.push_back(first.branch);
    case Aov::kOrder:
      return values.push_back(first.order);
    case Aov::kRidge:
      return values.push_back(hit_mean(first.ridge, sum));
    case Aov::kOcclusion:
      return values.push_back(hit_mean(first.occlusion, sum));
    case Aov::kCryptomatte: {
      const auto ranks = matte_ranks(first, sum.samples);
      values.insert(values.end(), ranks.begin(), ranks.end());
      return;
    }
    default:
      return;
  }
}

std::vector<float> aov_values(Aov aov, const Frame& frame, const PixelRect& crop) {
  std::vector<float> values;
  values.reserve(crop.size() * info_of(aov).channels.size());
  for (int y = crop.y0; y < crop.y1; ++y) {
    for (int x = crop.x0; x < crop.x1; ++x) append_aov(values, aov, frame, x, y);
  }
  return values;
}

std::set<std::int32_t> branches_in(const Frame& frame, const PixelRect& crop) {
  std::set<std::int32_t> branches;
  for (int y = crop.y0; y < crop.y1; ++y) {
    for (int x = crop.x0; x < crop.x1; ++x) {
      for (const BranchShare& share : frame.first_hits(x, y).shares) {
        if (share.samples > 0) branches.insert(share.branch);
      }
    }
  }
  return branches;
}

}  // namespace

PixelRect developed_area(const PixelRect& crop, const PixelRect& whole, bool smooth) {
  return crop.grown(smooth ? kSmoothingReach : 0).intersection(whole);
}

Film develop(const Frame& frame, const PixelRect& crop, const DevelopOptions& options) {
  Film film;
  film.width = crop.width();
  film.height = crop.height();
  film.x = crop.x0;
  film.y = crop.y0;
  film.full_width = frame.whole().width();
  film.full_height = frame.whole().height();
  film.transparent = options.transparent;
  const std::vector<glm::vec3> ambient = ambient_light(frame, crop, options);
  film.color.resize(4 * crop.size());
  tbb::parallel_for(crop.y0, crop.y1, [&](int y) {
    for (int x = crop.x0; x < crop.x1; ++x) {
      const PixelSum& sum = frame.sum(x, y);
      const std::size_t i = crop.index(x, y);
      const float n = sum.samples;
      const glm::vec3 light = static_cast<float>(options.exposure) * (sum.direct / n + ambient[i]);
      const std::array<float, 4> rgba{light.x, light.y, light.z, sum.alpha / n};
      std::ranges::copy(rgba, &film.color[4 * i]);
    }
  });
  for (const Aov aov : options.aovs) film.aovs.emplace(aov, aov_values(aov, frame, crop));
  if (options.aovs.contains(Aov::kCryptomatte)) film.branches = branches_in(frame, crop);
  return film;
}

}  // namespace cambium
