#include "blobtree/lone_chain.h"

#include "blobtree/active_atoms.h"
#include "blobtree/compiled_tree.h"
#include "blobtree/tape.h"

#include <algorithm>

namespace cambium {
namespace {

/// Never below the largest child nor above the sum of children that are not negative (for contact: h(f) <= f, field.md section 4).
bool is_blend(Op op) {
  switch (op) {
    case Op::kSum:
    case Op::kUnion:
    case Op::kRicci:
    case Op::kContact:
    case Op::kFork: return true;
    case Op::kPrimitive:
    case Op::kHalfSpace:
    case Op::kChain:
    case Op::kFlare:
    case Op::kIntersection:
    case Op::kDifference:
    case Op::kScale:
    case Op::kWarp: return false;
  }
  return false;
}

/// A chain as it is authored: not in a warp's space, and of strength 1.
bool is_plain_chain(const CompiledTree& tree, const Instruction& in) {
  return in.op == Op::kChain && in.frame == 0 && tree.chains[tree.nodes[in.node].payload].strength == 1;
}

bool is_plain_primitive(const CompiledTree& tree, const Instruction& in) {
  return in.op == Op::kPrimitive && in.frame == 0 && tree.primitives.strength(tree.nodes[in.node].payload) == 1;
}

}  // namespace

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
    if (is_swept(instructions[i].op) && instructions[i].frame == 0) chains.push_back(ActiveChain(*field.tree_, *field.tape_, i));
  }
}

bool ActiveChain::all_blend(const PrunedField& part, const Box& box) {
  const CompiledTree& tree = *part.tree_;
  ActiveAtoms active;
  find_active(tree, box, active);
  TapeBuilder builder(tree);
  const auto instructions = builder.build(active.atoms).instructions();
  return std::all_of(instructions.begin(), instructions.end(),
                     [&](const Instruction& in) { return is_blend(in.op) || is_plain_chain(tree, in); });
}

std::vector<ActiveChain> ActiveChain::blended(const PrunedField& field) {
  std::vector<ActiveChain> chains;
  if (field.empty()) return chains;
  const auto instructions = field.tape_->instructions();
  for (std::size_t i = 0; i < instructions.size(); ++i) {
    if (is_blend(instructions[i].op)) continue;
    if (!is_plain_chain(*field.tree_, instructions[i])) return {};
    chains.push_back(ActiveChain(*field.tree_, *field.tape_, i));
  }
  return chains;
}

bool ActiveChain::only_blend(const PrunedField& field) {
  if (field.empty()) return false;
  const auto instructions = field.tape_->instructions();
  return std::all_of(instructions.begin(), instructions.end(),
                     [&](const Instruction& in) {
                       return is_blend(in.op) || is_plain_chain(*field.tree_, in) || is_plain_primitive(*field.tree_, in);
                     });
}

std::optional<LoneChain> LoneChain::of(const PrunedField& field) {
  if (field.empty() || field.tape_->instructions().size() != 1) return std::nullopt;
  if (!is_plain_chain(*field.tree_, field.tape_->instructions().front())) return std::nullopt;
  return LoneChain(*field.tree_, *field.tape_, 0);
}

}  // namespace cambium
