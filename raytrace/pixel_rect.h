// A part of a picture.
#pragma once

#include <algorithm>
#include <cstddef>

namespace cambium {

/// Half-open, in pixels from the top left of the whole picture.
struct PixelRect {
  int x0 = 0, y0 = 0, x1 = 0, y1 = 0;

  int width() const { return x1 - x0; }
  int height() const { return y1 - y0; }
  bool empty() const { return x1 <= x0 || y1 <= y0; }
  std::size_t size() const { return empty() ? 0 : std::size_t(width()) * height(); }
  bool contains(int x, int y) const { return x >= x0 && x < x1 && y >= y0 && y < y1; }
  bool contains(const PixelRect& other) const {
    return other.x0 >= x0 && other.y0 >= y0 && other.x1 <= x1 && other.y1 <= y1;
  }
  /// Place of a pixel in a row-major array over this part.
  std::size_t index(int x, int y) const { return std::size_t(y - y0) * width() + (x - x0); }

  PixelRect grown(int margin) const { return {x0 - margin, y0 - margin, x1 + margin, y1 + margin}; }
  PixelRect intersection(const PixelRect& other) const {
    return {std::max(x0, other.x0), std::max(y0, other.y0), std::min(x1, other.x1), std::min(y1, other.y1)};
  }
  friend bool operator==(const PixelRect&, const PixelRect&) = default;
};

}  // namespace cambium
