#include "blobtree/lone_chain.h"

#include "blobtree/compiled_tree.h"
#include "blobtree/tape.h"

namespace cambium {

std::optional<LoneChain> LoneChain::of(const PrunedField& field) {
  if (field.empty() || field.tape_->instructions().size() != 1) return std::nullopt;
  const Instruction& in = field.tape_->instructions().front();
  if (in.op != Op::kChain || in.frame != 0) return std::nullopt;
  const CompiledTree& tree = *field.tree_;
  const CompiledNode& node = tree.nodes[in.node];
  const CompiledChain& chain = tree.chains[node.payload];
  if (chain.strength != 1) return std::nullopt;
  LoneChain lone;
  lone.primitive_ = in.node;
  lone.branch_ = tree.leaf_of(node).branch;
  lone.order_ = tree.leaf_of(node).order;
  lone.first_atom_ = node.first_atom;
  lone.nodes_ = std::span(tree.chain_nodes).subspan(chain.first_node, chain.node_count);
  lone.atoms_ = field.tape_->slots().subspan(in.first, in.count);
  return lone;
}

}  // namespace cambium
