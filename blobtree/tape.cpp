#include "blobtree/tape.h"

#include <algorithm>
#include <stdexcept>
#include <utility>

namespace cambium {

bool is_active(const CompiledTree& tree, std::uint32_t atom, const Box& box, const Ball& ball) {
  const Atom& a = tree.atoms[atom];
  if (!a.bounds.intersects(box)) return false;
  if (tree.nodes[a.node].warp != kNone || !(ball.radius < kInfinity)) return true;
  // A hair wider, so that rounding here never drops a value that rounding elsewhere finds.
  const double hair = 1e-9 * (ball.radius + a.radius) + 1e-14 * glm::length(ball.center);
  const Interval f = atom_interval(tree, a, {ball.center, ball.radius + (hair < kInfinity ? hair : 0.0)});
  return f.lo != 0 || f.hi != 0;
}

TapeBuilder::TapeBuilder(std::shared_ptr<const CompiledTree> tree, const std::vector<std::uint32_t>& atoms, const Box& box)
    : tree_(*tree), atoms_(atoms) {
  field_.tree_ = std::move(tree);
  field_.box_ = box;
  field_.origin_ = box.bounded() ? box.center() : tree_.bounds.empty() ? Vec3(0.0) : tree_.bounds.center();
}

PrunedField TapeBuilder::build() {
  std::vector<Open> open;
  for (std::size_t i = 0; i < atoms_.size(); ++i) {
    Value current = leaf(atoms_[i]);
    const std::uint32_t next = i + 1 < atoms_.size() ? tree_.ancestors.common(atoms_[i], atoms_[i + 1]) : kNone;
    for (;;) {
      const bool has_open = !open.empty();
      const std::uint32_t top = has_open ? open.back().node : kNone;
      const bool deeper = next != kNone && (!has_open || tree_.nodes[next].depth > tree_.nodes[top].depth);
      const std::uint32_t target = deeper ? next : top;
      if (current.node != target) current = climb(current, target);
      if (deeper) {
        open.push_back({next, {current}});
        break;
      }
      if (!has_open) break;
      open.back().children.push_back(current);
      if (top == next) break;
      current = apply(top, open.back().children);
      open.pop_back();
    }
  }
  field_.atom_count_ = static_cast<std::uint32_t>(atoms_.size());
  return std::move(field_);
}

TapeBuilder::Value TapeBuilder::leaf(std::uint32_t atom) {
  const Atom& a = tree_.atoms[atom];
  const CompiledNode& n = tree_.nodes[a.node];
  field_.smallest_radius_ = std::min(field_.smallest_radius_, a.radius);
  if (n.op == Op::kChain) return {a.node, atom, n.can_be_negative, true};
  emit(n.op, a.node, n.warp, false, atom, 1);
  field_.stack_size_ = std::max(field_.stack_size_, ++depth_);
  return {a.node, atom, n.can_be_negative, false};
}

TapeBuilder::Value TapeBuilder::climb(Value value, std::uint32_t below) {
  if (value.is_segment) value = apply(value.node, {value});
  const std::uint32_t floor = below == kNone ? 0 : tree_.nodes[below].depth + 1;
  for (;;) {
    const std::uint32_t parent = tree_.nodes[value.node].parent;
    if (parent == kNone) return value;
    const CompiledNode& p = tree_.nodes[parent];
    const std::uint32_t next = value.can_be_negative ? p.keep_sensitive : p.keep_structural;
    if (next == kNone || tree_.nodes[next].depth < floor) return value;
    value = apply(next, {value});
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
    for (std::size_t i = field_.frames_.size(); i >= 2; i -= 2)
      if (field_.frames_[i - 2] == w) return static_cast<std::uint32_t>(i / 2);
    return w == kNone ? 0 : kNone;
  };
  std::vector<std::uint32_t> missing;
  for (std::uint32_t w = warp; known(w) == kNone; w = tree_.nodes[w].warp) missing.push_back(w);
  for (; !missing.empty(); missing.pop_back()) {
    const std::uint32_t parent = known(tree_.nodes[missing.back()].warp);
    field_.frames_.push_back(missing.back());
    field_.frames_.push_back(parent);
    if (field_.frames_.size() / 2 > 0xffff) throw std::length_error("more than 65535 warps active in one box");
  }
  return static_cast<std::uint16_t>(known(warp));
}

void TapeBuilder::emit(Op op, std::uint32_t node, std::uint32_t warp, bool with_zero, std::uint32_t first, std::uint32_t count) {
  field_.tape_.push_back({static_cast<std::uint8_t>(op), with_zero, frame_of(warp), node, first, count});
}

TapeBuilder::Value TapeBuilder::apply(std::uint32_t node, const std::vector<Value>& children) {
  const CompiledNode& n = tree_.nodes[node];
  const auto first = static_cast<std::uint32_t>(field_.slots_.size());
  const auto count = static_cast<std::uint32_t>(children.size());
  const bool with_zero = count < n.child_count;
  Value result{node, children[0].atom, false, false};
  if (n.op == Op::kChain) {
    for (const Value& c : children) field_.slots_.push_back(c.atom);
    emit(n.op, node, n.warp, false, first, count);
    field_.stack_size_ = std::max(field_.stack_size_, ++depth_);
    result.can_be_negative = n.can_be_negative;
    return result;
  }
  bool any = false, all = true;
  for (const Value& c : children) {
    any = any || c.can_be_negative;
    all = all && c.can_be_negative;
  }
  switch (n.op) {
    case Op::kSum: result.can_be_negative = any; break;
    case Op::kUnion:
    case Op::kContact: result.can_be_negative = all && !with_zero; break;
    case Op::kIntersection: result.can_be_negative = any; break;
    case Op::kWarp: result.can_be_negative = any; break;
    default: result.can_be_negative = n.can_be_negative;
  }
  const bool identity = count == 1 && (n.op == Op::kSum || ((n.op == Op::kUnion || n.op == Op::kContact) && (!any || !with_zero)));
  if (identity) return result;
  if (n.op == Op::kDifference || n.op == Op::kFork) {
    for (const Value& c : children) field_.slots_.push_back(slot_of(node, c.atom));
    const bool has_first = field_.slots_[first] == 0;
    if (n.op == Op::kFork && count == 1 && (has_first || !any)) {  // a bare axis; or a lateral away from its axis
      field_.slots_.resize(first);
      return result;
    }
    const std::uint32_t others = count - (has_first ? 1 : 0);
    emit(n.op, node, n.warp, others < n.child_count - 1, first, count);
  } else {
    emit(n.op, node, n.op == Op::kWarp ? node : n.warp, with_zero, first, count);
  }
  depth_ -= count - 1;
  return result;
}

}  // namespace cambium
