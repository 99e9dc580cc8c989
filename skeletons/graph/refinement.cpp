#include "skeletons/graph/refinement.h"

#include "blobtree/input_error.h"
#include "skeletons/graph/poisson_disc.h"

#include <algorithm>
#include <cmath>
#include <string>

namespace cambium {
namespace {

constexpr double kNarrowEnd = 0.25;   // of a cone's wide end: so that there are nodes near the trunk too

/// The line through a trunk's middle, upwards from the root's end of it.
struct Spine {
  Vec3 from{0.0}, to{0.0};
};

void check(const GraphRefinement& refinement) {
  if (refinement.spheres < 2 || refinement.spheres > 64)
    throw InputError({}, "spheres = " + std::to_string(refinement.spheres), "2 to 64 spheres");
  if (!(refinement.radius > 0 && refinement.radius <= 2))
    throw InputError({}, "radius = " + std::to_string(refinement.radius), "a radius above 0, at most 2, in distances between spheres");
  if (!(refinement.cone_radius > 0 && refinement.cone_radius <= 1))
    throw InputError({}, "cone_radius = " + std::to_string(refinement.cone_radius),
                     "a cone_radius above 0, at most 1, in radii of a sphere");
}

Spine spine_of(const PlacedSolid& trunk, const Vec3& root) {
  const SolidFrame frame(trunk);
  const Box box = bounds(trunk.solid);
  const Vec3 middle = box.center();
  const Vec3 low = frame.placed({middle.x, middle.y, box.lo.z}), high = frame.placed({middle.x, middle.y, box.hi.z});
  return glm::distance(low, root) <= glm::distance(high, root) ? Spine{low, high} : Spine{high, low};
}

/// Where on the spine a connector to `center` begins: so far below it as it is beside it, or at an end.
Vec3 foot_on(const Spine& spine, const Vec3& center, const Obstacles* obstacles) {
  constexpr int kTries = 8;
  const Vec3 up = spine.to - spine.from, way = center - spine.from;
  const double length = glm::length(up);
  if (!(length > 0)) return spine.from;
  const double along = glm::dot(way, up) / length, beside = glm::length(way - along / length * up);
  const Vec3 highest = spine.from + std::clamp(along - beside, 0.0, length) / length * up;
  if (!obstacles) return highest;
  for (int i = 0; i < kTries; ++i) {
    const Vec3 foot = glm::mix(highest, spine.from, i / double(kTries));
    if (!obstacles->crossed(foot, center)) return foot;
  }
  return highest;
}

Vec3 nearest_foot(const std::vector<Spine>& spines, const Vec3& center, const Obstacles* obstacles) {
  Vec3 nearest = foot_on(spines.front(), center, obstacles);
  for (const Spine& spine : spines) {
    const Vec3 foot = foot_on(spine, center, obstacles);
    if (glm::distance(foot, center) < glm::distance(nearest, center)) nearest = foot;
  }
  return nearest;
}

double distance_to_others(const std::vector<Vec3>& centers, std::size_t i) {
  double least = kInfinity;
  for (std::size_t k = 0; k < centers.size(); ++k)
    if (k != i) least = std::min(least, glm::distance(centers[i], centers[k]));
  return least;
}

/// None where the sphere reaches the foot.
std::optional<PlacedSolid> connector(const PlacedSolid& sphere, double radius, const Vec3& foot, double wide) {
  const Vec3 way = sphere.origin - foot;
  const double height = glm::length(way) - std::sqrt(std::max(radius * radius - wide * wide, 0.0));
  if (!(height > 1e-6 * radius)) return std::nullopt;
  const ConeSolid cone{kNarrowEnd * wide, wide, height};
  return PlacedSolid{.solid = cone, .origin = foot, .axis = way, .endpoints = false, .part = sphere.part};
}

}  // namespace

std::vector<PlacedSolid> refined(const std::vector<PlacedSolid>& volume, const GraphRefinement& refinement, const Vec3& root,
                                 const Obstacles* obstacles, std::uint64_t seed) {
  check(refinement);
  std::vector<PlacedSolid> crown, solids;
  std::vector<Spine> spines;
  for (const PlacedSolid& placed : volume) {
    if (placed.endpoints) {
      crown.push_back(placed);
    } else {
      spines.push_back(spine_of(placed, root));
      solids.push_back(placed);
      solids.back().part = 0;
    }
  }
  if (crown.empty()) throw InputError({}, "no volume that bears endpoints", "one to fill with spheres");
  if (spines.empty()) spines.push_back({root, root});

  const GraphVolume room(crown, std::shared_ptr<const Obstacles>(std::shared_ptr<void>(), obstacles));
  const std::vector<Vec3> centers = poisson_disc(room, {}, {.count = refinement.spheres, .seed = seed}, {}).value().positions;
  if (centers.size() < 2) throw InputError({}, "spheres: room for " + std::to_string(centers.size()), "a volume with room for 2 or more");
  for (std::size_t i = 0; i < centers.size(); ++i) {
    const double radius = refinement.radius * distance_to_others(centers, i);
    const PlacedSolid sphere{.solid = BallSolid{radius}, .origin = centers[i], .part = static_cast<std::uint16_t>(i + 1)};
    solids.push_back(sphere);
    const Vec3 foot = nearest_foot(spines, centers[i], obstacles);
    if (const auto cone = connector(sphere, radius, foot, refinement.cone_radius * radius)) solids.push_back(*cone);
  }
  return solids;
}

}  // namespace cambium
