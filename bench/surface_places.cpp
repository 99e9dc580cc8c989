#include "bench/surface_places.h"

#include <optional>
#include <stdexcept>

namespace cambium::bench {
namespace {

std::optional<SurfacePlace> walk_outwards(const SkeletonNode& node, const Vec3& outwards, const Field& field) {
  const auto inside = [&](double distance) { return field.value(node.position + distance * outwards) >= kIso; };
  if (!inside(0)) return std::nullopt;
  const double step = 0.25 * node.radius, farthest = 10 * node.radius;
  double beyond = step;
  while (inside(beyond)) {
    beyond += step;
    if (beyond > farthest) return std::nullopt;
  }
  double within = beyond - step;
  while (beyond - within > 1e-6 * node.radius) {
    const double middle = 0.5 * (within + beyond);
    (inside(middle) ? within : beyond) = middle;
  }
  return SurfacePlace{node.position + beyond * outwards, node.radius};
}

}  // namespace

std::vector<SurfacePlace> surface_places(const Skeleton& skeleton, const Field& field, std::size_t count,
                                         RandomNumbers random) {
  std::vector<SurfacePlace> places;
  for (std::size_t tries = 0; places.size() < count; ++tries) {
    if (tries > 50 * count) throw std::runtime_error("surface_places: hardly any internode has a surface");
    const SkeletonNode& node = skeleton.nodes[random.below(skeleton.nodes.size())];
    if (node.parent < 0) continue;
    const Vec3 along = node.position - skeleton.nodes[static_cast<std::size_t>(node.parent)].position;
    const double length = glm::length(along);
    if (!(length > 0)) continue;
    if (const auto place = walk_outwards(node, random.across(along / length), field)) places.push_back(*place);
  }
  return places;
}

}  // namespace cambium::bench
