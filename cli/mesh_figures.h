// What `mesh` says of the meshes that it made.
#pragma once

#include <cstddef>
#include <vector>

#include "cli/job.h"
#include "polygonize/polygonize.h"
#include "polygonize/verify.h"

namespace cambium {

/// Counts of the first level, and of all of them if `most`, the triangles that were asked for, is not empty. Warns of levels that
/// have more.
void set_level_figures(Job& job, const std::vector<Mesh>& levels, const std::vector<std::size_t>& most);

void set_polygonize_figures(Job& job, const PolygonizeReport& report);

/// One verification for each level. Warns of the first level if it is not within `tolerance` (0: none was asked for), and of
/// every level that is not a closed manifold or crosses itself.
void set_verify_figures(Job& job, const std::vector<Verification>& levels, double tolerance);

}  // namespace cambium
