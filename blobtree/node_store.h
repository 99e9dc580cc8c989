// The nodes of a BlobTree as they are kept: by kind, with their lists in pools, so that no node has a heap block of its own.
// Private to blobtree/, but for being a part of BlobTree; implemented in blobtree.cpp.
#pragma once

#include "blobtree/nodes.h"

#include <cstddef>
#include <cstdint>
#include <span>
#include <tuple>
#include <type_traits>
#include <variant>
#include <vector>

namespace cambium {

/// A part of a pool.
struct KeptRange { std::uint32_t first = 0, count = 0; };
struct KeptChain { KeptRange nodes; double strength = 1; };
struct KeptFlare {
  KeptRange nodes, prongs;
  Vec3 base, axis;
  double height = 0, spread = 0, sharpness = 0;
  FlareSection section = FlareSection::kEnvelope;
  double strength = 1;
};
struct KeptRicci { KeptRange children; double exponent = 1; };
struct KeptContact { KeptRange children; double width = kIso, lip = 0; };
/// children begin with the axis; the laterals are one fewer.
struct KeptFork { KeptRange children; std::uint32_t first_lateral = 0; double width = kIso, lip = 0; };

template <class T, class... Types>
concept IsOneOf = (std::is_same_v<T, Types> || ...);
/// Of fixed size: kept as they are.
template <class T>
concept KeptWhole = IsOneOf<T, Cone, RoundCone, Sphere, Capsule, Disc, Torus, RotatedBox, HalfSpace, ScaleField, Transform,
                            Bend, Twist, Taper>;
/// Kept as the range of their children.
template <class T>
concept KeptAsChildren = IsOneOf<T, Sum, Union, Intersection, Difference>;

/// How a node type is kept. Has no definition for others, so a new node does not compile until it is here.
template <class T>
struct KeptAs;
template <KeptWhole T>
struct KeptAs<T> { using type = T; };
template <KeptAsChildren T>
struct KeptAs<T> { using type = KeptRange; };
template <>
struct KeptAs<Chain> { using type = KeptChain; };
template <>
struct KeptAs<Flare> { using type = KeptFlare; };
template <>
struct KeptAs<Ricci> { using type = KeptRicci; };
template <>
struct KeptAs<Contact> { using type = KeptContact; };
template <>
struct KeptAs<Fork> { using type = KeptFork; };

/// Appended to only. Spans stay valid until the next append.
class NodeStore {
 public:
  std::size_t size() const { return kinds_.size(); }
  std::size_t kind(NodeId id) const { return kinds_[id]; }
  Node node(NodeId id) const;
  /// A fork's axis first; empty for primitives.
  std::span<const NodeId> children(NodeId id) const;
  /// Empty unless the node is a chain or a flare.
  std::span<const ChainNode> chain_nodes(NodeId id) const;
  /// Empty unless the node is a fork.
  std::span<const Lateral> laterals(NodeId id) const;

  /// Errors: InvalidNode if a pool is full (2^32 entries); nothing has been appended then.
  void append(Node&& node);
  void shrink_to_fit();
  /// Bytes on the heap, capacity included.
  std::size_t memory_bytes() const;

 private:
  template <class Types>
  struct Arrays;
  template <class... Types>
  struct Arrays<std::variant<Types...>> { using type = std::tuple<std::vector<typename KeptAs<Types>::type>...>; };

  template <KeptWhole T>
  T pack(T& node) { return node; }
  template <KeptAsChildren T>
  KeptRange pack(T& node) { return pooled(node.children); }
  KeptChain pack(Chain& node);
  KeptFlare pack(Flare& node);
  KeptRicci pack(Ricci& node) { return {pooled(node.children), node.exponent}; }
  KeptContact pack(Contact& node) { return {pooled(node.children), node.width, node.lip}; }
  KeptFork pack(Fork& node);
  KeptRange pooled(const std::vector<NodeId>& children);
  KeptRange pooled(std::vector<ChainNode>&& nodes);

  template <class T>
  T unpacked(const typename KeptAs<T>::type& kept) const;
  template <class T>
  std::span<const NodeId> children_of_kept(const typename KeptAs<T>::type& kept) const;
  std::span<const NodeId> children(const KeptRange& range) const { return {children_.data() + range.first, range.count}; }
  std::span<const ChainNode> nodes(const KeptRange& range) const { return {chain_nodes_.data() + range.first, range.count}; }
  std::span<const Prong> prongs(const KeptRange& range) const { return {prongs_.data() + range.first, range.count}; }
  std::span<const Lateral> laterals(const KeptFork& kept) const {
    return {laterals_.data() + kept.first_lateral, kept.children.count - 1};
  }

  std::vector<std::uint8_t> kinds_;                  ///< by id: the node type's place in Node
  std::vector<std::uint32_t> places_;                ///< by id: in the array of that kind
  Arrays<Node>::type arrays_;
  std::vector<NodeId> children_;
  std::vector<ChainNode> chain_nodes_;
  std::vector<Lateral> laterals_;
  std::vector<Prong> prongs_;
};

}  // namespace cambium
