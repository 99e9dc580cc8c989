// The authored BlobTree: skeleton primitives and operators as plain values (field.md sections 2 to 5).
// Lengths in metres, angles in radians. Thread safety: a BlobTree is immutable.
#pragma once

#include "blobtree/geometry.h"

#include <cstdint>
#include <stdexcept>
#include <string>
#include <utility>
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
                          Intersection, Difference, Ricci, Contact, Fork, ScaleField, Transform, Bend, Twist, Taper>;

/// Surface coordinates that a primitive carries (field.md section 7; Tigges & Wyvill). Not part of BlobTree JSON.
/// u = angle about the primitive's axis / 2 pi from u_direction (parallel-transported along a chain);
/// v = v_begin + metres along the primitive from its first node. A zero u_direction means: choose one.
struct Attributes {
  std::uint32_t branch = 0;
  std::uint32_t order = 0;
  double v_begin = 0;
  Vec3 u_direction{0.0};
};

/// A node whose numbers or children are not legal. key names the offending member as in BlobTree JSON.
class InvalidNode : public std::invalid_argument {
 public:
  InvalidNode(std::string key, std::string found, std::string expected)
      : std::invalid_argument(key + ": found " + found + ", expected " + expected),
        key_(std::move(key)), found_(std::move(found)), expected_(std::move(expected)) {}
  const std::string& key() const { return key_; }
  const std::string& found() const { return found_; }
  const std::string& expected() const { return expected_; }

 private:
  std::string key_, found_, expected_;
};

/// Immutable value: an arena of nodes in which every child stands before its parent. The root is the last word.
class BlobTree {
 public:
  std::size_t size() const { return nodes_.size(); }
  const Node& node(NodeId id) const { return nodes_[id]; }
  NodeId root() const { return root_; }
  const std::string& name(NodeId id) const;                 ///< "" if none
  const Attributes& attributes(NodeId id) const;            ///< defaults if none were set

 private:
  friend class BlobTreeBuilder;
  std::vector<Node> nodes_;
  NodeId root_ = 0;
  std::vector<std::pair<NodeId, std::string>> names_;       ///< ascending ids
  std::vector<std::pair<NodeId, Attributes>> attributes_;   ///< ascending ids
};

/// Builds and validates. A child must have been added before its parent and may have only one parent.
class BlobTreeBuilder {
 public:
  /// Errors: InvalidNode for non-finite numbers, radii/widths <= 0, empty chains or operators, width/lip/exponent out of
  /// range, non-rigid matrices, zero directions, unknown or reused children. A legal node is stored as given.
  NodeId add(Node node);
  void set_name(NodeId id, std::string name);
  void set_attributes(NodeId id, const Attributes& attributes);
  std::size_t size() const { return tree_.nodes_.size(); }
  /// Errors: InvalidNode if a node other than root has no parent, or root has one.
  BlobTree build(NodeId root);

 private:
  BlobTree tree_;
  std::vector<bool> has_parent_;
};

/// Children of an operator in order (a fork's axis first); empty for primitives.
std::vector<NodeId> children_of(const Node& node);

}  // namespace cambium
