// Surface that no corner of the octree shows: plates of wood thinner than the leaves they pass through, and slots as narrow. What
// sizes leaves is the radius of what is active; where surfaces cut each other there is nothing that says how thin the rest is.
#pragma once

#include "blobtree/run_options.h"
#include "polygonize/surface_octree.h"

#include <vector>

namespace cambium {

/// Cuts leaves whose corners are all of one kind until each of them shows the surface, is beside a leaf no smaller that does, or certainly
/// holds none. Slots narrower than tree.narrow() count as wood. Appends to `uncertain` the places where wood thinner than the
/// smallest leaves that show gaps may be missing: there the bounds of the field tell neither; at most one a leaf, in the order of leaves.
/// False if cancelled. The same at any thread count. Cost: a bound a leaf that is not beside the surface, and at most kMostBounds.
bool show_unseen_surface(SurfaceOctree& tree, const SurfaceCover& cover, std::vector<Vec3>& uncertain, const RunOptions& run);

}  // namespace cambium
