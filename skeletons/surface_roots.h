// Roots that run over the ground from a trunk's base and go under (after Varadarajan 2011, section 3.1: limbs of the trunk-root
// junction).
#pragma once

#include "blobtree/nodes.h"
#include "skeletons/skeleton.h"

#include <cstdint>
#include <optional>
#include <vector>

namespace cambium {

/// A plane. Its x direction is the world's x made orthogonal to the normal (y where that is parallel).
struct GroundPlane {
  Vec3 point{0.0};                   ///< metres
  Vec3 normal{0, 0, 1};              ///< unit, upwards
};

struct SurfaceRootOptions {
  double length = 2;                 ///< metres along the ground, of a root whose prong has length 1; 0: no roots
  double radius = 0.35;              ///< where it leaves the trunk, in the trunk's radii there
  double taper = 1;                  ///< (0, 1]: how much of its radius a root loses on its way, the tip keeps a twentieth at least
  double wander = 0.6;               ///< radians that its heading strays from its prong's, by and by
  double rise = 0.5;                 ///< of its radius: how far its axis is above the ground at the trunk
  double depth = 0.2;                ///< metres that its tip is under the ground, for a prong of length 1
  double branches = 2;               ///< side roots of a root, on average
};

/// `count` prongs evenly about the trunk, each strayed by up to half `irregularity` of the angle between two, and longer or shorter by up
/// to `irregularity`, in [0, 1]. The same for the same seed.
std::vector<Prong> draw_prongs(int count, double irregularity, std::uint64_t seed);

/// Appends one root for each prong of a flare, its angle counted from the ground's x direction, and its side roots, as laterals of the skeleton's first node, where the trunk stands on the ground.
/// Each root draws from a stream of its own. Cost: linear in the nodes that are added, about three to a radius.
/// Precondition: the skeleton has a node, its radius above 0.
void add_surface_roots(Skeleton& skeleton, const std::vector<Prong>& prongs, const GroundPlane& ground, const SurfaceRootOptions& options,
                       std::uint64_t seed);

}  // namespace cambium
