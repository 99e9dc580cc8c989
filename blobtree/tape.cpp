#include "blobtree/tape.h"

#include <algorithm>
#include <cstring>
#include <stdexcept>

namespace cambium {

Tape Tape::copied_to(std::byte* memory) const {
  if (!empty()) std::memcpy(memory, instructions_, array_bytes());
  Tape copy = *this;
  copy.instructions_ = reinterpret_cast<const Instruction*>(memory);
  return copy;
}

bool Tape::same_arrays(const Tape& other) const {
  return instruction_count_ == other.instruction_count_ && slot_count_ == other.slot_count_ &&
         frame_word_count_ == other.frame_word_count_ &&
         (empty() || std::memcmp(instructions_, other.instructions_, array_bytes()) == 0);
}

const Tape& TapeBuilder::build(std::span<const std::uint32_t> atoms) {
  open_.clear();
  collected_.clear();
  instructions_.clear();
  slots_.clear();
  frames_.clear();
  depth_ = 0;
  tape_ = {};
  for (std::size_t i = 0; i < atoms.size(); ++i) {
    Value current = leaf(atoms[i]);
    const std::uint32_t next = i + 1 < atoms.size() ? tree_.common_ancestor(atoms[i], atoms[i + 1]) : kNone;
    for (;;) {
      const bool has_open = !open_.empty();
      const std::uint32_t top = has_open ? open_.back().node : kNone;
      const bool deeper = next != kNone && (!has_open || tree_.nodes[next].depth > tree_.nodes[top].depth);
      const std::uint32_t target = deeper ? next : top;
      if (current.node != target) current = climb(current, target);
      if (deeper) open_.push_back({next, collected_.size()});
      if (!deeper && !has_open) break;
      collected_.push_back(current);
      if (deeper || top == next) break;
      const std::size_t first = open_.back().first;
      open_.pop_back();
      current = apply(top, std::span<const Value>(collected_).subspan(first));
      collected_.resize(first);
    }
  }
  tape_.atom_count_ = static_cast<std::uint32_t>(atoms.size());
  tape_.instruction_count_ = static_cast<std::uint32_t>(instructions_.size());
  tape_.slot_count_ = static_cast<std::uint32_t>(slots_.size());
  tape_.frame_word_count_ = static_cast<std::uint32_t>(frames_.size());
  packed_.resize((tape_.array_bytes() + sizeof(Instruction) - 1) / sizeof(Instruction));
  tape_.instructions_ = packed_.data();
  std::copy(instructions_.begin(), instructions_.end(), packed_.begin());
  auto* const words = reinterpret_cast<std::uint32_t*>(packed_.data() + instructions_.size());
  std::copy(frames_.begin(), frames_.end(), std::copy(slots_.begin(), slots_.end(), words));
  return tape_;
}

TapeBuilder::Value TapeBuilder::leaf(std::uint32_t atom) {
  const std::uint32_t node = tree_.node_of_atom[atom];
  const CompiledNode& n = tree_.nodes[node];
  tape_.smallest_radius_ = std::min(tape_.smallest_radius_, tree_.radius_of(atom));
  if (is_swept(n.op)) return {node, atom, {n.can_be_negative, n.can_exceed_one}, true};
  emit(n.op, node, n.warp, false, atom, 1);
  tape_.stack_size_ = std::max(tape_.stack_size_, ++depth_);
  return {node, atom, {n.can_be_negative, n.can_exceed_one}, false};
}

TapeBuilder::Value TapeBuilder::climb(Value value, std::uint32_t below) {
  if (value.is_segment) value = apply(value.node, {&value, 1});
  const std::uint32_t floor = below == kNone ? 0 : tree_.nodes[below].depth + 1;
  for (;;) {
    const CompiledNode& n = tree_.nodes[value.node];
    const std::uint32_t next = n.acts_above[value.may.index()];
    if (next == kNone || tree_.nodes[next].depth < floor) return value;
    value = apply(next, {&value, 1});
  }
}

std::uint32_t TapeBuilder::slot_of(std::uint32_t node, std::uint32_t atom) const {
  const CompiledNode& n = tree_.nodes[node];
  const std::uint32_t* begin = tree_.children.data() + n.first_child;
  const std::uint32_t* found = std::upper_bound(begin, begin + n.child_count, atom, [&](std::uint32_t a, std::uint32_t child) {
    return a < tree_.nodes[child].first_atom;
  });
  return static_cast<std::uint32_t>(found - begin) - 1;
}

std::uint16_t TapeBuilder::frame_of(std::uint32_t warp) {
  if (warp == kNone) return 0;
  const auto known = [&](std::uint32_t w) -> std::uint32_t {
    for (std::size_t i = frames_.size(); i >= 2; i -= 2)
      if (frames_[i - 2] == w) return static_cast<std::uint32_t>(i / 2);
    return w == kNone ? 0 : kNone;
  };
  missing_.clear();
  for (std::uint32_t w = warp; known(w) == kNone; w = tree_.nodes[w].warp) missing_.push_back(w);
  for (; !missing_.empty(); missing_.pop_back()) {
    const std::uint32_t parent = known(tree_.nodes[missing_.back()].warp);
    frames_.push_back(missing_.back());
    frames_.push_back(parent);
    if (frames_.size() / 2 > 0xffff) throw std::length_error("more than 65535 warps active in one box");
  }
  return static_cast<std::uint16_t>(known(warp));
}

void TapeBuilder::emit(Op op, std::uint32_t node, std::uint32_t warp, bool with_zero, std::uint32_t first, std::uint32_t count) {
  instructions_.push_back({op, with_zero, frame_of(warp), node, first, count});
}

TapeBuilder::Value TapeBuilder::apply(std::uint32_t node, std::span<const Value> children) {
  const CompiledNode& n = tree_.nodes[node];
  const auto first = static_cast<std::uint32_t>(slots_.size());
  const auto count = static_cast<std::uint32_t>(children.size());
  const bool with_zero = count < n.child_count;
  Value result{node, children[0].atom, {n.can_be_negative, n.can_exceed_one}, false};
  if (is_swept(n.op)) {
    bool is_chain = true;   // so is a flare of which only what stands above it is active
    for (const Value& c : children) {
      slots_.push_back(c.atom);
      is_chain = is_chain && tree_.reach_of(n, c.atom) == 1;
    }
    emit(is_chain ? Op::kChain : Op::kFlare, node, n.warp, false, first, count);
    tape_.stack_size_ = std::max(tape_.stack_size_, ++depth_);
    return result;
  }
  bool any = false, all = true, any_exceeds = false, all_exceed = true;
  for (const Value& c : children) {
    any = any || c.may.can_be_negative;
    all = all && c.may.can_be_negative;
    any_exceeds = any_exceeds || c.may.can_exceed_one;
    all_exceed = all_exceed && c.may.can_exceed_one;
  }
  const bool blend_exceeds = count == 1 ? any_exceeds : n.can_exceed_one;
  switch (n.op) {
    case Op::kSum: result.may = {any, blend_exceeds}; break;
    case Op::kUnion: result.may = {all && !with_zero, any_exceeds}; break;
    case Op::kContact: result.may = {all && !with_zero, blend_exceeds}; break;
    case Op::kIntersection: result.may = {any, all_exceed && !with_zero}; break;
    case Op::kWarp: result.may = {any, any_exceeds}; break;
    case Op::kFork: result.may.can_exceed_one = blend_exceeds; break;
    default: break;   // of a difference see below; the others as anywhere
  }
  const bool identity = count == 1 && (n.op == Op::kSum || ((n.op == Op::kUnion || n.op == Op::kContact) && (!any || !with_zero)));
  if (identity) return result;
  if (n.op == Op::kDifference || n.op == Op::kFork) {
    for (const Value& c : children) slots_.push_back(slot_of(node, c.atom));
    const bool has_first = slots_[first] == 0;
    if (n.op == Op::kFork && count == 1 && (has_first || !any)) {  // a bare axis; or a lateral away from its axis
      slots_.resize(first);
      return result;
    }
    const bool other_is_zero = count - (has_first ? 1 : 0) < n.child_count - 1;
    if (n.op == Op::kDifference) result.may.can_exceed_one = has_first && children[0].may.can_exceed_one && !other_is_zero;
    emit(n.op, node, n.warp, other_is_zero, first, count);
  } else {
    emit(n.op, node, n.op == Op::kWarp ? node : n.warp, with_zero, first, count);
  }
  depth_ -= count - 1;
  return result;
}

}  // namespace cambium
