// From the atoms active in a box to the smallest tape that gives the same values there. Private to blobtree/.
//
// The tape is postfix: primitives push a value, operators replace their active children by one. Operators are rebuilt bottom-up
// from lowest common ancestors of neighbouring atoms, so the cost is that of the active atoms and of the operators that act on a
// single child, never that of the tree's depth. An operator above a single active child stays only if it could change it:
// a sum of one is its child; a contact of one is its child unless the child may be negative (field.md section 4).
#pragma once

#include "blobtree/compiled_tree.h"

#include <cstdint>
#include <memory>
#include <span>
#include <vector>

namespace cambium {

struct Instruction {
  Op op = Op::kSum;
  bool with_zero = false;          ///< operators: a child is left out because it is 0 here
  std::uint16_t frame = 0;         ///< the space it works in; 0 is the world
  std::uint32_t node = 0;          ///< node in the compiled tree
  std::uint32_t first = 0;         ///< first of `count` entries in slots; of a primitive, its atom
  std::uint32_t count = 0;
  bool operator==(const Instruction&) const = default;
};

/// A tape does not depend on the box that it was made for, only on the atoms active there: neighbouring cells share it.
/// The arrays belong to whoever made it.
struct Tape {
  std::span<const Instruction> instructions;
  std::span<const std::uint32_t> slots;    ///< child slots of forks and differences, atoms of chains
  std::span<const std::uint32_t> frames;   ///< per frame after the world: its warp node and the frame outside of it
  std::uint32_t stack_size = 0;
  std::uint32_t atom_count = 0;
  double smallest_radius = kInfinity;      ///< of an active primitive, metres

  bool empty() const { return instructions.empty(); }
  std::size_t frame_count() const { return 1 + frames.size() / 2; }
  std::uint32_t outside_of(std::size_t frame) const { return frames[2 * (frame - 1) + 1]; }   // frame >= 1
  std::size_t array_bytes() const { return instructions.size_bytes() + slots.size_bytes() + frames.size_bytes(); }
};

/// A tape that owns its arrays.
class OwnedTape {
 public:
  OwnedTape() = default;
  explicit OwnedTape(const Tape& tape)
      : instructions_(tape.instructions.begin(), tape.instructions.end()), slots_(tape.slots.begin(), tape.slots.end()),
        frames_(tape.frames.begin(), tape.frames.end()), tape_(tape) {
    tape_.instructions = instructions_;
    tape_.slots = slots_;
    tape_.frames = frames_;
  }
  OwnedTape(const OwnedTape&) = delete;
  OwnedTape& operator=(const OwnedTape&) = delete;
  const Tape& tape() const { return tape_; }

 private:
  std::vector<Instruction> instructions_;
  std::vector<std::uint32_t> slots_, frames_;
  Tape tape_;
};

/// Scratch for making tapes of one tree; one per thread.
class TapeBuilder {
 public:
  explicit TapeBuilder(const CompiledTree& tree) : tree_(tree) {}
  /// `atoms` ascending. The tape's arrays are valid until the next call. Errors: std::length_error for more than 65535 warps.
  const Tape& build(std::span<const std::uint32_t> atoms);

 private:
  struct Value {              ///< what stands on top of the tape's stack
    std::uint32_t node = 0;   ///< whose value it is
    std::uint32_t atom = 0;   ///< one atom below it, which tells the slot in any ancestor
    bool can_be_negative = false;
    bool is_segment = false;  ///< not a value yet: one segment of the chain `node`
  };
  struct Open {               ///< an operator whose active children are being collected, from `first` in collected_
    std::uint32_t node = 0;
    std::size_t first = 0;
  };

  Value leaf(std::uint32_t atom);
  Value apply(std::uint32_t node, std::span<const Value> children);
  Value climb(Value value, std::uint32_t below);   ///< through operators that act on one child, up to but without `below`
  std::uint32_t slot_of(std::uint32_t node, std::uint32_t atom) const;
  std::uint16_t frame_of(std::uint32_t warp);
  void emit(Op op, std::uint32_t node, std::uint32_t warp, bool with_zero, std::uint32_t first, std::uint32_t count);

  const CompiledTree& tree_;
  std::vector<Open> open_;
  std::vector<Value> collected_;
  std::vector<Instruction> instructions_;
  std::vector<std::uint32_t> slots_, frames_, missing_;
  std::uint32_t depth_ = 0;
  Tape tape_;
};

}  // namespace cambium
