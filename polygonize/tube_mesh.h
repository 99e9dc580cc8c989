// Tubes between the open ends that an octree's mesh has where runs take its place. Private to polygonize/.
#pragma once

#include "polygonize/contour.h"
#include "polygonize/patch_polygons.h"
#include "polygonize/tube_runs.h"

#include <optional>
#include <vector>

namespace cambium {

struct TubeReport {
  std::vector<std::uint32_t> failed;   ///< runs, ascending, that have no simple open end on either side; the mesh is as it was then
  double largest_error = 0;            ///< of a triangle, metres, where it was measured
};

/// Closes `built` (by build_polygons of that contour) with the runs' tubes, whose vertices and triangles are appended run by run. Knots in
/// the line of an open end that no tube fits are smoothed first, where that helps: vertices there move on the surface.
/// Where the mesh near the ends is a graph over the chain's surface, as is looked at, and the lines to be joined are simple on the
/// unrolled surface, no triangles meet but in what they share. nullopt if cancelled. In the current arena; the same at any thread
/// count. Cost: a look at every triangle, and some microseconds a ring.
std::optional<TubeReport> add_tubes(const SurfaceOctree& tree, const SurfaceCover& cover, const Contour& contour, const TubeRuns& runs,
                                    double tolerance, DualMesh& built, const RunOptions& run);

}  // namespace cambium
