// Leaves and other organs that a skeleton carries: which shapes there are, and where each one sits.
#pragma once

#include "blobtree/geometry.h"

#include <array>
#include <cstdint>
#include <string>
#include <vector>

namespace cambium {

/// A shape in coordinates of its own: it is held at the origin, grows along y (the turtle's heading) and looks along z (its up);
/// x is the turtle's left. One unit is a metre where a placement's scale is 1. Shapes are seen from both sides; triangles of an
/// outline run as it does. An outline reaches 1 from the origin; a sphere and a disc (in the plane of x and y) are 1 across.
struct OrganShape {
  /// Of `~name`; `polygon1`, `polygon2`, ... of outlines between { and }; `sphere`, `disc`.
  std::string name;
  std::vector<Vec3> vertices;
  /// None: only the name is known, and whoever draws it brings a shape.
  std::vector<std::array<std::uint32_t, 3>> triangles;
};

/// One organ: a point p of its shape lies at position + scale * (p.x * left + p.y * heading + p.z * up), metres.
struct OrganPlacement {
  std::uint32_t shape = 0;                           ///< of Foliage::shapes
  Vec3 position{0.0};
  Vec3 left{-1, 0, 0}, heading{0, 0, 1}, up{0, 1, 0};  ///< unit vectors at right angles; left x heading = up
  double scale = 1;                                  ///< above 0
  std::int32_t node = -1;                            ///< the skeleton's node that it was made behind; -1: before any
  std::uint32_t color = 0;                           ///< the turtle's colour index (`;` `,` `'`)
};

struct Foliage {
  std::vector<OrganShape> shapes;
  std::vector<OrganPlacement> organs;
};

}  // namespace cambium
