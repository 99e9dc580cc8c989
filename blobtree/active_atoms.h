// Which atoms can matter in a box. Private to blobtree/.
#pragma once

#include "blobtree/compiled_tree.h"

#include <span>
#include <vector>

namespace cambium {

/// Appends those of `candidates` (ascending) that can be non-zero in the box, by their bounds and, where no warp is in the way, by
/// their shape. Of a chain's segments only those stay that can be the nearest one somewhere in the box: the chain is the minimum
/// over its segments, so leaving out the others changes no bit. Cost: linear in candidates.
void append_active(const CompiledTree& tree, std::span<const std::uint32_t> candidates, const Box& box,
                   std::vector<std::uint32_t>& active);

}  // namespace cambium
