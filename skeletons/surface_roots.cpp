#include "skeletons/surface_roots.h"

#include "blobtree/place_hash.h"
#include "skeletons/axes.h"

#include <algorithm>
#include <cmath>
#include <numbers>

namespace cambium {
namespace {

constexpr double kStep = 0.7;              // radii of the root from node to node
constexpr double kThinnestTip = 0.05;      // of the radius at the trunk
constexpr double kSideLength = 0.55, kSideRadius = 0.65;   // of what is left of the root that bears it, and of its radius there

/// Numbers that stray smoothly from 0 with the way that has been gone: a sum of three waves.
class Straying {
 public:
  explicit Straying(StreamDraws& draws) {
    for (double& phase : phases_) phase = draws.between(0, 2 * std::numbers::pi);
  }
  /// In [-1, 1]; 0 at the beginning.
  double at(double way) const {
    double sum = 0;
    for (int i = 0; i < 3; ++i) sum += kShare[i] * (std::sin(kWaves[i] * way + phases_[i]) - std::sin(phases_[i]));
    return 0.5 * sum;
  }

 private:
  static constexpr double kWaves[3] = {4, 9, 19}, kShare[3] = {0.6, 0.27, 0.13};   // to the whole way; of the straying
  double phases_[3];
};

class RootGrower {
 public:
  RootGrower(Skeleton& skeleton, const GroundPlane& ground, const SurfaceRootOptions& options)
      : skeleton_(skeleton), ground_(ground), options_(options), x_(across(ground.normal, {1, 0, 0})), y_(glm::cross(ground.normal, x_)) {}

  void grow(const Prong& prong, std::uint64_t stream) {
    const double trunk = skeleton_.nodes[0].radius;
    Root root{.from = 0, .place = skeleton_.nodes[0].position, .heading = prong.angle, .length = options_.length * prong.length + trunk,
              .radius = options_.radius * trunk * std::sqrt(prong.length), .depth = options_.depth * prong.length, .lead = trunk};
    StreamDraws draws(stream);
    const double whole = std::floor(options_.branches);
    root.sides = static_cast<int>(whole) + (draws.uniform() < options_.branches - whole);
    grow(root, draws);
  }

 private:
  struct Root {
    std::int32_t from = 0;             // the node that bears it
    Vec3 place{0.0};                   // where that is
    double heading = 0;
    double length = 0, radius = 0;     // metres
    double depth = 0;                  // of the tip
    double lead = 0;                   // metres inside what bears it, where it has all its radius
    double sunk = 0;                   // of its depth, where it begins
    int sides = 0;
  };

  /// Where a place is above the plane, moved to be `height` above the ground.
  Vec3 on_ground(const Vec3& p, double height) const {
    return p + ground_.normal * (height - glm::dot(p - ground_.point, ground_.normal));
  }

  void grow(const Root& root, StreamDraws& draws) {
    const Straying straying(draws);
    std::vector<double> side_ways;
    for (int i = 0; i < root.sides; ++i) side_ways.push_back(draws.between(0.25, 0.75));
    std::sort(side_ways.begin(), side_ways.end());
    double turn = draws.uniform() < 0.5 ? 1 : -1;

    const int steps = std::clamp(static_cast<int>(std::ceil(root.length / (kStep * root.radius))), 4, 2000);
    Vec3 place = root.place;
    std::int32_t from = root.from;
    std::size_t side = 0;
    for (int i = 1; i <= steps; ++i) {
      const double way = double(i) / steps;
      const double heading = root.heading + options_.wander * straying.at(way);
      place += root.length / steps * (std::cos(heading) * x_ + std::sin(heading) * y_);
      const double radius = radius_at_way(root, way);
      from = add_node(from, on_ground(place, height_at(root, way, radius)), radius, i == 1 ? std::optional(root.radius) : std::nullopt);
      for (; side < side_ways.size() && side_ways[side] <= way; ++side) {
        grow(side_root(root, from, place, heading + turn * draws.between(0.5, 0.9), way, radius), draws);
        turn = -turn;
      }
    }
  }

  Root side_root(const Root& bearing, std::int32_t from, const Vec3& place, double heading, double way, double radius) const {
    return {.from = from, .place = place, .heading = heading, .length = kSideLength * (1 - way) * bearing.length,
            .radius = kSideRadius * radius, .depth = bearing.depth, .lead = 0, .sunk = way, .sides = 0};
  }

  double radius_at_way(const Root& root, double way) const {
    const double gone = std::max(0.0, way - root.lead / root.length) / (1 - root.lead / root.length);
    return root.radius * std::max(1 - options_.taper * std::pow(gone, 0.8), kThinnestTip);
  }

  /// Of the axis over the ground: from the trunk, where it stands out by `rise`, sinking ever faster.
  double height_at(const Root& root, double way, double radius) const {
    const double sunk = root.sunk + (1 - root.sunk) * way;
    return options_.rise * radius * (1 - sunk) - root.depth * sunk * sunk * sunk;
  }

  std::int32_t add_node(std::int32_t parent, const Vec3& position, double radius, std::optional<double> lateral_base) {
    SkeletonNode node{position, radius, parent, lateral_base, {}};
    if (lateral_base) node.lateral = true;
    skeleton_.nodes.push_back(node);
    return static_cast<std::int32_t>(skeleton_.nodes.size()) - 1;
  }

  Skeleton& skeleton_;
  const GroundPlane& ground_;
  const SurfaceRootOptions& options_;
  Vec3 x_, y_;
};

}  // namespace

std::vector<Prong> draw_prongs(int count, double irregularity, std::uint64_t seed) {
  std::vector<Prong> prongs;
  const double apart = 2 * std::numbers::pi / std::max(count, 1);
  for (int i = 0; i < count; ++i) {
    StreamDraws draws(hash_of(seed, static_cast<std::uint64_t>(i)));
    const double stray = 0.5 * irregularity * draws.between(-0.95, 0.95);   // two never meet
    prongs.push_back({apart * (i + stray), 1 + irregularity * draws.between(-0.7, 0.7)});
  }
  return prongs;
}

void add_surface_roots(Skeleton& skeleton, const std::vector<Prong>& prongs, const GroundPlane& ground, const SurfaceRootOptions& options,
                       std::uint64_t seed) {
  if (!(options.length > 0)) return;
  RootGrower grower(skeleton, ground, options);
  for (std::size_t i = 0; i < prongs.size(); ++i) grower.grow(prongs[i], hash_of(seed, i, 1));
}

}  // namespace cambium
