#include "polygonize/crossing_guard.h"

#include "polygonize/box_tree.h"
#include "polygonize/triangle_contact.h"

#include <algorithm>

namespace cambium {
namespace {

constexpr double kFacing = 0.1;   // cosine: what faces a direction, rounding included

}  // namespace

CrossingGuard::CrossingGuard(const std::vector<Vec3>& positions, std::vector<Corners> triangles)
    : positions_(positions), triangles_(std::move(triangles)), normals_(triangles_.size()), gone_(triangles_.size(), 0),
      live_(triangles_.size()), slots_(triangles_.size()) {
  for (std::size_t i = 0; i < triangles_.size(); ++i) normals_[i] = glm::vec3(glm::normalize(area_of(triangles_[i])));
  build();
}

FloatBox CrossingGuard::bounds_of(const Corners& corners) const {
  Box box;
  for (const std::uint32_t v : corners) box.extend(positions_[v]);
  return FloatBox(box);
}

Vec3 CrossingGuard::area_of(const Corners& c) const {
  return glm::cross(positions_[c[1]] - positions_[c[0]], positions_[c[2]] - positions_[c[0]]);
}

void CrossingGuard::build() {
  built_ = live_;
  std::vector<std::uint32_t> live;
  live.reserve(live_);
  for (std::uint32_t i = 0; i < triangles_.size(); ++i)
    if (!gone_[i]) live.push_back(i);
  const BoxTree tree(live.size(), [&](std::uint32_t i) {
    Box box;
    for (const std::uint32_t v : triangles_[live[i]]) box.extend(positions_[v]);
    return box;
  });
  leaves_ = tree.leaf_count();
  if (leaves_ == 0) return;
  order_.clear();
  boxes_.clear();
  nodes_.assign(2 * leaves_ - 1, FloatBox());
  for (std::size_t leaf = 0; leaf < leaves_; ++leaf) {
    for (const std::uint32_t* i = tree.leaf_begin(leaf); i != tree.leaf_end(leaf); ++i) {
      slots_[live[*i]] = static_cast<std::uint32_t>(order_.size());
      order_.push_back(live[*i]);
      boxes_.push_back(bounds_of(triangles_[live[*i]]));
      nodes_[leaves_ - 1 + leaf].extend(boxes_.back());
    }
  }
  for (std::size_t node = leaves_ - 1; node-- > 0;) {
    nodes_[node] = nodes_[2 * node + 1];
    nodes_[node].extend(nodes_[2 * node + 2]);
  }
}

template <class Visit>
void CrossingGuard::visit(const FloatBox& bounds, Visit&& visit) const {
  if (leaves_ == 0) return;
  std::array<std::size_t, 64> stack;
  std::size_t waiting = 0;
  stack[waiting++] = 0;
  while (waiting > 0) {
    const std::size_t node = stack[--waiting];
    if (!nodes_[node].intersects(bounds)) continue;
    if (node < leaves_ - 1) {
      stack[waiting++] = 2 * node + 2;
      stack[waiting++] = 2 * node + 1;
      continue;
    }
    const std::size_t leaf = node - (leaves_ - 1);
    for (std::size_t i = order_.size() * leaf / leaves_; i < order_.size() * (leaf + 1) / leaves_; ++i)
      if (boxes_[i].intersects(bounds)) visit(order_[i]);
  }
}

bool CrossingGuard::crosses(std::span<const std::uint32_t> star, std::span<const Corners> fan) {
  FloatBox bounds;
  Vec3 up(0.0);
  for (const std::uint32_t i : star) {
    bounds.extend(boxes_[slots_[i]]);
    up += area_of(triangles_[i]);
  }
  up = glm::normalize(up);
  // A box in which the whole surface faces one way holds a single sheet, a height over a plane: two would need a third between
  // them that faces the other way. Filled in facing the same way, the outline still bounds a height over the same part of that plane.
  bool one_sheet = true;
  for (const Corners& c : fan) one_sheet &= glm::dot(glm::normalize(area_of(c)), up) > kFacing;
  near_.clear();
  visit(bounds, [&](std::uint32_t i) {
    one_sheet &= glm::dot(Vec3(normals_[i]), up) > kFacing;
    if (std::find(star.begin(), star.end(), i) == star.end()) near_.push_back(i);
  });
  if (one_sheet) return false;
  for (std::size_t i = 0; i < fan.size(); ++i) {
    for (std::size_t j = 0; j < i; ++j)
      if (triangles_meet_wrongly(positions_, fan[i], fan[j])) return true;
    const FloatBox mine = bounds_of(fan[i]);
    for (const std::uint32_t other : near_) {
      if (boxes_[slots_[other]].intersects(mine) && triangles_meet_wrongly(positions_, fan[i], triangles_[other])) return true;
    }
  }
  return false;
}

void CrossingGuard::change(std::uint32_t triangle, const Corners& corners) {
  triangles_[triangle] = corners;
  normals_[triangle] = glm::vec3(glm::normalize(area_of(corners)));
  const std::size_t slot = slots_[triangle];
  const FloatBox bounds = boxes_[slot] = bounds_of(corners);
  // The leaf whose share of the slots this one is in: the division that shares them out may round it one too low.
  std::size_t leaf = slot * leaves_ / order_.size();
  while (order_.size() * (leaf + 1) / leaves_ <= slot) ++leaf;
  for (std::size_t node = leaves_ - 1 + leaf; !nodes_[node].contains(bounds); node = (node - 1) / 2) {
    nodes_[node].extend(bounds);
    if (node == 0) break;
  }
}

void CrossingGuard::remove(std::uint32_t triangle) {
  gone_[triangle] = 1;
  boxes_[slots_[triangle]] = FloatBox();
  --live_;
  if (live_ > 0 && 2 * live_ < built_) build();
}

}  // namespace cambium
