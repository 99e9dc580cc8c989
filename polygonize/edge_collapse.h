// One pass of edge collapses on OpenMesh's halfedges. Private to polygonize/.
#pragma once

#include "blobtree/run_options.h"
#include "polygonize/mesh.h"

#include <cstddef>
#include <optional>

namespace cambium {

/// Collapses edges in the order of their quadric errors until at most `triangles` are left or no collapse is allowed. Shape comes
/// first; only while there are too many triangles left, what is asked of it is lowered, and in the end creases are given up. No
/// collapse makes triangles cross, ever. nullopt if cancelled. The same at any thread count.
std::optional<Mesh> collapse_edges(const Mesh& mesh, std::size_t triangles, const RunOptions& run);

}  // namespace cambium
