// From the atoms active in a box to the smallest tape that gives the same values there. Private to blobtree/.
//
// The tape is postfix: primitives push a value, operators replace their active children by one. Operators are rebuilt
// bottom-up from lowest common ancestors of neighbouring atoms, so the cost is that of the active atoms and of the
// operators that act on a single child, never that of the tree's depth. An operator above a single active child stays
// only if it could change it: a sum of one is its child; a contact of one is its child unless the child may be negative;
// a difference of which nothing is taken away here is its first child unless that may exceed 2 c = 1 (field.md section 4).
#pragma once

#include "blobtree/compiled_tree.h"

#include <cstddef>
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
static_assert(sizeof(Instruction) == 16);   // nothing between its members: tapes are compared as bytes

/// A tape does not depend on the box that it was made for, only on the atoms active there: neighbouring cells share it.
/// Its arrays lie in one block of memory that belongs to whoever made it: instructions, slots, frames.
class Tape {
 public:
  Tape() = default;

  std::span<const Instruction> instructions() const { return {instructions_, instruction_count_}; }
  /// Child slots of forks and differences, atoms of chains.
  std::span<const std::uint32_t> slots() const { return {words(), slot_count_}; }
  /// Per frame after the world: its warp node and the frame outside of it.
  std::span<const std::uint32_t> frames() const { return {words() + slot_count_, frame_word_count_}; }
  std::uint32_t stack_size() const { return stack_size_; }
  std::uint32_t atom_count() const { return atom_count_; }
  /// Of an active primitive, metres.
  double smallest_radius() const { return smallest_radius_; }
  bool empty() const { return instruction_count_ == 0; }

  /// Of its arrays.
  std::size_t array_bytes() const {
    return instruction_count_ * sizeof(Instruction) + (std::size_t{slot_count_} + frame_word_count_) * sizeof(std::uint32_t);
  }
  /// The same tape with its arrays copied to `memory`, which is aligned for an Instruction and holds array_bytes().
  Tape copied_to(std::byte* memory) const;
  /// Whether the contents are the same; of one tree, so are the tapes then.
  bool same_arrays(const Tape& other) const;

 private:
  friend class TapeBuilder;
  const std::uint32_t* words() const { return reinterpret_cast<const std::uint32_t*>(instructions_ + instruction_count_); }
  const Instruction* instructions_ = nullptr;
  std::uint32_t instruction_count_ = 0, slot_count_ = 0, frame_word_count_ = 0;
  std::uint32_t stack_size_ = 0, atom_count_ = 0;
  double smallest_radius_ = kInfinity;
};

/// A tape that owns its arrays.
class OwnedTape {
 public:
  explicit OwnedTape(const Tape& tape)
      : memory_(std::make_unique_for_overwrite<std::byte[]>(tape.array_bytes())), tape_(tape.copied_to(memory_.get())) {}
  const Tape& tape() const { return tape_; }

 private:
  std::unique_ptr<std::byte[]> memory_;
  Tape tape_;
};

/// The tape from which something was made. Knows it again even where the first and its tree are gone and others have taken their
/// place in memory.
class RememberedTape {
 public:
  bool is(const CompiledTree& tree, const Tape& tape) const { return known_ && is_of(tree) && tape_.same_arrays(tape); }
  void remember(const CompiledTree& tree, const Tape& tape) {
    arrays_.resize(tape.array_bytes());
    tape_ = tape.copied_to(arrays_.data());
    if (!is_of(tree)) tree_ = tree.weak_from_this();   // threads share its counter: left alone where it can be
    address_ = &tree;
    known_ = true;
  }
  void forget() { known_ = false; }

 private:
  /// While a tree lives its address tells which it is.
  bool is_of(const CompiledTree& tree) const { return address_ == &tree && !tree_.expired(); }

  bool known_ = false;
  std::weak_ptr<const CompiledTree> tree_;
  const CompiledTree* address_ = nullptr;
  std::vector<std::byte> arrays_;
  Tape tape_;
};

/// Scratch for making tapes of one tree; one per thread.
class TapeBuilder {
 public:
  explicit TapeBuilder(const CompiledTree& tree) : tree_(tree) {}
  /// `atoms` ascending. The tape's arrays are valid until the next call. Errors: std::length_error for more than 65535
  /// warps.
  const Tape& build(std::span<const std::uint32_t> atoms);

 private:
  struct Value {              ///< what stands on top of the tape's stack
    std::uint32_t node = 0;   ///< whose value it is
    std::uint32_t atom = 0;   ///< one atom below it, which tells the slot in any ancestor
    ValueClass may;
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
  std::vector<Instruction> packed_;   ///< all of the tape in one block
  Tape tape_;
};

}  // namespace cambium
