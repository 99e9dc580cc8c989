#include "skeletons/trunk_base.h"

#include "blobtree/input_error.h"
#include "blobtree/place_hash.h"
#include "skeletons/number_checks.h"
#include "skeletons/profiles.h"

#include <cmath>

namespace cambium {
namespace {

/// What the seed is drawn from for.
enum Purpose : std::uint64_t { kProngs = 71, kRoots };

void require(bool holds, const char* key, double value, const char* expected) {
  require_number(holds, "base: " + std::string(key), value, expected);
}

void check_roots(const SurfaceRootOptions& roots) {
  require(roots.length >= 0 && roots.length <= 1e4, "roots: length", roots.length, "metres from 0 to 10000");
  require(roots.radius > 0 && roots.radius <= 1, "roots: radius", roots.radius, "above 0, at most 1 trunk radius");
  require(roots.taper > 0 && roots.taper <= 1, "roots: taper", roots.taper, "above 0, at most 1");
  require(roots.wander >= 0 && roots.wander <= 3, "roots: wander", roots.wander, "radians from 0 to 3");
  require(std::abs(roots.rise) <= 1, "roots: rise", roots.rise, "-1 to 1 radii of the root");
  require(roots.depth >= 0 && roots.depth <= 1e4, "roots: depth", roots.depth, "metres from 0 to 10000");
  require(roots.branches >= 0 && roots.branches <= 100, "roots: branches", roots.branches, "0 to 100 side roots");
}

}  // namespace

void check_trunk_base(const TrunkBase& base) {
  require(base.height > 0 && std::isfinite(base.height), "height", base.height, "metres above 0");
  require(base.spread >= 0 && base.spread <= 100, "spread", base.spread, "0 to 100");
  require(base.sharpness >= 0 && base.sharpness <= 0.95, "sharpness", base.sharpness, "0 to 0.95");
  require(!base.prongs.empty() || (base.count >= 1 && base.count <= 64), "prongs", base.count, "1 to 64 prongs");
  require(base.irregularity >= 0 && base.irregularity <= 1, "irregularity", base.irregularity, "0 to 1");
  require(glm::length(base.up) > 0 && std::isfinite(glm::length(base.up)), "up", glm::length(base.up), "a direction that is not 0");
  check_roots(base.roots);
}

std::vector<Prong> prongs_of(const TrunkBase& base, std::uint64_t seed) {
  return base.prongs.empty() ? draw_prongs(base.count, base.irregularity, hash_of(seed, kProngs)) : base.prongs;
}

GroundPlane ground_of(const TrunkBase& base, const Vec3& foot) { return {base.ground.value_or(foot), glm::normalize(base.up)}; }

Skeleton rooted(const Skeleton& skeleton, const TrunkBase& base, std::uint64_t seed) {
  Skeleton grown = skeleton;
  add_surface_roots(grown, prongs_of(base, seed), ground_of(base, skeleton.nodes.at(0).position), base.roots, hash_of(seed, kRoots));
  return grown;
}

Flare flared(std::vector<ChainNode> nodes, const TrunkBase& base, const GroundPlane& ground, std::uint64_t seed) {
  const Vec3 foot = nodes.front().position;
  const Vec3 at = foot + ground.normal * glm::dot(ground.point - foot, ground.normal);
  return {std::move(nodes), at, ground.normal, base.height, base.spread, base.sharpness, prongs_of(base, seed), base.section};
}

NodeId cut_at_ground(NodeId tree, const GroundPlane& ground, double trunk_radius, BlobTreeBuilder& builder) {
  const NodeId soil = builder.add(half_space_of({ground.point, -ground.normal, 0}, trunk_radius));
  return builder.add(Intersection{{tree, soil}});
}

}  // namespace cambium
