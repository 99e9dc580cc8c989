#include "blobtree/blobtree.h"

#include "blobtree/node_rules.h"

#include <algorithm>
#include <limits>
#include <type_traits>

namespace cambium {
namespace {

// Lookup in the sparse, id-sorted side tables.
template <class Table>
auto find_entry(Table& table, NodeId id) {
  return std::lower_bound(table.begin(), table.end(), id, [](const auto& entry, NodeId key) { return entry.first < key; });
}

template <class Table, class Value>
void set_entry(Table& table, NodeId id, Value value) {
  if (table.empty() || table.back().first < id) {
    table.emplace_back(id, std::move(value));
    return;
  }
  auto it = find_entry(table, id);
  if (it->first == id)
    it->second = std::move(value);
  else
    table.emplace(it, id, std::move(value));
}

// Calls visit(child, key) for every child, key built only when asked for.
template <class Visit>
void for_each_child(const Node& node, Visit&& visit) {
  std::visit(
      [&](const auto& n) {
        using T = std::decay_t<decltype(n)>;
        if constexpr (requires { n.children; }) {
          for (std::size_t i = 0; i < n.children.size(); ++i)
            visit(n.children[i], [i] { return "children[" + std::to_string(i) + "]"; });
        } else if constexpr (std::is_same_v<T, Fork>) {
          visit(n.axis, [] { return std::string("axis"); });
          for (std::size_t i = 0; i < n.laterals.size(); ++i)
            visit(n.laterals[i].child, [i] { return "laterals[" + std::to_string(i) + "].child"; });
        } else if constexpr (requires { n.child; }) {
          visit(n.child, [] { return std::string("child"); });
        }
      },
      node);
}

}  // namespace

const std::string& BlobTree::name(NodeId id) const {
  static const std::string none;
  const auto it = find_entry(names_, id);
  return it != names_.end() && it->first == id ? it->second : none;
}

const Attributes& BlobTree::attributes(NodeId id) const {
  static const Attributes none;
  const auto it = find_entry(attributes_, id);
  return it != attributes_.end() && it->first == id ? it->second : none;
}

NodeId BlobTreeBuilder::add(Node node) {
  if (tree_.nodes_.size() >= std::numeric_limits<NodeId>::max())
    throw InvalidNode("node", "more than 4294967295 nodes", "fewer nodes");
  check_numbers(node);
  for_each_child(node, [&](NodeId child, auto key) {
    if (child >= tree_.nodes_.size())
      throw InvalidNode(key(), "unknown node " + std::to_string(child), "a node added before its parent");
    if (has_parent_[child])
      throw InvalidNode(key(), "node " + std::to_string(child) + ", which has a parent", "a node used once");
  });
  // Marked only once all are known to be good, so that a refused node leaves the builder as it was.
  std::vector<NodeId> marked;
  for_each_child(node, [&](NodeId child, auto key) {
    if (has_parent_[child]) {
      for (const NodeId id : marked) has_parent_[id] = false;
      throw InvalidNode(key(), "node " + std::to_string(child) + " twice", "a node used once");
    }
    has_parent_[child] = true;
    marked.push_back(child);
  });
  tree_.nodes_.push_back(std::move(node));
  has_parent_.push_back(false);
  return static_cast<NodeId>(tree_.nodes_.size() - 1);
}

void BlobTreeBuilder::set_name(NodeId id, std::string name) {
  if (id >= tree_.nodes_.size()) throw InvalidNode("name", "unknown node " + std::to_string(id), "a node added before");
  set_entry(tree_.names_, id, std::move(name));
}

void BlobTreeBuilder::set_attributes(NodeId id, const Attributes& attributes) {
  if (id >= tree_.nodes_.size())
    throw InvalidNode("attributes", "unknown node " + std::to_string(id), "a node added before");
  set_entry(tree_.attributes_, id, attributes);
}

BlobTree BlobTreeBuilder::build(NodeId root) {
  if (root >= tree_.nodes_.size()) throw InvalidNode("root", "unknown node " + std::to_string(root), "a node added before");
  for (std::size_t id = 0; id < has_parent_.size(); ++id) {
    if (id == root && has_parent_[id]) throw InvalidNode("root", "a node that has a parent", "a node that has none");
    if (id != root && !has_parent_[id])
      throw InvalidNode("root", "node " + std::to_string(id) + ", which nothing uses", "every node to hang from the root");
  }
  BlobTree built = std::exchange(tree_, {});
  built.root_ = root;
  has_parent_.clear();
  return built;
}

std::vector<NodeId> children_of(const Node& node) {
  std::vector<NodeId> children;
  for_each_child(node, [&](NodeId child, auto) { children.push_back(child); });
  return children;
}

}  // namespace cambium
