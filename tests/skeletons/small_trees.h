// Small skeletons for the tests.
#pragma once

#include "skeletons/skeleton.h"

#include <cmath>
#include <numbers>

namespace cambium {

inline SkeletonNode node_at(const Vec3& position, double radius, std::int32_t parent) {
  return {position, radius, parent, std::nullopt, std::nullopt};
}

inline double degrees(double angle) { return angle * std::numbers::pi / 180; }

/// A vertical axis of radius R from z = 0 to 2 h with one lateral of radius r at z = h, at `angle` degrees from it towards +x.
inline Skeleton fork_tree(double axis_radius, double lateral_radius, double angle, double h) {
  Skeleton s;
  s.nodes.push_back(node_at({0, 0, 0}, axis_radius, -1));
  s.nodes.push_back(node_at({0, 0, h}, axis_radius, 0));
  s.nodes.push_back(node_at({0, 0, 2 * h}, axis_radius, 1));
  s.nodes.back().lateral = false;
  const double a = degrees(angle);
  s.nodes.push_back(node_at(Vec3(0, 0, h) + h * Vec3(std::sin(a), 0, std::cos(a)), lateral_radius, 1));
  s.nodes.back().lateral = true;
  return s;
}

/// A path along z with steps of `step`, its x alternating between +-zig.
inline Skeleton zigzag(int nodes, double step, double zig, double radius) {
  Skeleton s;
  for (int i = 0; i < nodes; ++i) s.nodes.push_back(node_at({i % 2 ? zig : -zig, 0, i * step}, radius, i - 1));
  return s;
}

}  // namespace cambium
