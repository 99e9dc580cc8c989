#include "blobtree/lone_chain.h"

#include "blobtree/compiled_tree.h"
#include "blobtree/tape.h"

namespace cambium {

ActiveChain::ActiveChain(const CompiledTree& tree, const Tape& tape, std::size_t instruction) {
  const Instruction& in = tape.instructions()[instruction];
  const CompiledNode& node = tree.nodes[in.node];
  const CompiledChain& chain = tree.chains[node.payload];
  primitive_ = in.node;
  branch_ = tree.leaf_of(node).branch;
  order_ = tree.leaf_of(node).order;
  first_atom_ = node.first_atom;
  nodes_ = std::span(tree.chain_nodes).subspan(chain.first_node, chain.node_count);
  atoms_ = tape.slots().subspan(in.first, in.count);
}

void ActiveChain::append(const PrunedField& field, std::vector<ActiveChain>& chains) {
  if (field.empty()) return;
  const auto instructions = field.tape_->instructions();
  for (std::size_t i = 0; i < instructions.size(); ++i) {
    if (instructions[i].op == Op::kChain && instructions[i].frame == 0) chains.push_back(ActiveChain(*field.tree_, *field.tape_, i));
  }
}

std::optional<LoneChain> LoneChain::of(const PrunedField& field) {
  if (field.empty() || field.tape_->instructions().size() != 1) return std::nullopt;
  const Instruction& in = field.tape_->instructions().front();
  if (in.op != Op::kChain || in.frame != 0) return std::nullopt;
  if (field.tree_->chains[field.tree_->nodes[in.node].payload].strength != 1) return std::nullopt;
  return LoneChain(*field.tree_, *field.tape_, 0);
}

}  // namespace cambium
