// The authored BlobTree: a tree of skeleton primitives and operators (blobtree/nodes.h) as one immutable value.
// Thread safety: a BlobTree is immutable.
#pragma once

#include "blobtree/id_table.h"
#include "blobtree/invalid_node.h"
#include "blobtree/node_store.h"
#include "blobtree/nodes.h"

#include <cstddef>
#include <cstdint>
#include <span>
#include <string>
#include <variant>
#include <vector>

namespace cambium {

/// Surface coordinates that a primitive carries (field.md section 7; Tigges & Wyvill). Not part of BlobTree JSON.
/// u = angle about the primitive's axis / 2 pi from u_direction (parallel-transported along a chain);
/// v = v_begin + metres along the primitive from its first node. A zero u_direction means: choose one.
struct Attributes {
  std::uint32_t branch = 0;
  std::uint32_t order = 0;
  double v_begin = 0;
  Vec3 u_direction{0.0};
};

/// Immutable value: an arena of nodes in which every child stands before its parent. The root is the last word.
/// Nodes are kept by kind and their lists in pools: 32 bytes per node of a chain, 140 per internode that is a cone of its own.
class BlobTree {
 public:
  std::size_t size() const { return nodes_.size(); }
  NodeId root() const { return root_; }
  /// The whole node. Cost: copies its lists; the accessors below do not.
  Node node(NodeId id) const { return nodes_.node(id); }
  /// The same where its type is known. Errors: std::bad_variant_access if it is another.
  template <class T>
  T get(NodeId id) const { return std::get<T>(nodes_.node(id)); }
  /// Which type the node has: kNodeKind<Chain> for a chain.
  std::size_t kind(NodeId id) const { return nodes_.kind(id); }
  /// Children of an operator in order (a fork's axis first); empty for primitives. Spans are valid as long as the tree.
  std::span<const NodeId> children(NodeId id) const { return nodes_.children(id); }
  /// Empty unless the node is a chain or a flare.
  std::span<const ChainNode> chain_nodes(NodeId id) const { return nodes_.chain_nodes(id); }
  /// Empty unless the node is a fork.
  std::span<const Lateral> laterals(NodeId id) const { return nodes_.laterals(id); }
  const std::string& name(NodeId id) const;                 ///< "" if none
  const Attributes& attributes(NodeId id) const;            ///< defaults if none were set
  /// Bytes on the heap: the capacity of everything that the tree holds.
  std::size_t memory_bytes() const;

 private:
  friend class BlobTreeBuilder;
  NodeStore nodes_;
  NodeId root_ = 0;
  IdTable<std::string> names_;
  IdTable<Attributes> attributes_;
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
  /// Leaves the builder empty. Errors: InvalidNode if a node other than root has no parent, or root has one.
  BlobTree build(NodeId root);

 private:
  BlobTree tree_;
  std::vector<bool> has_parent_;
};

/// Children of an operator in order (a fork's axis first); empty for primitives.
std::vector<NodeId> children_of(const Node& node);

}  // namespace cambium
