// Runs the tape of a pruned field over any kind of value: numbers, numbers with gradients, intervals, surface traits.
// Private to blobtree/. A Policy knows the point (or ball, or lane) and supplies:
//   Value primitive(const Instruction&), half_space(const Instruction&), chain(const Instruction&), flare(const Instruction&),
//         lateral_weight(const Lateral&, const Instruction&), warp(const Instruction&, const Value&)
#pragma once

#include "blobtree/compiled_tree.h"
#include "blobtree/operators.h"
#include "blobtree/tape.h"

#include <span>
#include <vector>

namespace cambium {

template <class N>
N scaled(const N& f, double factor) {
  return f * N(static_cast<typename NumberOf<N>::type>(factor));
}

template <class Value>
struct TapeScratch {
  std::vector<Value> stack, weights;
};

/// A tape and the tree it was made from.
struct TapeView {
  const CompiledTree& tree;
  const Tape& tape;

  std::size_t frame_count() const { return 1 + tape.frames().size() / 2; }
  const Warp& warp_of(std::size_t frame) const {   // frame >= 1
    return tree.warps[tree.nodes[tape.frames()[2 * (frame - 1)]].payload].warp;
  }
  std::uint32_t outside_of(std::size_t frame) const { return tape.frames()[2 * (frame - 1) + 1]; }
};

/// The operators as they are. Other rules have the same members: to see what is chosen, or to choose otherwise.
struct PlainRules {
  template <class Value>
  Value unite(const Instruction&, const Value* f, std::size_t n, bool with_zero) const {
    return max_of(f, n, with_zero);
  }
  template <class Value>
  Value intersect(const Instruction&, const Value* f, std::size_t n, bool with_zero) const {
    return min_of(f, n, with_zero);
  }
  template <class Value>
  Value subtract(const Instruction&, const Value& first, const Value* taken, std::size_t n, bool capped) const {
    return difference_of(first, taken, n, capped);
  }
  template <class Value>
  Value touch(const Instruction&, const Value* f, std::size_t n, bool with_zero, const CompiledBlend& blend) const {
    return contact_of(f, n, with_zero, blend.width, blend.lip);
  }
  /// has_axis: else the axis is not active, and 0.
  template <class Value>
  Value fork(const Instruction&, bool has_axis, const Value& axis, const Value* f, const Value* weights, std::size_t n,
             bool with_zero, const CompiledBlend& blend) const {
    (void)has_axis;
    return fork_of(axis, f, weights, n, with_zero, blend.width, blend.lip);
  }
};

template <class Value, class Policy, class Rules>
Value run_tape(const TapeView& view, Policy& policy, TapeScratch<Value>& scratch, Rules& rules) {
  if (view.tape.instructions().empty()) return Value{};
  if (scratch.stack.size() < view.tape.stack_size()) scratch.stack.resize(view.tape.stack_size());
  Value* const stack = scratch.stack.data();
  const std::span<const std::uint32_t> slots = view.tape.slots();
  std::size_t top = 0;
  for (const Instruction& in : view.tape.instructions()) {
    const Op op = in.op;
    if (op == Op::kPrimitive) {
      stack[top++] = policy.primitive(in);
      continue;
    }
    if (op == Op::kChain) {
      stack[top++] = policy.chain(in);
      continue;
    }
    if (op == Op::kFlare) {
      stack[top++] = policy.flare(in);
      continue;
    }
    if (op == Op::kHalfSpace) {
      stack[top++] = policy.half_space(in);
      continue;
    }
    top -= in.count;
    Value* const f = stack + top;
    const CompiledNode& node = view.tree.nodes[in.node];
    const std::size_t n = in.count;
    const bool with_zero = in.with_zero;
    switch (op) {
      case Op::kSum: f[0] = sum_of(f, n); break;
      case Op::kUnion: f[0] = rules.unite(in, f, n, with_zero); break;
      case Op::kIntersection: f[0] = rules.intersect(in, f, n, with_zero); break;
      case Op::kRicci: f[0] = ricci_of(f, n, view.tree.numbers[node.payload]); break;
      case Op::kScale: f[0] = scaled(f[0], view.tree.numbers[node.payload]); break;
      case Op::kWarp: f[0] = policy.warp(in, f[0]); break;
      case Op::kDifference: {
        const bool has_first = slots[in.first] == 0;
        f[0] = rules.subtract(in, has_first ? f[0] : Value{}, f + has_first, n - has_first, with_zero);
        break;
      }
      case Op::kContact: f[0] = rules.touch(in, f, n, with_zero, view.tree.blends[node.payload]); break;
      case Op::kFork: {
        const CompiledBlend& blend = view.tree.blends[node.payload];
        const bool has_axis = slots[in.first] == 0;
        scratch.weights.clear();
        for (std::size_t k = has_axis; k < n; ++k)
          scratch.weights.push_back(policy.lateral_weight(view.tree.lateral_of(node, slots[in.first + k] - 1), in));
        f[0] = rules.fork(in, has_axis, has_axis ? f[0] : Value{}, f + has_axis, scratch.weights.data(), n - has_axis, with_zero,
                          blend);
        break;
      }
      case Op::kPrimitive:
      case Op::kHalfSpace:
      case Op::kChain:
      case Op::kFlare: break;
    }
    ++top;
  }
  return stack[0];
}

template <class Value, class Policy>
Value run_tape(const TapeView& view, Policy& policy, TapeScratch<Value>& scratch) {
  const PlainRules rules;
  return run_tape(view, policy, scratch, rules);
}

/// Value (and gradient) of f = strength g(x) from a normalised distance x = d * scale.
template <class N, class T>
N falloff_of(const Distance<T>& d, T scale, T strength) {
  const T x = d.value * scale;
  if constexpr (std::is_floating_point_v<N>) {
    return strength * falloff(x);
  } else {
    return N(strength * falloff(x), (strength * falloff_slope(x) * scale) * d.gradient);
  }
}

/// Of a half-space at signed distance s: a ramp of the given width.
template <class N, class T>
N half_space_of(T s, const Vec<T>& normal, T width) {
  const T t = T(0.5) - s / (2 * width);
  if (!(t > T(0))) return N(0);
  if (!(t < T(1))) return N(1);
  return with_gradient<N>(t, normal * (T(-0.5) / width));
}

}  // namespace cambium
