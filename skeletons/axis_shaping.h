// The shape of one path: smoothing, merging, bends and rounded corners (field.md section 6, conditioning; section 5, bend).
#pragma once

#include "skeletons/axes.h"

#include <vector>

namespace cambium {

/// A node of a path that is being reshaped; `at` counts nodes of the path as it was, so that what it bears finds its place.
struct PathNode {
  Vec3 position{0.0};
  double radius = 0;
  double at = 0;
  double base_radius = 0;                  ///< as in AxisNode; kept by diffuse and merge_short only
};
using Path = std::vector<PathNode>;

Path path_of(const Axis& axis);
/// The place on the reshaped path of what stood at `at` on the old one. Cost: logarithmic.
AxisPlace place_of(const Path& path, double at);

/// Diffuses positions until features smaller than `smooth` radii are gone; both ends stay. Straight parts and internodes
/// much longer than their radius hardly move. Cost: linear. Returns the farthest that a node moved, metres.
double diffuse(Path& path, double smooth);

/// Drops inner nodes nearer than `spacing` radii to the node kept before them. Returns their number.
std::size_t merge_short(Path& path, double spacing);

/// Makes every internode that turns away from the one before it (or from `bearing`, the bearing axis's direction; zero: none)
/// an arc with the same ends, in the plane of both, first away from the one before. angle and max_turn in radians.
/// An arc is at most twice the turn, so that internodes in line stay straight.
void bend_internodes(Path& path, const Vec3& bearing, double angle, double max_turn);

/// The angle and outward direction of such an arc; angle 0 where both directions are in line. Unit vectors.
struct BendPlan {
  double angle = 0;
  Vec3 direction{0.0};
};
BendPlan plan_bend(const Vec3& before, const Vec3& along, double angle);

/// Rounds corners of more than max_turn with a circular arc that begins up to `extent` radii before the node, so that
/// neighbouring segments turn by at most max_turn. Complete reversals (above 172 degrees) stay.
void round_corners(Path& path, double extent, double max_turn);

}  // namespace cambium
