// Space warps: f(p) = child(W^-1(p)) (field.md section 5; Barr 1984), with what evaluation, bounds and pruning ask of W.
#pragma once

#include "blobtree/blobtree.h"

#include <array>
#include <variant>

namespace cambium {

/// Rigid motion with uniform scale: p = origin + scale * axes * q.
struct RigidWarp {
  Vec3 origin{0.0};
  Mat3 axes{1.0};
  double scale = 1;
};

/// The straight child a + s u + y d + z n is bent to an arc from a to b that bulges towards d.
struct BendWarp {
  Vec3 a, b, center, u, d, n;
  double angle = 0, rho = 0, arc = 0;
  double inner = 0;  ///< smallest distance from the arc's centre that the child's support reaches, > 0
};

struct TwistWarp {
  Vec3 point, axis;
  double rate = 0;
};

struct TaperWarp {
  Vec3 point, axis;
  double from_height = 0, from_scale = 1, to_height = 1, to_scale = 1;
  Interval scale_at(double height) const;  ///< {scale, slope of the scale}
};

using Warp = std::variant<RigidWarp, BendWarp, TwistWarp, TaperWarp>;

RigidWarp rigid_warp(const Transform& transform);
/// A bend of (nearly) no angle is the identity.
Warp bend_warp(const Bend& bend);
TwistWarp twist_warp(const Twist& twist);
TaperWarp taper_warp(const Taper& taper);

/// W^-1.
Vec3 unwarp(const Warp& warp, const Vec3& p);

/// Gradient at p from the child's gradient g at unwarp(p): the transposed Jacobian of W^-1.
Vec3 pull_back(const Warp& warp, const Vec3& p, const Vec3& g);

/// What a bend makes of a velocity at p: the Jacobian of W^-1 times it.
Vec3 push_forward(const BendWarp& bend, const Vec3& p, const Vec3& velocity);
/// How far what a bend makes of one velocity anywhere in a ball may be from what it makes of it at the centre. The ball is one of whose
/// image unwarp() is certain.
double turn_in(const BendWarp& bend, const Ball& ball, const Vec3& velocity);

/// A ball that contains the image of the ball under W^-1. certain = false: no such ball is known, or the child's support does not
/// cover all of it, so that any value the child takes anywhere (or 0) is possible.
struct UnwarpedBall {
  Ball ball;
  bool certain = true;
};
UnwarpedBall unwarp(const Warp& warp, const Ball& ball);
/// Whether nothing of the child reaches into a ball, around the centre of a bend's arc: whatever W^-1 makes of it, the child is 0.
bool misses_child(const Warp& warp, const Ball& ball);

/// Extents of a child along the warp's own axes (first the axis of the warp, then two normals of it), relative to its anchor.
struct WarpFrame {
  Vec3 anchor;
  Mat3 axes;
};
WarpFrame warp_frame(const Warp& warp);
using Extents = std::array<Interval, 3>;
/// Box around W(everything within the extents).
Box warped_box(const Warp& warp, const Extents& extents);

}  // namespace cambium
