// A volume filled with smaller ones, so that branches come in clusters (Xu and Mould 2012, section 3.3.1, figures 12 and 13).
#pragma once

#include "skeletons/graph/graph_volume.h"

#include <cstdint>
#include <vector>

namespace cambium {

/// The first level's volume filled with smaller ones (figure 12).
struct GraphRefinement {
  std::size_t spheres = 7;           ///< about as many, 2 to 64
  double radius = 0.5;               ///< of each, in distances from its centre to the nearest other's; above 0.5 they overlap. (0, 2]
  double cone_radius = 0.5;          ///< of the connector where it meets the sphere, in the sphere's radii. (0, 1]
};

/// In place of the solids that bear endpoints: spheres around a coarse Poisson disc of places in them (in no obstacle), and from each
/// sphere that does not reach it already a cone to the trunk, a quarter as wide there. The trunk is the other solids, which are kept as
/// subvolume 0, or the root if there are none: a cone begins on the line through a solid's middle, where it rises by half a right angle
/// or more, or at its top, lower where an obstacle is between. A sphere bears endpoints; it and its cone are subvolume 1, 2, ...
/// The same for the same seed. Errors: InputError (no location) that names the setting, or for a volume without room.
std::vector<PlacedSolid> refined(const std::vector<PlacedSolid>& volume, const GraphRefinement& refinement, const Vec3& root,
                                 const Obstacles* obstacles, std::uint64_t seed);

}  // namespace cambium
