// A vertex for each patch: on the surface inside its leaf, and on the crease or in the corner where sheets meet there.
#pragma once

#include "polygonize/contour.h"

namespace cambium {

inline constexpr double kVertexMargin = 0.02;   ///< vertices keep this far inside their leaves, in edges, so that no two can meet
inline constexpr double kCreaseMargin = 0.004;  ///< those on creases, which a margin moves off them, in the smallest cells

/// Of the patches listed, ascending, into contour.vertices and contour.exits; their crossings are known. False if cancelled.
/// Cost: two samples a patch, and a few dozen point evaluations where sheets meet.
bool place_vertices(const SurfaceOctree& tree, const SurfaceCover& cover, const std::vector<std::uint32_t>& patches,
                    Contour& contour, const RunOptions& run);

}  // namespace cambium
