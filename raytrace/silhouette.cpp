#include "raytrace/silhouette.h"

#include <algorithm>
#include <cmath>

namespace cambium {
namespace {

/// How far off, as a tangent, a point at that depth may be seen from the lens's rim (the circle of confusion).
double blur(const View& view, double depth) { return view.lens_radius * std::abs(1 / view.focus_distance - 1 / depth); }

/// The pixel at `place`, from -1 to 1 over `size` pixels, and some pixels further; at most one off the picture.
int pixel_at(double place, int size, double further) {
  return static_cast<int>(std::clamp(std::floor(0.5 * size * (1 + place) + further), -1.0, double(size)));
}

/// The pixels that a box projects into; everything if it reaches behind the eye.
PixelRect projection(const Box& box, const View& view, double reach) {
  double left = kInfinity, right = -kInfinity, top = kInfinity, bottom = -kInfinity;  // tangents
  for (int corner = 0; corner < 8; ++corner) {
    const Vec3 p{corner & 1 ? box.hi.x : box.lo.x, corner & 2 ? box.hi.y : box.lo.y, corner & 4 ? box.hi.z : box.lo.z};
    const Vec3 from_eye = p - view.eye;
    const double depth = glm::dot(from_eye, view.forward);
    if (!(depth > 0)) return {0, 0, view.width, view.height};
    const double x = glm::dot(from_eye, view.right) / depth, y = -glm::dot(from_eye, view.up) / depth, around = blur(view, depth);
    left = std::min(left, x - around), right = std::max(right, x + around);
    top = std::min(top, y - around), bottom = std::max(bottom, y + around);
  }
  // A pixel's middle lies half a pixel from its corner.
  const auto first = [&](double tangent, double most, int size) { return pixel_at(tangent / most, size, -reach - 0.5); };
  const auto last = [&](double tangent, double most, int size) { return pixel_at(tangent / most, size, reach + 0.5); };
  return {first(left, view.tan_x, view.width), first(top, view.tan_y, view.height), last(right, view.tan_x, view.width) + 1,
          last(bottom, view.tan_y, view.height) + 1};
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
