#include "lsystem/skeleton_pen.h"

#include <algorithm>
#include <limits>
#include <optional>

namespace cambium {
namespace {

// A position counts as that of a node within this part of its coordinates: `f(1)|f(1)` comes back to it but for rounding.
constexpr double kSamePlace = 1e-9;

}  // namespace

void SkeletonPen::lift(Place& place) {
  place.start = static_cast<std::uint32_t>(starts_.size());
  starts_.push_back(-1);
}

bool SkeletonPen::full() const {
  // A piece that begins adds two.
  return skeleton_.nodes.size() + 2 > static_cast<std::size_t>(std::numeric_limits<std::int32_t>::max());
}

bool SkeletonPen::stands_at(std::int32_t node, const Vec3& position) const {
  if (node < 0) return false;
  const Vec3& p = skeleton_.nodes[static_cast<std::size_t>(node)].position;
  return glm::length(p - position) <= kSamePlace * (1.0 + glm::length(p));
}

std::int32_t SkeletonPen::add(const SkeletonNode& node) {
  skeleton_.nodes.push_back(node);
  return static_cast<std::int32_t>(skeleton_.nodes.size() - 1);
}

std::int32_t SkeletonPen::node_at(const Place& place, const Vec3& from) const {
  if (stands_at(place.node, from)) return place.node;
  return stands_at(starts_[place.start], from) ? starts_[place.start] : -1;
}

void SkeletonPen::draw(Place& place, const AxisSample& from, const AxisSample& tip) {
  bool lateral = place.lateral;
  std::int32_t parent = node_at(place, from.position);
  if (parent < 0) {
    parent = add({from.position, from.radius, -1, std::nullopt, std::nullopt});
    start_at(place, parent);
    lateral = false;
  }
  const double parent_radius = skeleton_.nodes[static_cast<std::size_t>(parent)].radius;
  if (std::max(from.radius, tip.radius) > parent_radius) ++radii_clamped_;
  place.node =
      add({tip.position, std::min(tip.radius, parent_radius), parent, std::min(from.radius, parent_radius), lateral});
  place.lateral = false;
}

}  // namespace cambium
