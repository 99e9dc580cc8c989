#include "raytrace/silhouette.h"

#include <algorithm>
#include <cmath>

namespace cambium {
namespace {

/// The pixels that a box projects into; everything if it reaches behind the eye.
PixelRect projection(const Box& box, const View& view, double reach) {
  const double width = view.width, height = view.height;
  double left = width, right = 0, top = height, bottom = 0;
  for (int corner = 0; corner < 8; ++corner) {
    const Vec3 p{corner & 1 ? box.hi.x : box.lo.x, corner & 2 ? box.hi.y : box.lo.y, corner & 4 ? box.hi.z : box.lo.z};
    const Vec3 from_eye = p - view.eye;
    const double depth = glm::dot(from_eye, view.forward);
    if (!(depth > 0)) return {0, 0, view.width, view.height};
    const double x = 0.5 * width * (1 + glm::dot(from_eye, view.right) / (depth * view.tan_x));
    const double y = 0.5 * height * (1 - glm::dot(from_eye, view.up) / (depth * view.tan_y));
    left = std::min(left, x), right = std::max(right, x);
    top = std::min(top, y), bottom = std::max(bottom, y);
  }
  // A pixel's middle lies half a pixel from its corner.
  const auto pixel = [](double at, double size) { return static_cast<int>(std::clamp(std::floor(at), -1.0, size)); };
  return {pixel(left - reach - 0.5, width), pixel(top - reach - 0.5, height), pixel(right + reach + 0.5, width) + 1,
          pixel(bottom + reach + 0.5, height) + 1};
}

}  // namespace

void PixelMask::set(const PixelRect& part) {
  const PixelRect within = part.intersection(area_);
  if (within.empty()) return;
  for (int y = within.y0; y < within.y1; ++y) {
    std::fill_n(flags_.begin() + static_cast<std::ptrdiff_t>(area_.index(within.x0, y)), within.width(), std::uint8_t{1});
  }
}

PixelMask silhouette(std::span<const Box> boxes, const View& view, const PixelRect& area, double reach) {
  PixelMask mask(area);
  for (const Box& box : boxes) mask.set(projection(box, view, reach));
  return mask;
}

}  // namespace cambium
