#include "skeletons/graph/settled_cells.h"

#include <algorithm>
#include <bit>
#include <cmath>

namespace cambium {

namespace {

/// Of cubes that about `wanted` of fill a box of this size, metres. Sides that are shorter than a cube do not count.
double cube_edge(const Vec3& size, double wanted) {
  bool counts[3] = {size.x > 0, size.y > 0, size.z > 0};
  while (true) {
    double content = 1;
    int sides = 0;
    for (int i = 0; i < 3; ++i)
      if (counts[i]) content *= size[i], ++sides;
    if (sides == 0) return 1;
    const double edge = std::pow(content / wanted, 1.0 / sides);
    bool all_long = true;
    for (int i = 0; i < 3; ++i)
      if (counts[i] && size[i] < edge) counts[i] = all_long = false;
    if (all_long) return edge;
  }
}

}  // namespace

SettledCells::SettledCells(const Box& bounds, std::size_t wanted, std::size_t pieces,
                           const std::function<Box(std::size_t)>& piece_box, const std::function<bool(const Vec3&)>& inside)
    : lo_(bounds.lo), cell_(1.0) {
  const Vec3 size = bounds.size();
  const double edge = cube_edge(size, static_cast<double>(wanted));
  for (int i = 0; i < 3; ++i) {
    const double count = std::max(std::ceil(size[i] / edge), 1.0);
    counts_[static_cast<std::size_t>(i)] = static_cast<std::size_t>(count);
    cell_[i] = size[i] > 0 ? size[i] * (1 + 1e-12) / count : 1.0;
  }
  settle(touched(pieces, piece_box), inside);
}

void SettledCells::settle(const std::vector<std::uint8_t>& touched, const std::function<bool(const Vec3&)>& inside) {
  kinds_.assign(touched.size(), Kind::kUnknown);
  for (std::size_t i = 0; i < kinds_.size(); ++i) {
    if (touched[i]) continue;
    const std::size_t x = i % counts_[0], y = i / counts_[0] % counts_[1], z = i / counts_[0] / counts_[1];
    if (x > 0 && !touched[i - 1]) {
      kinds_[i] = kinds_[i - 1];
    } else {
      kinds_[i] = inside(lo_ + cell_ * (Vec3(x, y, z) + 0.5)) ? Kind::kInside : Kind::kOutside;
    }
  }
}

std::array<std::size_t, 3> SettledCells::cell_of(const Vec3& p) const {
  std::array<std::size_t, 3> cell{};
  for (std::size_t i = 0; i < 3; ++i) {
    const int k = static_cast<int>(i);
    const double place = std::max((p[k] - lo_[k]) / cell_[k], 0.0);
    cell[i] = std::min(static_cast<std::size_t>(place), counts_[i] - 1);
  }
  return cell;
}

/// 1 for each cell that a piece's box is in. A box is added at its corners alone; sums along the axes then fill it.
std::vector<std::uint8_t> SettledCells::touched(std::size_t pieces, const std::function<Box(std::size_t)>& piece_box) const {
  std::vector<std::int64_t> sums(counts_[0] * counts_[1] * counts_[2], 0);
  for (std::size_t i = 0; i < pieces; ++i) {
    const Box box = piece_box(i);
    const Vec3 margin = 1e-9 * (glm::abs(box.lo) + glm::abs(box.hi) + box.size());   // rounding must not settle a cell that is touched
    const auto first = cell_of(box.lo - margin);
    auto beyond = cell_of(box.hi + margin);
    for (std::size_t& k : beyond) ++k;
    for (unsigned corner = 0; corner < 8; ++corner) {
      const std::size_t x = corner & 1 ? beyond[0] : first[0], y = corner & 2 ? beyond[1] : first[1], z = corner & 4 ? beyond[2] : first[2];
      if (x < counts_[0] && y < counts_[1] && z < counts_[2]) sums[index(x, y, z)] += std::popcount(corner) % 2 ? -1 : 1;
    }
  }
  const std::size_t steps[3] = {1, counts_[0], counts_[0] * counts_[1]};
  for (std::size_t axis = 0; axis < 3; ++axis)
    for (std::size_t i = 0; i < sums.size(); ++i)
      if (i / steps[axis] % counts_[axis] > 0) sums[i] += sums[i - steps[axis]];
  std::vector<std::uint8_t> touched(sums.size());
  std::transform(sums.begin(), sums.end(), touched.begin(), [](std::int64_t sum) { return static_cast<std::uint8_t>(sum > 0); });
  return touched;
}

}  // namespace cambium
