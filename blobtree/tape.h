// From the atoms active in a box to the smallest tape that gives the same values there. Private to blobtree/.
//
// The tape is postfix: primitives push a value, operators replace their active children by one. Operators are rebuilt bottom-up
// from lowest common ancestors of neighbouring atoms, so the cost is that of the active atoms and of the operators that act on a
// single child, never that of the tree's depth. An operator above a single active child stays only if it could change it:
// a sum of one is its child; a contact of one is its child unless the child may be negative (field.md section 4).
#pragma once

#include "blobtree/compiled_tree.h"
#include "blobtree/field.h"

namespace cambium {

class TapeBuilder {
 public:
  TapeBuilder(std::shared_ptr<const CompiledTree> tree, const std::vector<std::uint32_t>& atoms, const Box& box);
  PrunedField build();

 private:
  struct Value {              ///< what stands on top of the tape's stack
    std::uint32_t node = 0;   ///< whose value it is
    std::uint32_t atom = 0;   ///< one atom below it, which tells the slot in any ancestor
    bool can_be_negative = false;
    bool is_segment = false;  ///< not a value yet: one segment of the chain `node`
  };
  struct Open {               ///< an operator whose active children are being collected
    std::uint32_t node = 0;
    std::vector<Value> children;
  };

  Value leaf(std::uint32_t atom);
  Value apply(std::uint32_t node, const std::vector<Value>& children);
  Value climb(Value value, std::uint32_t below);   ///< through operators that act on one child, up to but without `below`
  std::uint32_t slot_of(std::uint32_t node, std::uint32_t atom) const;
  std::uint16_t frame_of(std::uint32_t warp);
  void emit(Op op, std::uint32_t node, std::uint32_t warp, bool with_zero, std::uint32_t first, std::uint32_t count);

  const CompiledTree& tree_;
  const std::vector<std::uint32_t>& atoms_;
  PrunedField field_;
  std::uint32_t depth_ = 0;
};

/// Whether an atom can be non-zero in a box, by its bounds and, where no warp is in the way, by its shape.
bool is_active(const CompiledTree& tree, std::uint32_t atom, const Box& box, const Ball& ball);

}  // namespace cambium
