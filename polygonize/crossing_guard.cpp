#include "polygonize/crossing_guard.h"

#include "blobtree/box_tree.h"
#include "polygonize/triangle_contact.h"

#include <tbb/blocked_range.h>
#include <tbb/parallel_for.h>

#include <algorithm>
#include <bit>
#include <utility>

namespace cambium {
namespace {

constexpr std::uint32_t kGone = 0xffffffffu;
constexpr double kFacing = 0.1;   // cosine: what faces a direction, rounding included

}  // namespace

CrossingGuard::CrossingGuard(const std::vector<Vec3>& positions, const std::vector<Corners>& triangles, const RunOptions& run)
    : positions_(positions), run_(run), live_(triangles.size()), slot_of_(triangles.size()) {
  std::vector<Slot> slots(triangles.size());
  tbb::parallel_for(tbb::blocked_range<std::size_t>(0, slots.size(), 4096), [&](const auto& range) {
    for (std::size_t i = range.begin(); i < range.end() && !run.cancelled(); ++i) {
      const Corners& c = triangles[i];
      slots[i] = {bounds_of(c), glm::vec3(glm::normalize(area_of(c))), static_cast<std::uint32_t>(i), c};
    }
  });
  build(std::move(slots));
}

FloatBox CrossingGuard::bounds_of(const Corners& corners) const {
  Box box;
  for (const std::uint32_t v : corners) box.extend(positions_[v]);
  return FloatBox(box);
}

Vec3 CrossingGuard::area_of(const Corners& c) const {
  return glm::cross(positions_[c[1]] - positions_[c[0]], positions_[c[2]] - positions_[c[0]]);
}

void CrossingGuard::build(std::vector<Slot> triangles) {
  built_ = live_;
  const BoxTree tree(triangles.size(), [&](std::uint32_t i) {
    Box box;
    for (const std::uint32_t v : triangles[i].corners) box.extend(positions_[v]);
    return box;
  }, run_);
  if (run_.cancelled()) return;
  slots_.resize(triangles.size());
  leaves_ = tree.leaf_count();
  if (leaves_ == 0) return;
  depth_ = std::countr_zero(leaves_);
  nodes_.assign(2 * leaves_ - 1, FloatBox());
  tbb::parallel_for(tbb::blocked_range<std::size_t>(0, leaves_, 512), [&](const auto& range) {
    for (std::size_t leaf = range.begin(); leaf < range.end(); ++leaf) {
      std::size_t slot = first(leaf);
      for (const std::uint32_t* i = tree.leaf_begin(leaf); i != tree.leaf_end(leaf); ++i, ++slot) {
        slots_[slot] = triangles[*i];
        slot_of_[slots_[slot].triangle] = static_cast<std::uint32_t>(slot);
        nodes_[leaves_ - 1 + leaf].extend(slots_[slot].box);
      }
    }
  });
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
    for (std::size_t i = first(leaf); i < first(leaf + 1); ++i)
      if (slots_[i].box.intersects(bounds)) visit(static_cast<std::uint32_t>(i));
  }
}

bool CrossingGuard::crosses(std::span<const std::uint32_t> star, std::span<const Corners> fan) {
  FloatBox bounds;
  Vec3 up(0.0);
  star_.clear();
  for (const std::uint32_t i : star) {
    star_.push_back(slot_of_[i]);
    bounds.extend(slots_[star_.back()].box);
    up += area_of(slots_[star_.back()].corners);
  }
  up = glm::normalize(up);
  // A box in which the whole surface faces one way holds a single sheet, a height over a plane: two would need a third between
  // them that faces the other way. Filled in facing the same way, the outline still bounds a height over the same part of that plane.
  bool one_sheet = true;
  for (const Corners& c : fan) one_sheet &= glm::dot(glm::normalize(area_of(c)), up) > kFacing;
  near_.clear();
  visit(bounds, [&](std::uint32_t slot) {
    one_sheet &= glm::dot(Vec3(slots_[slot].normal), up) > kFacing;
    if (std::find(star_.begin(), star_.end(), slot) == star_.end()) near_.push_back(slot);
  });
  if (one_sheet) return false;
  for (std::size_t i = 0; i < fan.size(); ++i) {
    for (std::size_t j = 0; j < i; ++j)
      if (triangles_meet_wrongly(positions_, fan[i], fan[j])) return true;
    const FloatBox mine = bounds_of(fan[i]);
    for (const std::uint32_t other : near_) {
      if (slots_[other].box.intersects(mine) && triangles_meet_wrongly(positions_, fan[i], slots_[other].corners)) return true;
    }
  }
  return false;
}

void CrossingGuard::change(std::uint32_t triangle, const Corners& corners) {
  const std::size_t slot = slot_of_[triangle];
  const FloatBox bounds = bounds_of(corners);
  slots_[slot] = {bounds, glm::vec3(glm::normalize(area_of(corners))), triangle, corners};
  // The leaf whose share of the slots this one is in: the division that shares them out may round it one too low.
  std::size_t leaf = slot * leaves_ / slots_.size();
  while (first(leaf + 1) <= slot) ++leaf;
  for (std::size_t node = leaves_ - 1 + leaf; !nodes_[node].contains(bounds); node = (node - 1) / 2) {
    nodes_[node].extend(bounds);
    if (node == 0) break;
  }
}

void CrossingGuard::remove(std::uint32_t triangle) {
  slots_[slot_of_[triangle]].box = FloatBox();
  slot_of_[triangle] = kGone;
  --live_;
  if (live_ == 0 || 2 * live_ >= built_) return;
  std::vector<Slot> live;
  live.reserve(live_);
  for (const Slot& slot : slots_)
    if (slot_of_[slot.triangle] != kGone) live.push_back(slot);
  build(std::move(live));
}

}  // namespace cambium
