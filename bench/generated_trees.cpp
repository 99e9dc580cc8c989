#include "bench/generated_trees.h"

#include <algorithm>
#include <cmath>
#include <glm/gtc/constants.hpp>

#include "bench/random_numbers.h"

namespace cambium::bench {
namespace {

constexpr double kSpacing = 0.1;  // metres: the cube root of the volume that an internode has to itself
constexpr double kTwigRadius = kSpacing / 30;
constexpr double kInternodeRadii = 4;  // an internode's length; then a fork has about four between it and the next

/// A part of space with the branch that is to fill it.
struct Region {
  Box box;
  Vec3 from;                 ///< on the box's boundary
  Vec3 heading{0.0};         ///< of the axis that goes on here; zero where a lateral starts
  std::int32_t parent = -1;  ///< node at `from`
  std::size_t internodes = 0;
};

/// Where a region is cut, and the point on the cut that the branch grows to.
struct Fork {
  int axis = 0;
  double share = 0.5;
  Vec3 point{0.0};
};

Fork fork_of(const Box& box, RandomNumbers* random) {
  const Vec3 size = box.size();
  Fork fork;
  for (int i = 1; i < 3; ++i)
    if (size[i] > size[fork.axis]) fork.axis = i;
  if (random) fork.share = random->between(0.3, 0.7);
  for (int i = 0; i < 3; ++i) {
    const double at = i == fork.axis ? fork.share : random ? random->between(0.35, 0.65) : 0.5;
    fork.point[i] = box.lo[i] + at * size[i];
  }
  return fork;
}

double radius_bearing(std::size_t internodes) { return kTwigRadius * std::cbrt(static_cast<double>(internodes) + 0.5); }

/// Grows without recursion: regions still to be filled wait on a stack. Without random numbers every cut is in the middle.
Skeleton grow(std::size_t internodes, RandomNumbers* random) {
  Skeleton skeleton;
  skeleton.nodes.reserve(internodes + 1);
  const double edge = kSpacing * std::cbrt(static_cast<double>(internodes));
  const Vec3 root(0.0);
  skeleton.nodes.push_back({root, radius_bearing(internodes), -1, {}, {}});
  std::vector<Region> waiting = {{{{-edge / 2, -edge / 2, 0}, {edge / 2, edge / 2, edge}}, root, {0, 0, 1}, 0, internodes}};
  while (!waiting.empty()) {
    Region region = waiting.back();
    waiting.pop_back();
    const Fork fork = fork_of(region.box, random);
    const Vec3 across = fork.point - region.from;
    const double length = glm::length(across);
    // A quadratic curve that leaves in the direction in which the axis came, so that it does not break at every fork.
    const Vec3 bow = region.from + (region.heading == Vec3(0.0) ? 0.5 * across : 0.4 * length * region.heading);
    const auto steps =
        static_cast<std::size_t>(std::max(1.0, std::round(length / (kInternodeRadii * radius_bearing(region.internodes)))));
    std::int32_t node = region.parent;
    std::size_t left = region.internodes;
    for (std::size_t i = 1; i <= steps && left > 0; ++i) {
      const double t = static_cast<double>(i) / static_cast<double>(steps);
      const Vec3 p = (1 - t) * (1 - t) * region.from + 2 * t * (1 - t) * bow + t * t * fork.point;
      skeleton.nodes.push_back({p, radius_bearing(--left), node, {}, {}});
      node = static_cast<std::int32_t>(skeleton.nodes.size()) - 1;
    }
    const auto low = static_cast<std::size_t>(std::round(fork.share * static_cast<double>(left)));
    const bool low_goes_on = 2 * low >= left;
    const Vec3 heading = glm::normalize(fork.point - bow);
    Region lower{region.box, fork.point, low_goes_on ? heading : Vec3(0.0), node, low};
    Region upper{region.box, fork.point, low_goes_on ? Vec3(0.0) : heading, node, left - low};
    lower.box.hi[fork.axis] = upper.box.lo[fork.axis] = fork.point[fork.axis];
    if (upper.internodes > 0) waiting.push_back(upper);
    if (lower.internodes > 0) waiting.push_back(lower);
  }
  return skeleton;
}

}  // namespace

Skeleton random_tree(std::size_t internodes, std::uint64_t seed) {
  RandomNumbers random(seed);
  return grow(internodes, &random);
}

Skeleton balanced_tree(std::size_t internodes) { return grow(internodes, nullptr); }

Skeleton single_axis(std::size_t internodes) {
  const double thick = 2 * kTwigRadius, step = kInternodeRadii * 1.5 * kTwigRadius;
  const double pitch = 6 * thick;  // supports are 2.2 radii
  const double length = step * static_cast<double>(internodes);
  // As high as it is wide.
  const double helix_radius = std::max(20 * thick, std::sqrt(pitch * length / (4 * glm::pi<double>())));
  const double circumference = 2 * glm::pi<double>() * helix_radius;
  Skeleton skeleton;
  skeleton.nodes.reserve(internodes + 1);
  for (std::size_t i = 0; i <= internodes; ++i) {
    const double turns = step * static_cast<double>(i) / circumference, angle = 2 * glm::pi<double>() * turns;
    const double t = static_cast<double>(i) / static_cast<double>(internodes);
    skeleton.nodes.push_back({{helix_radius * std::cos(angle), helix_radius * std::sin(angle), pitch * turns},
                              thick * (1 - 0.5 * t),
                              static_cast<std::int32_t>(i) - 1,
                              {},
                              {}});
  }
  return skeleton;
}

}  // namespace cambium::bench
