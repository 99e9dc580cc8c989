// The nodes of an authored BlobTree: skeleton primitives and operators as plain values (field.md sections 2 to 5).
// Lengths in metres, angles in radians.
#pragma once

#include "blobtree/geometry.h"

#include <cstddef>
#include <cstdint>
#include <type_traits>
#include <variant>
#include <vector>

namespace cambium {

inline constexpr double kIso = 0.5;                           ///< the surface is f = kIso, inside is f >= kIso
inline constexpr double kSupportPerRadius = 2.201663485154594;    ///< R = r / sqrt(1 - c^(1/3))
/// Its inverse. field.md prints 0.4542022449, which is off in the seventh digit: with it a chain would miss its radius by 5e-7 r.
inline constexpr double kRadiusPerSupport = 0.45420201894740647;

using NodeId = std::uint32_t;

// ---- primitives ------------------------------------------------------------------------------------------------
struct Cone { Vec3 base, tip; double radius_base = 0, radius_tip = 0; double strength = 1; };
struct RoundCone { Vec3 base, tip; double radius_base = 0, radius_tip = 0; double strength = 1; };
struct ChainNode { Vec3 position; double radius = 0; };
struct Chain { std::vector<ChainNode> nodes; double strength = 1; };
/// Cross-sections of a flare (blobtree/flare_sections-inl.h): of ellipses' envelope, which is an astroid for four sharp prongs; of the
/// quadrifolium's petals on a disc; of a circle shifted towards each prong.
enum class FlareSection : std::uint8_t { kEnvelope, kQuadrifolium, kCircle };
struct Prong { double angle = 0, length = 1; };                ///< length: how sharp it is, as a factor
/// A chain that is wider at its base (field.md section 6b): a circle at `height` above it, and from there down ever more spread
/// and pronged. Prongs stand at angles about the axis, right-handed from the x axis made orthogonal to it (y axis if parallel).
/// Not continuous on the axis where the chain is not on it, as below the chain's end: let the chain run on into the ground and cut it there.
/// Across the plane of the base the gradient has a crease.
struct Flare {
  std::vector<ChainNode> nodes;
  Vec3 base, axis;
  double height = 0, spread = 0, sharpness = 0;
  std::vector<Prong> prongs;
  FlareSection section = FlareSection::kEnvelope;
  double strength = 1;
};
struct Sphere { Vec3 center; double radius = 0; double strength = 1; };
struct Capsule { Vec3 a, b; double radius = 0; double strength = 1; };
struct Disc { Vec3 center, normal; double disc_radius = 0, radius = 0; double strength = 1; };
struct Torus { Vec3 center, normal; double ring_radius = 0, radius = 0; double strength = 1; };
/// rotation is the quaternion (w, x, y, z) that turns box axes into world axes.
struct RotatedBox { Vec3 center, half_size; glm::dvec4 rotation{1, 0, 0, 0}; double radius = 0; double strength = 1; };
struct HalfSpace { Vec3 point, normal; double width = 0; };

// ---- operators -------------------------------------------------------------------------------------------------
struct Sum { std::vector<NodeId> children; };
struct Union { std::vector<NodeId> children; };
struct Intersection { std::vector<NodeId> children; };
struct Difference { std::vector<NodeId> children; };          ///< the first minus the rest
struct Ricci { std::vector<NodeId> children; double exponent = 1; };
struct Contact { std::vector<NodeId> children; double width = kIso; double lip = 0; };
struct Lateral { NodeId child = 0; Vec3 point, direction; double softness = 0, reach = 0; };
struct Fork { NodeId axis = 0; std::vector<Lateral> laterals; double width = kIso; double lip = 0; };
struct ScaleField { double factor = 1; NodeId child = 0; };
struct Transform { Mat4 matrix{1.0}; NodeId child = 0; };     ///< glm matrix (column-major), rigid + uniform scale
struct Bend { Vec3 from, to, direction; double angle = 0; NodeId child = 0; };
struct Twist { Vec3 point, axis; double rate = 0; NodeId child = 0; };  ///< rad/m
struct Taper { Vec3 point, axis; double from_height = 0, from_scale = 1, to_height = 1, to_scale = 1; NodeId child = 0; };

using Node = std::variant<Cone, RoundCone, Chain, Sphere, Capsule, Disc, Torus, RotatedBox, HalfSpace, Sum, Union,
                          Intersection, Difference, Ricci, Contact, Fork, ScaleField, Transform, Bend, Twist, Taper, Flare>;

/// The place of a node type in Node: what BlobTree::kind() gives.
template <class T>
inline constexpr std::size_t kNodeKind = [] {
  std::size_t kind = 0;
  [&]<class... All>(const std::variant<All...>*) {
    (void)((std::is_same_v<T, All> || (++kind, false)) || ...);
  }(static_cast<const Node*>(nullptr));
  return kind;
}();

}  // namespace cambium
