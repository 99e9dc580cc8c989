#include "blobtree/blobtree.h"

#include "blobtree/node_rules.h"

#include <array>
#include <limits>
#include <type_traits>
#include <utility>

namespace cambium {
namespace {

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

static_assert(std::variant_size_v<Node> <= std::numeric_limits<std::uint8_t>::max());

void check_room(const char* key, std::size_t held, std::size_t more) {
  constexpr std::size_t kLargest = std::numeric_limits<std::uint32_t>::max();
  if (more > kLargest - held) throw InvalidNode(key, "more than 4294967295 in all", "fewer");
}

template <class T>
std::size_t bytes_of(const std::vector<T>& array) { return array.capacity() * sizeof(T); }

/// Calls `act` with the node type of a kind, as std::type_identity.
template <class Act>
decltype(auto) with_type(std::size_t kind, Act&& act) {
  using Result = decltype(act(std::type_identity<std::variant_alternative_t<0, Node>>{}));
  static constexpr auto table = []<std::size_t... I>(std::index_sequence<I...>) {
    return std::array{
        +[](Act& chosen) -> Result { return chosen(std::type_identity<std::variant_alternative_t<I, Node>>{}); }...};
  }(std::make_index_sequence<std::variant_size_v<Node>>{});
  return table[kind](act);
}

}  // namespace

// ---- the store: in --------------------------------------------------------------------------------------------
KeptRange NodeStore::pooled(const std::vector<NodeId>& children) {
  check_room("children", children_.size(), children.size());
  const KeptRange range{static_cast<std::uint32_t>(children_.size()), static_cast<std::uint32_t>(children.size())};
  children_.insert(children_.end(), children.begin(), children.end());
  return range;
}

KeptRange NodeStore::pooled(std::vector<ChainNode>&& nodes) {
  check_room("nodes", chain_nodes_.size(), nodes.size());
  const KeptRange range{static_cast<std::uint32_t>(chain_nodes_.size()), static_cast<std::uint32_t>(nodes.size())};
  if (chain_nodes_.empty())
    chain_nodes_ = std::move(nodes);  // one long axis may be all there is
  else
    chain_nodes_.insert(chain_nodes_.end(), nodes.begin(), nodes.end());
  return range;
}

KeptChain NodeStore::pack(Chain& node) { return {pooled(std::move(node.nodes)), node.strength}; }

KeptFlare NodeStore::pack(Flare& node) {
  check_room("prongs", prongs_.size(), node.prongs.size());
  const KeptRange nodes = pooled(std::move(node.nodes));
  const KeptRange prongs{static_cast<std::uint32_t>(prongs_.size()), static_cast<std::uint32_t>(node.prongs.size())};
  prongs_.insert(prongs_.end(), node.prongs.begin(), node.prongs.end());
  return {nodes, prongs, node.base, node.axis, node.height, node.spread, node.sharpness, node.section, node.strength};
}

KeptFork NodeStore::pack(Fork& node) {
  check_room("laterals", children_.size(), node.laterals.size() + 1);
  const KeptFork kept{{static_cast<std::uint32_t>(children_.size()), static_cast<std::uint32_t>(node.laterals.size() + 1)},
                      static_cast<std::uint32_t>(laterals_.size()), node.width, node.lip};
  children_.push_back(node.axis);
  for (const Lateral& lateral : node.laterals) children_.push_back(lateral.child);
  laterals_.insert(laterals_.end(), node.laterals.begin(), node.laterals.end());
  return kept;
}

void NodeStore::append(Node&& node) {
  std::visit(
      [&]<class T>(T& given) {
        auto& array = std::get<kNodeKind<T>>(arrays_);
        array.push_back(pack(given));
        kinds_.push_back(static_cast<std::uint8_t>(kNodeKind<T>));
        places_.push_back(static_cast<std::uint32_t>(array.size() - 1));
      },
      node);
}

// ---- the store: out -------------------------------------------------------------------------------------------
template <class T>
T NodeStore::unpacked(const typename KeptAs<T>::type& kept) const {
  const auto list = [](auto span) { return std::vector(span.begin(), span.end()); };
  if constexpr (KeptWhole<T>) {
    return kept;
  } else if constexpr (KeptAsChildren<T>) {
    return {list(children(kept))};
  } else if constexpr (std::is_same_v<T, Chain>) {
    return {list(nodes(kept.nodes)), kept.strength};
  } else if constexpr (std::is_same_v<T, Flare>) {
    return {list(nodes(kept.nodes)), kept.base, kept.axis, kept.height, kept.spread, kept.sharpness, list(prongs(kept.prongs)),
            kept.section, kept.strength};
  } else if constexpr (std::is_same_v<T, Ricci>) {
    return {list(children(kept.children)), kept.exponent};
  } else if constexpr (std::is_same_v<T, Contact>) {
    return {list(children(kept.children)), kept.width, kept.lip};
  } else {
    static_assert(std::is_same_v<T, Fork>);
    return {children(kept.children)[0], list(laterals(kept)), kept.width, kept.lip};
  }
}

template <class T>
std::span<const NodeId> NodeStore::children_of_kept(const typename KeptAs<T>::type& kept) const {
  if constexpr (KeptAsChildren<T>) {
    return children(kept);
  } else if constexpr (requires { kept.children; }) {
    return children(kept.children);
  } else if constexpr (requires { kept.child; }) {
    return {&kept.child, 1};
  } else {
    return {};
  }
}

Node NodeStore::node(NodeId id) const {
  return with_type(kinds_[id], [&]<class T>(std::type_identity<T>) -> Node {
    return unpacked<T>(std::get<kNodeKind<T>>(arrays_)[places_[id]]);
  });
}

std::span<const NodeId> NodeStore::children(NodeId id) const {
  return with_type(kinds_[id], [&]<class T>(std::type_identity<T>) {
    return children_of_kept<T>(std::get<kNodeKind<T>>(arrays_)[places_[id]]);
  });
}

std::span<const ChainNode> NodeStore::chain_nodes(NodeId id) const {
  const std::uint32_t place = places_[id];
  if (kinds_[id] == kNodeKind<Chain>) return nodes(std::get<kNodeKind<Chain>>(arrays_)[place].nodes);
  if (kinds_[id] == kNodeKind<Flare>) return nodes(std::get<kNodeKind<Flare>>(arrays_)[place].nodes);
  return {};
}

std::span<const Lateral> NodeStore::laterals(NodeId id) const {
  if (kinds_[id] != kNodeKind<Fork>) return {};
  return laterals(std::get<kNodeKind<Fork>>(arrays_)[places_[id]]);
}

// ---- the store: memory ----------------------------------------------------------------------------------------
void NodeStore::shrink_to_fit() {
  std::apply([](auto&... array) { (array.shrink_to_fit(), ...); }, arrays_);
  kinds_.shrink_to_fit();
  places_.shrink_to_fit();
  children_.shrink_to_fit();
  chain_nodes_.shrink_to_fit();
  laterals_.shrink_to_fit();
  prongs_.shrink_to_fit();
}

std::size_t NodeStore::memory_bytes() const {
  const std::size_t by_kind = std::apply([](const auto&... array) { return (bytes_of(array) + ...); }, arrays_);
  return by_kind + bytes_of(kinds_) + bytes_of(places_) + bytes_of(children_) + bytes_of(chain_nodes_) +
         bytes_of(laterals_) + bytes_of(prongs_);
}

// ---- the tree and its builder ----------------------------------------------------------------------------------
const std::string& BlobTree::name(NodeId id) const {
  static const std::string none;
  const std::string* name = names_.find(id);
  return name ? *name : none;
}

const Attributes& BlobTree::attributes(NodeId id) const {
  static const Attributes none;
  const Attributes* attributes = attributes_.find(id);
  return attributes ? *attributes : none;
}

std::size_t BlobTree::memory_bytes() const {
  std::size_t bytes = nodes_.memory_bytes() + names_.memory_bytes() + attributes_.memory_bytes();
  const std::size_t inside = std::string().capacity();  // a short text is kept in the string itself
  for (const std::string& name : names_.values()) bytes += name.capacity() > inside ? name.capacity() + 1 : 0;
  return bytes;
}

NodeId BlobTreeBuilder::add(Node node) {
  if (size() >= std::numeric_limits<NodeId>::max())
    throw InvalidNode("node", "more than 4294967295 nodes", "fewer nodes");
  check_numbers(node);
  for_each_child(node, [&](NodeId child, auto key) {
    if (child >= size()) throw InvalidNode(key(), "unknown node " + std::to_string(child), "a node added before its parent");
    if (has_parent_[child])
      throw InvalidNode(key(), "node " + std::to_string(child) + ", which has a parent", "a node used once");
  });
  // A refused node leaves the builder as it was: what it had claimed is given back.
  std::size_t claimed = 0;
  const auto give_back = [&] {
    for_each_child(node, [&](NodeId child, auto) {
      if (claimed > 0) has_parent_[child] = false, --claimed;
    });
  };
  try {
    for_each_child(node, [&](NodeId child, auto key) {
      if (has_parent_[child]) throw InvalidNode(key(), "node " + std::to_string(child) + " twice", "a node used once");
      has_parent_[child] = true;
      ++claimed;
    });
    tree_.nodes_.append(std::move(node));
  } catch (const InvalidNode&) {
    give_back();
    throw;
  }
  has_parent_.push_back(false);
  return static_cast<NodeId>(size() - 1);
}

void BlobTreeBuilder::set_name(NodeId id, std::string name) {
  if (id >= size()) throw InvalidNode("name", "unknown node " + std::to_string(id), "a node added before");
  tree_.names_.set(id, std::move(name));
}

void BlobTreeBuilder::set_attributes(NodeId id, const Attributes& attributes) {
  if (id >= size()) throw InvalidNode("attributes", "unknown node " + std::to_string(id), "a node added before");
  tree_.attributes_.set(id, attributes);
}

BlobTree BlobTreeBuilder::build(NodeId root) {
  if (root >= size()) throw InvalidNode("root", "unknown node " + std::to_string(root), "a node added before");
  for (std::size_t id = 0; id < has_parent_.size(); ++id) {
    if (id == root && has_parent_[id]) throw InvalidNode("root", "a node that has a parent", "a node that has none");
    if (id != root && !has_parent_[id])
      throw InvalidNode("root", "node " + std::to_string(id) + ", which nothing uses", "every node to hang from the root");
  }
  BlobTree built = std::exchange(tree_, {});
  built.root_ = root;
  built.nodes_.shrink_to_fit();
  built.names_.shrink_to_fit();
  built.attributes_.shrink_to_fit();
  has_parent_.clear();
  return built;
}

std::vector<NodeId> children_of(const Node& node) {
  std::vector<NodeId> children;
  for_each_child(node, [&](NodeId child, auto) { children.push_back(child); });
  return children;
}

}  // namespace cambium
