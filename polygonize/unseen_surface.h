// Surface that no corner of the octree shows: plates of wood thinner than the leaves they pass through, and slots as narrow. What
// sizes leaves is the radius of what is active; where surfaces cut each other there is nothing that says how thin the rest is.
#pragma once

#include "blobtree/run_options.h"
#include "polygonize/surface_octree.h"

#include <vector>

namespace cambium {

/// Cuts leaves whose corners are all of one kind until each of them shows the surface, is beside a leaf no smaller that does, or certainly
/// holds none; slots narrower than tree.narrow() count as wood. Appends to `uncertain` the places where wood may be missing that is
/// thinner than leaves may be: there the field's bounds tell neither. At most one a leaf. Leaves may not be larger than 1.15 radii where a
/// lone chain is active: then its wood has corners in it, and is not looked for. False if cancelled. The same at any thread
/// count. Cost: a bound for every leaf that is not beside the surface, some hundreds where that is not enough.
bool show_unseen_surface(SurfaceOctree& tree, const SurfaceCover& cover, std::vector<Vec3>& uncertain, const RunOptions& run);

}  // namespace cambium
