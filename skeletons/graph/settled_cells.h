// A grid that answers most questions of inside or outside at once: cells that no piece of the surface touches are all of one kind.
#pragma once

#include "blobtree/geometry.h"

#include <array>
#include <cstdint>
#include <functional>
#include <vector>

namespace cambium {

/// Immutable; used by threads at once. Memory: a byte a cell.
class SettledCells {
 public:
  enum class Kind : std::uint8_t { kOutside, kInside, kUnknown };

  SettledCells() = default;
  /// piece_box(i) of i < pieces: around the i-th piece of the surface; all are in `bounds`, which may be flat. About `wanted` cells.
  /// Cost: linear in both, and `inside` once for each row of cells between two pieces.
  SettledCells(const Box& bounds, std::size_t wanted, std::size_t pieces, const std::function<Box(std::size_t)>& piece_box,
               const std::function<bool(const Vec3&)>& inside);

  /// Outside of the bounds: kOutside.
  Kind at(const Vec3& p) const {
    const Vec3 place = (p - lo_) / cell_;
    if (!(place.x >= 0 && place.y >= 0 && place.z >= 0)) return Kind::kOutside;
    if (!(place.x < counts_[0] && place.y < counts_[1] && place.z < counts_[2])) return Kind::kOutside;
    return kinds_[index(static_cast<std::size_t>(place.x), static_cast<std::size_t>(place.y), static_cast<std::size_t>(place.z))];
  }

 private:
  std::size_t index(std::size_t x, std::size_t y, std::size_t z) const { return x + counts_[0] * (y + counts_[1] * z); }
  std::array<std::size_t, 3> cell_of(const Vec3& p) const;
  std::vector<std::uint8_t> touched(std::size_t pieces, const std::function<Box(std::size_t)>& piece_box) const;
  void settle(const std::vector<std::uint8_t>& touched, const std::function<bool(const Vec3&)>& inside);

  Vec3 lo_{0.0}, cell_{1.0};
  std::array<std::size_t, 3> counts_{};
  std::vector<Kind> kinds_;
};

}  // namespace cambium
