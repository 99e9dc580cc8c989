// One cell on a surface, and primitives of which each passes through it: the setting of the batch rows.
#pragma once

#include <stdexcept>
#include <string>

#include "bench/random_numbers.h"
#include "blobtree/field.h"

namespace cambium::bench {

/// About a block of a mesh on a branch of this radius, metres.
inline constexpr double kBranchRadius = 0.05;
inline const Box kCell{Vec3(-0.03), Vec3(0.03)};

/// A line along a branch whose surface passes through the middle of the cell.
struct BranchLine {
  Vec3 middle, along;
};
inline BranchLine branch_line(RandomNumbers& random) {
  const Vec3 along = random.direction();
  return {kBranchRadius * random.between(0.8, 1.2) * random.across(along), along};
}

/// A cone of the general case (it tapers) along such a line, 0.3 m long.
inline Cone cone_through_cell(RandomNumbers& random) {
  const BranchLine line = branch_line(random);
  return {line.middle - 0.15 * line.along, line.middle + 0.15 * line.along, 1.2 * kBranchRadius, kBranchRadius, 1};
}

/// A chain of that many segments, gently winding and tapering, of the given length in metres.
inline Chain chain_through_cell(RandomNumbers random, int segments, double length) {
  const BranchLine line = branch_line(random);
  const Vec3 sideways = random.across(line.along);
  Chain chain;
  for (int i = 0; i <= segments; ++i) {
    const double t = i / static_cast<double>(segments);
    chain.nodes.push_back({line.middle + length * (t - 0.5) * line.along + 0.04 * length * std::sin(5 * t) * sideways,
                           kBranchRadius * (1.1 - 0.2 * t)});
  }
  return chain;
}

/// The field pruned to the cell. Errors: std::logic_error unless exactly `atoms` primitives are active in it.
inline PrunedField pruned_to_cell(const BlobTree& tree, std::size_t atoms) {
  PrunedField field = Field(tree).prune(kCell);
  if (field.atom_count() != atoms)
    throw std::logic_error("a cell of the benchmark holds " + std::to_string(field.atom_count()) + " primitives, not " +
                           std::to_string(atoms));
  return field;
}

/// The longest chain of `segments` whose segments are all active in the cell, alone in a field.
/// Errors: std::logic_error if there is none.
inline PrunedField chain_pruned_to_cell(RandomNumbers random, int segments) {
  for (double length = 0.24; length > 0.01; length *= 0.9) {
    BlobTreeBuilder builder;
    const NodeId root = builder.add(chain_through_cell(random, segments, length));
    PrunedField field = Field(builder.build(root)).prune(kCell);
    if (field.atom_count() == static_cast<std::size_t>(segments)) return field;
  }
  throw std::logic_error("no chain of " + std::to_string(segments) + " segments is wholly active in the benchmark's cell");
}

}  // namespace cambium::bench
