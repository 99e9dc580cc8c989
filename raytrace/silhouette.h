// Which pixels may show the surface at all.
#pragma once

#include "raytrace/pixel_rect.h"
#include "raytrace/view.h"

#include <cstdint>
#include <span>
#include <vector>

namespace cambium {

/// A flag for each pixel of a part of the picture.
class PixelMask {
 public:
  explicit PixelMask(const PixelRect& area) : area_(area), flags_(area.size()) {}

  const PixelRect& area() const { return area_; }
  bool test(int x, int y) const { return flags_[area_.index(x, y)] != 0; }
  void set(const PixelRect& part);  ///< what of it lies in the area

 private:
  PixelRect area_;
  std::vector<std::uint8_t> flags_;
};

/// True wherever a ray through the pixel, or `reach` pixels beside it, and through any point of the lens can meet one of the boxes
/// (and around them: each box counts as the rectangle it projects to). So a twig thinner than the rays' spacing is looked for where it can be, and the
/// sky need not be searched. Cost: the rectangles' pixels.
PixelMask silhouette(std::span<const Box> boxes, const View& view, const PixelRect& area, double reach);

}  // namespace cambium
