// Skeletons of any size for the scaling rows, made so that a tree of a million internodes looks, close up, like one of a
// thousand.
#pragma once

#include <cstddef>
#include <cstdint>

#include "skeletons/skeleton.h"

namespace cambium::bench {

/// A tree that fills a cube with exactly `internodes` internodes, branching at random.
///
/// Equal overlap at every size: a region of space is cut in two where a branch forks, each part gets internodes in
/// proportion to its volume, and a branch's radius is the cube root of the internodes that it bears (a pipe model, of
/// exponent 3). So radius, internode length and the distance to the next branch shrink alike, and a cell of one branch
/// diameter meets as many primitives on the trunk as on a twig, and in a large tree as in a small one. The cube's volume is
/// in proportion to the internodes. Nodes come depth first. Deterministic for a seed.
Skeleton random_tree(std::size_t internodes, std::uint64_t seed);

/// The same, every region cut into equal halves: a balanced binary tree.
Skeleton balanced_tree(std::size_t internodes);

/// One axis that bears nothing: a helix whose turns stay clear of each other's support. Internodes and radii like those of
/// random_tree's twigs.
Skeleton single_axis(std::size_t internodes);

}  // namespace cambium::bench
