// The base of the trunk: a flare, roots that its prongs go on as, and the ground that both stand on (field.md section 6b; Varadarajan 2011).
#pragma once

#include "blobtree/blobtree.h"
#include "skeletons/surface_roots.h"

#include <cstdint>
#include <optional>
#include <vector>

namespace cambium {

/// What becomes of wood below the ground.
enum class BelowGround {
  kKeep,
  kCut,                              ///< cut flat, and closed there: what is under it would be the pole where all prongs meet
};

struct TrunkBase {
  double height = 1;                 ///< metres over the ground where the trunk is round again, > 0
  double spread = 0.4;               ///< how much wider it is at the ground in the valleys between prongs, >= 0
  double sharpness = 0.6;            ///< how far prongs stand out of that, [0, 0.95]
  FlareSection section = FlareSection::kEnvelope;
  std::vector<Prong> prongs;         ///< none: `count` of them are drawn
  int count = 5;                     ///< 1 to 64
  double irregularity = 0.4;         ///< of those drawn, [0, 1] (draw_prongs)
  SurfaceRootOptions roots;
  std::optional<Vec3> ground;        ///< a point of the ground, metres; unset: the skeleton's first node
  Vec3 up{0, 0, 1};                  ///< the ground's normal, of any length but 0: a slope
  BelowGround below = BelowGround::kCut;
};

/// Errors: InputError (no location) that names the setting.
void check_trunk_base(const TrunkBase& base);

/// The prongs given or drawn.
std::vector<Prong> prongs_of(const TrunkBase& base, std::uint64_t seed);

/// foot: where the trunk begins.
GroundPlane ground_of(const TrunkBase& base, const Vec3& foot);

/// The skeleton with its surface roots: they come last.
Skeleton rooted(const Skeleton& skeleton, const TrunkBase& base, std::uint64_t seed);

/// The trunk's chain as a flare. Precondition: at least one node.
Flare flared(std::vector<ChainNode> nodes, const TrunkBase& base, const GroundPlane& ground, std::uint64_t seed);

/// All that is under the ground cut away from `tree`; a node.
NodeId cut_at_ground(NodeId tree, const GroundPlane& ground, double trunk_radius, BlobTreeBuilder& builder);

}  // namespace cambium
