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

/// A closed manifold stays one of the same Euler number: every piece keeps a tetrahedron at least. No triangle turns over, no twig
/// becomes a sheet of two sides. Creases are shortened only along themselves; their ends and corners stay. While there are too many
/// triangles left, what is asked of shapes is lowered, then creases are given up, and where nothing more can go it stops above the
/// wanted number: at some 17 triangles a branch, since fewer of them would be webs between the twigs. What crosses itself in `mesh` may
/// do so still, but nothing else does. The vertices that remain keep position, normal and colour. nullopt if cancelled. The same at any
/// thread count. Errors: InputError for 0 triangles or a mesh that is not a closed manifold. Cost: n log n, some 6 seconds for a
/// million triangles. Source: Garland & Heckbert 1997, on OpenMesh's halfedges.
std::optional<Mesh> decimate(const Mesh& mesh, const DecimateOptions& options, const RunOptions& run);

}  // namespace cambium
