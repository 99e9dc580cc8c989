// Cells in which nothing but one chain is active: there the surface is exactly the sphere-swept polyline of that chain
// (field.md section 3), and can be met or followed in closed form. A flare is such a chain in cells where only those of its segments are
// active that are nowhere widened.
#pragma once

#include "blobtree/field.h"
#include "blobtree/nodes.h"

#include <array>
#include <cstdint>
#include <optional>
#include <span>
#include <vector>

namespace cambium {

class Tape;

/// A chain that is active in a pruned field, in world space. A view: valid while the field (or its cover) lives. Cheap to copy.
class ActiveChain {
 public:
  /// Appends all that are, lone or not, flares as the chains that they are made of, but for warped ones. Cost: linear in the tape.
  static void append(const PrunedField& field, std::vector<ActiveChain>& chains);
  /// The chains of a field that is nowhere below the largest of them nor above their sum: all that is active are chains of strength 1,
  /// not warped, under sums, unions, contacts, forks and Ricci blends. Where all but one are 0 the field is that one's. None if
  /// the field is not like that. Cost: linear in the tape.
  static std::vector<ActiveChain> blended(const PrunedField& field);
  /// Whether the whole field, which `part` is pruned from, is like that all over a box. Cost: as Field::prune().
  static bool all_blend(const PrunedField& part, const Box& box);
  /// Whether nothing is active but chains and other primitives of strength 1, not warped, under those operators. Cost: linear in the tape.
  static bool only_blend(const PrunedField& field);

  std::uint32_t primitive() const { return primitive_; }   ///< as Contribution::primitive
  std::uint32_t branch() const { return branch_; }
  std::uint32_t order() const { return order_; }
  /// All nodes of the chain, root to tip, in world space; at least two. Node k of one chain is the same in all its cells.
  std::span<const ChainNode> nodes() const { return nodes_; }

  /// Those of its segments that are active here.
  std::size_t segment_count() const { return atoms_.size(); }
  /// The k-th: it lies between nodes()[number] and nodes()[number + 1]. Ascending, perhaps with gaps.
  std::uint32_t segment_number(std::size_t k) const { return atoms_[k] - first_atom_; }
  std::array<ChainNode, 2> segment(std::size_t k) const {
    const std::uint32_t number = segment_number(k);
    return {nodes_[number], nodes_[number + 1]};
  }

 protected:
  ActiveChain(const CompiledTree& tree, const Tape& tape, std::size_t instruction);

 private:
  std::uint32_t primitive_ = 0, branch_ = 0, order_ = 0, first_atom_ = 0;
  std::span<const ChainNode> nodes_;
  std::span<const std::uint32_t> atoms_;
};

/// The surface in the cell is that of the union of the segments.
class LoneChain : public ActiveChain {
 public:
  /// nullopt where anything else is active, the chain is warped, or its strength is not 1. Cost: constant.
  static std::optional<LoneChain> of(const PrunedField& field);

 private:
  using ActiveChain::ActiveChain;
};

}  // namespace cambium
