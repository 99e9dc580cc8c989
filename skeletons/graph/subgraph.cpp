#include "skeletons/graph/subgraph.h"

#include "blobtree/place_hash.h"

#include <algorithm>
#include <cmath>

namespace cambium {
namespace {

constexpr Vec3 kUp{0, 0, 1};

/// Even over the sphere (Archimedes).
Vec3 random_direction(StreamDraws& draws) {
  const double z = draws.between(-1, 1), azimuth = draws.between(0, 2 * std::numbers::pi);
  const double side = std::sqrt(std::max(0.0, 1 - z * z));
  return {side * std::cos(azimuth), side * std::sin(azimuth), z};
}

/// Rodrigues' formula.
Vec3 turned_about(const Vec3& v, const Vec3& axis, double angle) {
  const Vec3 k = glm::normalize(axis);
  return v * std::cos(angle) + glm::cross(k, v) * std::sin(angle) + k * (glm::dot(k, v) * (1 - std::cos(angle)));
}

/// Towards up for angle > 0, down for angle < 0, as far as that goes. Where v is vertical itself, chance says by which side.
Vec3 lifted(const Vec3& v, double angle, StreamDraws& draws) {
  Vec3 side{v.x, v.y, 0};
  if (glm::length(side) < 1e-9) {
    const double azimuth = draws.between(0, 2 * std::numbers::pi);
    side = {std::cos(azimuth), std::sin(azimuth), 0};
  }
  const double from_up = std::acos(std::clamp(v.z, -1.0, 1.0));
  const double wanted = std::clamp(from_up - angle, 0.0, std::numbers::pi);
  return std::cos(wanted) * kUp + std::sin(wanted) * glm::normalize(side);
}

Vec3 oriented(const GraphLevel& level, const Vec3& root, const Vec3& from, StreamDraws& draws) {
  switch (level.orientation) {
    case GraphOrientation::kVertical: return kUp;
    case GraphOrientation::kRandom: return random_direction(draws);
    case GraphOrientation::kOutward: break;
  }
  const double length = glm::length(root - from);
  return length > 0 ? (root - from) / length : kUp;
}

}  // namespace

Vec3 subgraph_direction(const GraphLevel& level, const Vec3& root, const Vec3& from, const std::optional<GraphWind>& wind,
                        std::uint64_t stream) {
  StreamDraws draws(stream);
  Vec3 v = oriented(level, root, from, draws);
  if (level.turn.angle != 0) v = level.turn.axis ? turned_about(v, *level.turn.axis, level.turn.angle) : lifted(v, level.turn.angle, draws);
  if (wind && wind->strength > 0) {
    const Vec3 blown = v + wind->strength * glm::normalize(wind->direction);
    if (glm::length(blown) > 1e-9) v = glm::normalize(blown);
  }
  return v;
}

GraphVolume subgraph_volume(const GraphLevel& level, const Vec3& root, const Vec3& direction, double radius,
                            const std::shared_ptr<const Obstacles>& obstacles) {
  if (level.shape.empty())
    return GraphVolume({PlacedSolid{.solid = BallSolid{radius, level.alpha}, .origin = root, .axis = direction}}, obstacles);
  const SolidFrame turned(PlacedSolid{.solid = BallSolid{}, .axis = direction});
  std::vector<PlacedSolid> shape = level.shape;
  for (PlacedSolid& placed : shape) {
    placed.origin = root + radius * turned.placed(placed.origin);
    placed.axis = turned.placed(placed.axis);
    placed.scale *= radius;
  }
  return GraphVolume(std::move(shape), obstacles);
}

}  // namespace cambium
