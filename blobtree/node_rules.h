// Which numbers are legal in a BlobTree node (private to blobtree/).
#pragma once

#include "blobtree/blobtree.h"

namespace cambium {

/// Lengths and coordinates larger than this, and radii smaller than its inverse, are refused: their squares and products
/// stay far from overflow and underflow in double, so no legal BlobTree evaluates to NaN.
inline constexpr double kLargestLength = 1e9;
inline constexpr double kSmallestLength = 1e-9;

/// Checks everything about a node but its children's ids. Errors: InvalidNode, its key a path in the node's JSON object
/// such as `radius_tip`, `nodes[3]` or `laterals[0].softness`.
void check_numbers(const Node& node);

}  // namespace cambium
