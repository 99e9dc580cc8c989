// The shapes that graphs are grown in and around (Xu and Mould 2012, section 3.3.1). Each in its own frame, z up, metres.
#pragma once

#include "blobtree/geometry.h"

#include <cstdint>
#include <memory>
#include <numbers>
#include <variant>
#include <vector>

namespace cambium {

class ClosedMesh;

/// The part of a ball around the origin whose directions are within `angle` of z: pi is the whole ball, pi/2 a hemisphere, less a
/// cone with a round lid and its tip in the origin.
struct BallSolid {
  double radius = 1;
  double angle = std::numbers::pi;   ///< radians, (0, pi]
};
struct EllipsoidSolid { Vec3 half_size{1.0}; };                    ///< around the origin
struct CylinderSolid { double radius = 1, height = 1; };           ///< from z = 0 to z = height
struct ConeSolid { double radius_base = 1, radius_tip = 0, height = 1; };   ///< from z = 0 to z = height; radius_base = 0 stands on its tip
/// What a stroke sweeps as it turns about z: (distance from it, z) of each point. An end that is off the axis is joined to it on its own
/// height, unless the stroke ends where it began.
struct RevolutionSolid { std::vector<glm::dvec2> stroke; };
struct MeshSolid { std::shared_ptr<const ClosedMesh> mesh; };      ///< not null

using Solid = std::variant<BallSolid, EllipsoidSolid, CylinderSolid, ConeSolid, RevolutionSolid, MeshSolid>;

Box bounds(const Solid& solid);
/// Errors: InputError (no location) that names the number at fault, by its key in a recipe (and a stroke's point by its number from 1).
void validate(const Solid& solid);
/// As PreparedSolid (prepared_solid.h) answers, which is what to make for more than one question.
bool contains(const Solid& solid, const Vec3& p);
double depth(const Solid& solid, const Vec3& p);

/// A solid turned so that its z is `axis`, scaled, and moved so that its origin is `origin`.
struct PlacedSolid {
  Solid solid;
  Vec3 origin{0.0};
  Vec3 axis{0, 0, 1};                ///< any length but 0; x goes where the smallest rotation from z to it takes it
  double scale = 1;                  ///< > 0
  bool endpoints = true;             ///< whether endpoints may be placed in it; a trunk's volume bears none
  /// Which subvolume it is of: edges join nodes of one subvolume, or any with those of subvolume 0 (section 3.3.1, figure 12).
  std::uint16_t part = 0;
};

}  // namespace cambium
