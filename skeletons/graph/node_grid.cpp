#include "skeletons/graph/node_grid.h"

#include <algorithm>
#include <cmath>

namespace cambium {
namespace {

constexpr double kNodesPerCubedSpacing = 0.65;   // what poisson_disc makes, away from the surface

Box around(std::span<const Vec3> positions) {
  Box box;
  for (const Vec3& p : positions) box.extend(p);
  return box;
}

}  // namespace

NodeGrid::NodeGrid(std::span<const Vec3> positions, double side) {
  if (positions.empty()) {
    first_.assign(2, 0);
    return;
  }
  const Box box = around(positions);
  lo_ = box.lo;
  for (;; side *= 2) {
    choose_side(box, positions.size(), side);
    side = side_;
    first_.assign(std::size_t(size_[0]) * std::size_t(size_[1]) * std::size_t(size_[2]) + 1, 0);
    for (const Vec3& p : positions) ++first_[index(cell_of(p)) + 1];
    filled_ = first_.size() - 1 - static_cast<std::size_t>(std::count(first_.begin() + 1, first_.end(), 0u));
    if (kFewest * static_cast<double>(filled_) <= static_cast<double>(positions.size()) || first_.size() == 2) break;
  }
  for (std::size_t c = 1; c < first_.size(); ++c) first_[c] += first_[c - 1];
  nodes_.resize(positions.size());
  for (std::size_t i = positions.size(); i-- > 0;)   // backwards, the ends of cells become their beginnings
    nodes_[--first_[index(cell_of(positions[i])) + 1]] = static_cast<std::uint32_t>(i);
  first_.erase(first_.begin());
  first_.push_back(static_cast<std::uint32_t>(positions.size()));
}

void NodeGrid::choose_side(const Box& box, std::size_t nodes, double side) {
  const Vec3 size = box.size();
  for (;; side *= 2) {
    double cells = 1;
    for (int k = 0; k < 3; ++k) cells *= std::floor(size[k] / side) + 1;
    if (cells <= 4 * static_cast<double>(nodes) + 1024) break;
  }
  side_ = side;
  per_metre_ = 1 / side;
  for (int k = 0; k < 3; ++k) size_[k] = static_cast<int>(size[k] / side) + 1;
}

double NodeGrid::natural_spacing() const {
  if (nodes_.empty()) return side_;
  const double per_cell = static_cast<double>(nodes_.size()) / static_cast<double>(filled_);
  return side_ * std::cbrt(kNodesPerCubedSpacing / per_cell);
}

double NodeGrid::clearance(const Vec3& p, const Cell& cell, int rings) const {
  double clearance = kInfinity;
  for (int k = 0; k < 3; ++k) {
    const double below = p[k] - (lo_[k] + side_ * cell[k]);
    if (cell[k] - rings > 0) clearance = std::min(clearance, below + rings * side_);
    if (cell[k] + rings < size_[k] - 1) clearance = std::min(clearance, (rings + 1) * side_ - below);
  }
  return clearance * (1 - 1e-12);   // less than what rounding may put into the next cell
}

}  // namespace cambium
