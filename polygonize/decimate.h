// Fewer triangles for levels of detail: edges are collapsed onto one of their ends, so what remains lies on the surface.
#pragma once

#include "blobtree/run_options.h"
#include "polygonize/mesh.h"

#include <cstddef>
#include <optional>

namespace cambium {

struct DecimateOptions {
  std::size_t triangles = 0;      ///< wanted at most
};

/// A closed manifold stays one; creases are shortened only along themselves; no triangle turns over. It stops above the wanted
/// number where nothing more can go. The vertices that remain keep position, normal and colour. nullopt if cancelled.
/// Deterministic. Errors: InputError for 0 triangles. Cost: n log n.
std::optional<Mesh> decimate(const Mesh& mesh, const DecimateOptions& options, const RunOptions& run);

}  // namespace cambium
