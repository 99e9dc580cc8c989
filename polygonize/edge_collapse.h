// One pass of edge collapses through OpenMesh's decimater. Private to polygonize/.
#pragma once

#include "blobtree/run_options.h"
#include "polygonize/mesh.h"

#include <cstddef>
#include <cstdint>
#include <optional>
#include <vector>

namespace cambium {

struct Collapsed {
  Mesh mesh;
  std::vector<std::uint32_t> source;     ///< by vertex of mesh: its number before
  std::vector<std::uint32_t> survivor;   ///< by vertex before: the number in mesh of the one that it went into
};

/// Collapses edges in the order of their quadric errors until at most `triangles` are left or no collapse is allowed. Vertices
/// with locked[v] stay. Shape comes first; only while there are too many triangles left, what is asked of it is lowered, and in
/// the end creases are given up. nullopt if cancelled. Deterministic.
std::optional<Collapsed> collapse_edges(const Mesh& mesh, std::size_t triangles, const std::vector<bool>& locked,
                                        const RunOptions& run);

}  // namespace cambium
